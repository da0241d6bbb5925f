# Blocks of SIMD lanes for ensembles, a library of its own that only `hamflow sweep` and the benchmark need: lanes are
# recorded steps.
add_library(hamflow_ensemble STATIC
  src/catalog/block_tangents.cpp
  src/catalog/ensemble_catalog.cpp
  src/catalog/family_loop.cpp
  src/catalog/iterated_block.cpp
  src/catalog/iterated_family.cpp
  src/catalog/iterated_pack.cpp
  src/catalog/recorded_block.cpp)
set_target_properties(hamflow_ensemble PROPERTIES UNITY_BUILD ${HAMFLOW_UNITY} UNITY_BUILD_BATCH_SIZE 4)
target_include_directories(hamflow_ensemble PRIVATE "${PROJECT_SOURCE_DIR}/src/catalog" "${generated}")
target_link_libraries(hamflow_ensemble PUBLIC hamflow PRIVATE $<BUILD_INTERFACE:hamflow_warnings>)
