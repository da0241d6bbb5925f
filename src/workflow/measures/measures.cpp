#include "measures.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "measure_list.hpp"

namespace hamflow {

std::span<const MeasureKind> measure_kinds() {
  static const std::vector<MeasureKind> all = generated_measure_kinds();
  return all;
}

StepMapSource step_map_of(const Scenario& scenario) {
  const std::size_t n = scenario.start_q.size();
  return {n, [&scenario, n] { return scenario.problem->step_map(scenario.request, n); }};
}

Measures::Measures(const Scenario& scenario, const Simulation& simulation, Recorder* recorder) {
  for (const MeasureKind& kind : measure_kinds()) {
    if (!kind.requested(scenario)) continue;
    requested_.emplace_back(
        &kind, kind.make != nullptr ? kind.make(scenario) : kind.make_of_run(scenario, simulation, recorder));
  }
}

std::vector<NamedObserver> Measures::observers() const {
  std::vector<NamedObserver> all;
  for (const auto& [kind, measure] : requested_) all.push_back({kind->key, &measure->observer()});
  return all;
}

void Measures::observe_end(const Frame& end) {
  std::vector<TangentObserver*> watches;
  for (const auto& [kind, measure] : requested_) {
    if (TangentObserver* const watch = measure->tangents()) watches.push_back(watch);
  }
  advance_tangents_to_end(watches, end);
}

void Measures::add_to(Summary& summary) const {
  for (const auto& [kind, measure] : requested_) {
    measure->add_to(summary);
    for (std::string& note : measure->event_notes()) summary.event_notes.push_back(std::move(note));
  }
}

void Measures::add_warnings(std::vector<Warning>& warnings) const {
  std::int64_t most = 0;
  for (const auto& [kind, measure] : requested_) most = std::max(most, measure->unseen_steps());
  if (most == 0) return;
  warnings.push_back({"long_step", fmt::format("{} too long to be searched for section points and events, so some may "
                                               "be missing; try a smaller dt",
                                               most == 1 ? "1 step was" : fmt::format("{} steps were", most))});
}

bool Measures::stopped() const {
  return std::any_of(requested_.begin(), requested_.end(), [](const auto& each) { return each.second->stops(); });
}

namespace {

/// The measures of one member of a sweep. A column has the same numbers as the summary of a single run.
class MemberMeasures final : public MemberObserver {
 public:
  MemberMeasures(std::span<const MeasureKind* const> kinds, const Scenario& scenario, const Simulation* alone) {
    for (const MeasureKind* kind : kinds) {
      if (kind->make != nullptr) {
        measures_.push_back(kind->make(scenario));
      } else if (alone != nullptr) {
        measures_.push_back(kind->make_of_run(scenario, *alone, nullptr));
      }
    }
  }
  std::vector<Observer*> observers() override {
    std::vector<Observer*> all;
    for (const auto& measure : measures_) all.push_back(&measure->observer());
    return all;
  }
  std::vector<TangentObserver*> tangents() override {
    std::vector<TangentObserver*> all;
    for (const auto& measure : measures_) {
      if (TangentObserver* const watch = measure->tangents()) all.push_back(watch);
    }
    return all;
  }
  SummedSteps* sums() override {
    for (const auto& measure : measures_) {
      if (SummedSteps* const sums = measure->summing()) return sums;
    }
    return nullptr;
  }
  std::vector<double> row() const override {
    std::vector<double> all;
    for (const auto& measure : measures_) {
      const std::vector<double> part = measure->row();
      all.insert(all.end(), part.begin(), part.end());
    }
    return all;
  }
  std::vector<std::int64_t> events() const override {
    std::vector<std::int64_t> all;
    for (const auto& measure : measures_) {
      const std::vector<std::int64_t> part = measure->event_counts();
      all.insert(all.end(), part.begin(), part.end());
    }
    return all;
  }
  std::vector<std::string> event_notes() const override {
    std::vector<std::string> all;
    for (const auto& measure : measures_) {
      const std::vector<std::string> part = measure->event_notes();
      all.insert(all.end(), part.begin(), part.end());
    }
    return all;
  }
  std::optional<MemberStop> stopped_by() const override {
    for (const auto& measure : measures_) {
      if (auto stop = measure->stopped_by()) return stop;
    }
    return std::nullopt;
  }

 private:
  std::vector<std::unique_ptr<Measure>> measures_;
};

}  // namespace

MemberObservables sweep_columns(const Scenario& member) {
  MemberObservables all;
  std::vector<const MeasureKind*> kinds;
  for (const MeasureKind& kind : measure_kinds()) {
    if ((kind.columns == nullptr && !kind.counts_events) || !kind.requested(member)) continue;
    kinds.push_back(&kind);
    if (kind.columns == nullptr) continue;
    const std::vector<std::string> names = kind.columns(member);
    all.names.insert(all.names.end(), names.begin(), names.end());
  }
  if (kinds.empty()) return all;
  all.watch = [kinds](const Scenario& scenario, const Simulation* alone) {
    return std::make_unique<MemberMeasures>(kinds, scenario, alone);
  };
  return all;
}

}  // namespace hamflow
