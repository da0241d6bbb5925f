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

namespace {

/// A column of a sweep is what the same measure shows of the single run.
class MeasuredMember final : public MemberWatch {
 public:
  MeasuredMember(std::span<const MeasureKind* const> kinds, const Scenario& scenario, const Simulation& simulation) {
    for (const MeasureKind* kind : kinds) measures_.push_back(kind->make(scenario, simulation, nullptr));
  }
  std::vector<Observer*> observers() override {
    std::vector<Observer*> all;
    for (const auto& measure : measures_) all.push_back(&measure->observer());
    return all;
  }
  std::vector<double> row() const override {
    std::vector<double> all;
    for (const auto& measure : measures_) {
      const std::vector<double> part = measure->row();
      all.insert(all.end(), part.begin(), part.end());
    }
    return all;
  }

 private:
  std::vector<std::unique_ptr<Measure>> measures_;
};

}  // namespace

MemberObservables sweep_columns(const Scenario& first) {
  MemberObservables all;
  std::vector<const MeasureKind*> kinds;
  for (const MeasureKind& kind : measure_kinds()) {
    if (kind.columns == nullptr || !kind.requested(first)) continue;
    kinds.push_back(&kind);
    const std::vector<std::string> names = kind.columns(first);
    all.names.insert(all.names.end(), names.begin(), names.end());
  }
  if (kinds.empty()) return all;
  all.watch = [kinds](const Scenario& scenario, const Simulation& simulation) {
    return std::make_unique<MeasuredMember>(kinds, scenario, simulation);
  };
  return all;
}

}  // namespace hamflow
