# What is not a step of a method (reading, writing, drawing, judging) is compiled with a lighter optimisation, and several
# files at a time, so that what they include is read, and what they instantiate is generated, once.
function(hamflow_cold target files_per_unit)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>
    $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)  # files of a unit are included, but nowhere else
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${HAMFLOW_UNITY} UNITY_BUILD_BATCH_SIZE ${files_per_unit})
endfunction()
