# Blocks of SIMD lanes for ensembles, a library of its own that only `hamflow sweep` and the benchmark need: lanes are
# recorded steps.
add_library(hamflow_ensemble STATIC
  src/lanes/block_tangents.cpp
  src/lanes/ensemble_catalog.cpp
  src/lanes/family_loop.cpp
  src/lanes/iterated_block.cpp
  src/lanes/iterated_family.cpp
  src/lanes/iterated_pack.cpp
  src/lanes/recorded_block.cpp)
set_target_properties(hamflow_ensemble PROPERTIES UNITY_BUILD ${HAMFLOW_UNITY} UNITY_BUILD_BATCH_SIZE 4)
target_include_directories(hamflow_ensemble PRIVATE "${generated}")
target_link_libraries(hamflow_ensemble PUBLIC hamflow PRIVATE $<BUILD_INTERFACE:hamflow_warnings>)
