# What is not a step of a method (reading, writing, drawing, judging) is compiled with the lightest optimisation, and
# several files at a time, so that what they include is read, and what they instantiate is generated, once.
function(hamflow_cold target files_per_unit)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-Og>
    $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)  # files of a unit are included, but nowhere else
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${HAMFLOW_UNITY} UNITY_BUILD_BATCH_SIZE ${files_per_unit})
endfunction()

# Files that were found in a folder, compiled as one unit: its name in place of theirs in `out`.
function(hamflow_together out name)
  if(NOT HAMFLOW_UNITY)
    set(${out} ${ARGN} PARENT_SCOPE)
    return()
  endif()
  set(includes "")
  foreach(file IN LISTS ARGN)
    string(APPEND includes "#include \"${file}\"\n")
  endforeach()
  set(unit "${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp")
  file(CONFIGURE OUTPUT "${unit}" CONTENT "${includes}" @ONLY)
  set_source_files_properties("${unit}" PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  set(${out} "${unit}" PARENT_SCOPE)
endfunction()
