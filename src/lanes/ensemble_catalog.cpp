// Makes blocks of lanes from requests.
#include "iterated_block.hpp"
#include "methods/recipes.hpp"
#include "methods/step_control.hpp"
#include "recorded_block.hpp"

namespace hamflow {

LaneSet widest_lanes() {
#if defined(__x86_64__) && defined(__GNUC__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("fma")) return LaneSet::avx512;
  if (__builtin_cpu_supports("avx2")) return LaneSet::avx2;
#endif
  return LaneSet::generic;
}

std::unique_ptr<EnsembleBlock> make_ensemble_block(const Request& request, LaneSet lanes) {
  const bool in_double = request.arithmetic == "double" || request.arithmetic == "compensated";
  if (lanes == LaneSet::none || lanes > widest_lanes() || !in_double) return nullptr;
  if (step_control_of(request.method).reversible) return nullptr;  // all lanes have the same step size
  const std::shared_ptr<const ProblemEntry> problem = find_problem(request);
  const bool is_iterated = visit_method(request.method, []<class M>(const M&) { return std::is_same_v<M, Averages>; });
  return is_iterated ? make_iterated_block(problem, request, lanes) : make_recorded_block(problem, request, lanes);
}

}  // namespace hamflow
