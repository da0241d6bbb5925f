// Where a problem is measured, as a request by name.
#pragma once

#include "hamflow/run/catalog.hpp"
#include "hamflow/verify/measure.hpp"

namespace hamflow::test {

/// The centre of the region on which the problem is measured, its parameters, and a tenth of its step; no method yet.
inline Request measured_request(const ProblemEntry& problem) {
  Request request;
  request.problem = problem.info.name;
  request.variant = {problem.info.variant.begin(), problem.info.variant.end()};
  const Region region = region_of(request.problem, request.variant);
  request.parameters = region.parameters;
  const std::size_t size = region.centre.size() / 2;
  for (std::size_t i = 0; i < size; ++i) {
    request.start.q.push_back(shortest(region.centre[i]));
    request.start.p.push_back(shortest(region.centre[size + i]));
  }
  request.dt = shortest(region.step / 10);
  return request;
}

/// Whether the second copy that a method carries stays with the first one there. The masses of the solar system span
/// ten orders, and no springs of frequency 20 bind what second derivatives of 10^9 drive apart.
inline bool is_bound(const MethodSpec& method, const ProblemEntry& problem) {
  return !describe(method).carries_copy || problem.info.name != "solar-system";
}

/// Beyond double dop853 asks for four digits less than all, for which an order of 8 takes 10^4 sub-steps and more in
/// each step. What it does and remembers is the same for 20 digits, with a few.
inline MethodSpec with_few_sub_steps(MethodSpec method, const std::string& arithmetic) {
  if (method.name == "dop853" && digits_beyond_double(arithmetic) > 0) method.options.try_emplace("tolerance", "1e-20");
  return method;
}

}  // namespace hamflow::test
