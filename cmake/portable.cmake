# HAMFLOW_PORTABLE: hamflow for any processor that a C++20 compiler knows, out of headers alone (Eigen, Boost, fmt,
# toml++, CLI11, JSON). Files of src/portable stand in for what needs AsmJit, QD, MPFR, libquadmath, HDF5 and the vector
# instructions of x86; arithmetics are double, compensated, double-double and lattice; there are no threads. Steps of
# + - * / sqrt have the same bits as elsewhere.
option(HAMFLOW_PORTABLE "without AsmJit, QD, MPFR, libquadmath, HDF5, threads and instructions of x86" OFF)

set(HAMFLOW_LEFT_OUT)  # of the lists of files
if(NOT HAMFLOW_PORTABLE)
  find_package(fmt REQUIRED)
  find_package(tomlplusplus REQUIRED)
  find_package(HDF5 REQUIRED COMPONENTS C)
  find_package(Threads REQUIRED)
  find_package(asmjit REQUIRED)  # in src/native only
  # QD and MPFR by their plain names: neither brings a CMake package. libquadmath comes with the compiler.
  set(HAMFLOW_LIBRARIES Threads::Threads qd quadmath mpfr gmp $<LINK_ONLY:asmjit::asmjit>)
  return()
endif()

set(HAMFLOW_LIBRARIES)
set(HDF5_C_INCLUDE_DIRS "${PROJECT_SOURCE_DIR}/src/portable/hdf5")
set(HDF5_C_LIBRARIES)
list(APPEND HAMFLOW_LEFT_OUT
  src/arithmetic/double_double.cpp
  src/arithmetic/mp.cpp
  src/bulk/instruction_sets.cpp
  src/bulk/kernel_avx2.cpp
  src/bulk/kernel_avx512.cpp
  src/steps/erased_simulation_mp.cpp)
if(EMSCRIPTEN)  # src/portable/emscripten and web/engine/left_out.cpp stand in
  list(APPEND HAMFLOW_LEFT_OUT src/native/lane_function.cpp src/native/step_loop.cpp src/socket/force_server.cpp src/walls/walled_step_map.cpp)
  return()  # the headers are known
endif()
# The headers alone of fmt and toml++: Debian's libraries of them are for the machine on which is built.
find_path(FMT_HEADERS fmt/format.h REQUIRED)
find_path(TOML_HEADERS toml++/toml.h REQUIRED)
mark_as_advanced(FMT_HEADERS TOML_HEADERS)
add_library(fmt::fmt INTERFACE IMPORTED)
target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY)
add_library(tomlplusplus::tomlplusplus INTERFACE IMPORTED)
target_compile_definitions(tomlplusplus::tomlplusplus INTERFACE TOML_HEADER_ONLY=1)
