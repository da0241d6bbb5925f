// Scenarios as members of blocks of lanes.
#pragma once

#include <memory>

#include "hamflow/run/ensemble.hpp"
#include "hamflow/scenario/scenario.hpp"
#include "lanes/recorded_block.hpp"
#include "methods/step_control.hpp"

namespace hamflow {

struct Member {
  MemberStart start;
  ParameterShape shape;
};

inline Member member_of(const Scenario& scenario) {
  Member member{{scenario.start_q, scenario.start_p, {}, evaluate_number<double>(scenario.request.dt)}, {}};
  const Parameters<double> parameters(scenario.request.parameters);
  for (const ParameterInfo& info : scenario.problem->info.parameters) {
    if (!parameters.has(info.name)) continue;
    const std::vector<double>& list = parameters.list(info.name);
    member.shape.emplace_back(info.name, list.size());
    member.start.parameters.insert(member.start.parameters.end(), list.begin(), list.end());
  }
  return member;
}

/// A block for members like this one; null if they cannot run in lanes.
inline std::unique_ptr<EnsembleBlock> block_for(const Scenario& scenario, const Member& member) {
  const Request& request = scenario.request;
  const bool in_double = request.arithmetic == "double" || request.arithmetic == "compensated";
  if (!in_double || step_control_of(request.method).reversible) return nullptr;
  auto block = make_recorded_block(scenario.problem, request, LaneSet::generic);
  return block != nullptr && block->load(member.shape, {&member.start, 1}) ? std::move(block) : nullptr;
}

}  // namespace hamflow
