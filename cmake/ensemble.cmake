# Blocks of SIMD lanes for ensembles, a library of its own that only `hamflow sweep` and the benchmark need. Lanes are recorded
# steps; only kernel = "fast" has a unit for each problem that offers it, generated like those of the catalogue.
set(ensemble_units)
set(ensemble_declarations "")
set(ensemble_calls "")
set(ensemble_text [[
#include "ensemble_unit.hpp"
#include "hamflow/problems/@header@.hpp"
namespace hamflow {
template <class R>
using EnsembleFamily_@name@ = @family@;
EnsembleEntry ensemble_@name@();
EnsembleEntry ensemble_@name@() { return EnsembleUnit<EnsembleFamily_@name@>::entry(); }
}  // namespace hamflow
]])
macro(hamflow_ensemble_unit)
  set(unit "${generated}/ensemble_${name}.cpp")
  file(CONFIGURE OUTPUT "${unit}" CONTENT "${ensemble_text}" @ONLY)
  list(APPEND ensemble_units "${unit}")
  string(APPEND ensemble_declarations "EnsembleEntry ensemble_${name}();\n")
  string(APPEND ensemble_calls "ensemble_${name}(), ")
endmacro()
foreach(potential IN LISTS potential_names)
  file(STRINGS "${PROJECT_SOURCE_DIR}/include/hamflow/problems/potentials/${potential}.hpp" fast REGEX "fast_slope" LIMIT_COUNT 1)
  if(NOT fast)
    continue()
  endif()
  hamflow_pascal_case(type ${potential})
  set(name central_force_${potential})
  set(header potentials/${potential})
  set(family "CentralForce<R, ${type}>")
  hamflow_ensemble_unit()
endforeach()
file(CONFIGURE OUTPUT "${generated}/ensemble_list.hpp" CONTENT [[
#pragma once
#include "ensemble_unit.hpp"
namespace hamflow {
@ensemble_declarations@
inline std::vector<EnsembleEntry> generated_ensembles() { return {@ensemble_calls@}; }
}  // namespace hamflow
]] @ONLY)

set(ensemble_sources
  src/catalog/block_tangents.cpp
  src/catalog/ensemble_catalog.cpp
  src/catalog/family_loop.cpp
  src/catalog/recorded_block.cpp)
add_library(hamflow_ensemble STATIC ${ensemble_sources} ${ensemble_units})
set_target_properties(hamflow_ensemble PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 6)
set_source_files_properties(${ensemble_sources} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
target_include_directories(hamflow_ensemble PRIVATE "${PROJECT_SOURCE_DIR}/src/catalog" "${generated}")
target_link_libraries(hamflow_ensemble PUBLIC hamflow PRIVATE $<BUILD_INTERFACE:hamflow_warnings>)
# -Wno-psabi: packs go by value through functions that are inlined in the end; GCC 4.6 passed them otherwise. clang
# inlines into a function for another target only what it finds small.
target_compile_options(hamflow_ensemble PRIVATE -Wno-psabi
  "$<$<CXX_COMPILER_ID:Clang>:SHELL:-mllvm -inline-threshold=5000>")
