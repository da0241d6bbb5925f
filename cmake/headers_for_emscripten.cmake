# The libraries of headers that a portable build needs, as the packages of the machine on which is built have them. Their own
# CMake packages would add /usr/include, and with it the headers of that machine's C library.
foreach(library Boost::headers nlohmann_json::nlohmann_json fmt::fmt tomlplusplus::tomlplusplus Eigen3::Eigen)
  add_library(${library} INTERFACE IMPORTED)
  target_include_directories(${library} SYSTEM INTERFACE "${HAMFLOW_HOST_HEADERS}")
endforeach()
target_include_directories(Eigen3::Eigen SYSTEM INTERFACE /usr/include/eigen3)
target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY)
target_compile_definitions(tomlplusplus::tomlplusplus INTERFACE TOML_HEADER_ONLY=1)
