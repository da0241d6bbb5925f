// From a request to a block of lanes.
#include <algorithm>

#include "ensemble_list.hpp"  // generated
#include "hamflow/numerics/inverse_cube.hpp"
#include "hamflow/run/splitting_named.hpp"
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
  const ProblemEntry& problem = find_problem(request.problem, request.variant);
  // Without the instructions the fast kernel has the bits of the exact one (numerics/inverse_cube.hpp).
  if (request.kernel != "fast" || !fast_kernel_available()) return make_recorded_block(problem, request, lanes);
  static const std::vector<EnsembleEntry> entries = generated_ensembles();
  const std::optional<AnySplitting> method = splitting_named(request.method.name);
  const auto entry = std::find_if(entries.begin(), entries.end(), [&](const EnsembleEntry& one) {
    return one.name == problem.info.name && one.variant == problem.info.variant;
  });
  return method && entry != entries.end() ? entry->make_fast(*method, lanes) : nullptr;
}

}  // namespace hamflow
