#include "measures.hpp"

#include <nlohmann/json.hpp>

#include "measure_list.hpp"

namespace hamflow {

std::span<const MeasureKind> measure_kinds() {
  static const std::vector<MeasureKind> all = generated_measure_kinds();
  return all;
}

std::shared_ptr<const StepMap> step_map_of(const Scenario& scenario) {
  return scenario.problem->step_map(scenario.request.parameters, scenario.request.method, scenario.start_q.size());
}

Measures::Measures(const Scenario& scenario, const Simulation& simulation, Recorder* recorder) {
  for (const MeasureKind& kind : measure_kinds()) {
    if (kind.requested(scenario)) requested_.emplace_back(&kind, kind.make(scenario, simulation, recorder));
  }
}

std::vector<NamedObserver> Measures::observers() const {
  std::vector<NamedObserver> all;
  for (const auto& [kind, measure] : requested_) all.push_back({kind->key, &measure->observer()});
  return all;
}

void Measures::add_to(nlohmann::ordered_json& summary) const {
  for (const auto& [kind, measure] : requested_) summary[kind->key] = measure->summary();
}

MemberObservables sweep_columns(const Scenario& first) {
  MemberObservables all;
  std::vector<MemberObservables> parts;
  for (const MeasureKind& kind : measure_kinds()) {
    if (kind.columns == nullptr || !kind.requested(first)) continue;
    parts.push_back(kind.columns(first));
    all.names.insert(all.names.end(), parts.back().names.begin(), parts.back().names.end());
  }
  if (parts.empty()) return all;
  all.observe = [parts](const Scenario& scenario) {
    std::vector<double> row;
    for (const MemberObservables& part : parts) {
      std::vector<double> found = part.observe(scenario);
      found.resize(part.names.size(), std::numeric_limits<double>::quiet_NaN());
      row.insert(row.end(), found.begin(), found.end());
    }
    return row;
  };
  return all;
}

}  // namespace hamflow
