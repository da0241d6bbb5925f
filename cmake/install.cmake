# The files that `cmake --install` copies. cmake/packages.cmake makes a Debian package of each component: command,
# development, python.
#
# find_package(hamflow) offers one target, hamflow::hamflow, for all that the headers declare. A static library costs a program
# only what it uses. Each component of find_package is a target with fewer dependencies; hamflow::core is the catalogue of
# problems and methods without files, figures and measures. The names are the same with add_subdirectory.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set_target_properties(hamflow PROPERTIES EXPORT_NAME core)
add_library(hamflow::core ALIAS hamflow)
set_target_properties(hamflow_everything PROPERTIES EXPORT_NAME hamflow)
set(parts ensemble figures files io scenario sweep verify workflow)
foreach(part IN LISTS parts)
  set_target_properties(hamflow_${part} PROPERTIES EXPORT_NAME ${part})
  if(NOT TARGET hamflow::${part})
    add_library(hamflow::${part} ALIAS hamflow_${part})
  endif()
endforeach()
list(TRANSFORM parts PREPEND hamflow_)
install(TARGETS hamflow hamflow_everything hamflow_flags ${parts} EXPORT hamflow_targets ARCHIVE COMPONENT development)
install(TARGETS hamflow_command COMPONENT command)
add_custom_target(installed_parts DEPENDS hamflow_command hamflow ${parts})  # everything that is installed, without tests
install(DIRECTORY include/hamflow DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT development)
set(config "${CMAKE_INSTALL_LIBDIR}/cmake/hamflow")
install(EXPORT hamflow_targets NAMESPACE hamflow:: DESTINATION "${config}" COMPONENT development)
configure_package_config_file(cmake/hamflowConfig.cmake.in "${PROJECT_BINARY_DIR}/hamflowConfig.cmake" INSTALL_DESTINATION "${config}")
# Before 1.0 a new minor version may change what a program calls.
write_basic_package_version_file("${PROJECT_BINARY_DIR}/hamflowConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/hamflowConfig.cmake" "${PROJECT_BINARY_DIR}/hamflowConfigVersion.cmake"
        DESTINATION "${config}" COMPONENT development)
