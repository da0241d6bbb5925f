// Members of a sweep: starts, parameters and step sizes of their own, and the same members alone.
#pragma once

#include "hamflow/run/catalog.hpp"
#include "hamflow/run/ensemble.hpp"
#include "hamflow/verify/measure.hpp"

namespace hamflow {

/// Members of one problem around the point where it is measured.
struct MemberFamily {
  Request request;
  ParameterShape shape;
  std::vector<MemberStart> members;

  MemberFamily(const ProblemEntry& problem, std::size_t count) {
    request.problem = problem.info.name;
    request.variant = {problem.info.variant.begin(), problem.info.variant.end()};
    const Region region = region_of(request.problem, request.variant);
    request.parameters = complete(problem.info, region.parameters);
    const Parameters<double> parameters(request.parameters);
    for (const ParameterInfo& info : problem.info.parameters) {
      if (parameters.has(info.name)) shape.emplace_back(info.name, parameters.list(info.name).size());
    }
    const std::size_t n = region.centre.size() / 2;
    for (std::size_t i = 0; i < count; ++i) {
      MemberStart member;
      const double nudge = 1 + 1e-3 * static_cast<double>(i);
      for (std::size_t k = 0; k < n; ++k) {
        member.q.push_back(region.centre[k] * nudge);
        member.p.push_back(region.centre[n + k] / nudge);
      }
      for (const auto& [name, size] : shape) {
        const bool is_whole = name == "n" || name == "exponent";  // of fput; of the gas: else its steps are others
        for (const double x : parameters.list(name)) {
          member.parameters.push_back(i % 2 == 0 || is_whole ? x : x * nudge);
        }
      }
      member.h = region.step / (i % 3 == 0 ? 10 : 20);
      members.push_back(member);
    }
  }

  /// The request of the member alone.
  Request alone(const MemberStart& member) const {
    Request one = request;
    std::size_t at = 0;
    for (const auto& [name, size] : shape) {
      std::string text;
      for (std::size_t k = 0; k < size; ++k) text += (k == 0 ? "" : ", ") + shortest(member.parameters[at++]);
      one.parameters[name] = size == 1 ? text : "[" + text + "]";
    }
    for (const double x : member.q) one.start.q.push_back(shortest(x));
    for (const double x : member.p) one.start.p.push_back(shortest(x));
    one.dt = shortest(member.h);
    return one;
  }
};

}  // namespace hamflow
