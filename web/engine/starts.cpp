#include "starts.hpp"

#include <emscripten.h>

#include <algorithm>
#include <functional>

#include "members.hpp"
#include "scenario_family.hpp"
#include "toml_path.hpp"

namespace hamflow {

/// Some starts that advance together.
class Starts::Group {
 public:
  virtual ~Group() = default;
  virtual void advance(std::int64_t steps) = 0;
  /// The starts that have ended, with the reason.
  virtual void tell_failures(std::vector<std::string>& failures) const = 0;
};

class Starts::LaneGroup final : public Group {
 public:
  using Found = std::function<void(std::size_t start, const SectionPoint&)>;
  LaneGroup(std::unique_ptr<EnsembleBlock> block, std::span<const Scenario> scenarios, std::span<const Member> members,
            std::size_t first, const Found& found)
      : block_(std::move(block)), first_(first) {
    std::vector<MemberStart> starts;
    for (const Member& each : members) starts.push_back(each.start);
    if (!block_->load(members[0].shape, starts)) throw Error("found starts that differ in more than numbers");
    std::vector<LaneObservers> observers;
    for (std::size_t lane = 0; lane < members.size(); ++lane) {
      searches_.push_back(std::make_unique<SectionSearch>(
          *scenarios[lane].section, [=](const SectionPoint& point) { found(first + lane, point); }));
      observers.push_back({.section = searches_.back().get()});
    }
    run_ = std::make_unique<LaneRun>(*block_, std::move(observers));
  }
  void advance(std::int64_t steps) override { run_->advance(steps); }
  void tell_failures(std::vector<std::string>& failures) const override {
    for (std::size_t lane = 0; lane < searches_.size(); ++lane) {
      if (block_->is_lost(lane)) failures[first_ + lane] = "a step failed";
      if (searches_[lane]->failed()) failures[first_ + lane] = searches_[lane]->message();
    }
  }

 private:
  std::unique_ptr<EnsembleBlock> block_;
  std::size_t first_;
  std::vector<std::unique_ptr<SectionSearch>> searches_;
  std::unique_ptr<LaneRun> run_;
};

class Starts::Single final : public Group {
 public:
  Single(const Scenario& scenario, std::size_t number, const std::function<void(const SectionPoint&)>& found)
      : simulation_(make_simulation(scenario.request)),
        finder_(*simulation_, *scenario.section, found),
        number_(number) {}
  void advance(std::int64_t steps) override {
    std::vector<Observer*> observers{&finder_};
    if (!is_failure(outcome_)) outcome_ = run(*simulation_, simulation_->step() + steps, observers);
  }
  void tell_failures(std::vector<std::string>& failures) const override {
    if (is_failure(outcome_)) failures[number_] = message(outcome_);
    if (finder_.failed()) failures[number_] = finder_.search().message();
  }

 private:
  std::unique_ptr<Simulation> simulation_;
  SectionFinder finder_;
  std::size_t number_;
  Outcome outcome_ = Outcome::done;
};

Starts::Starts(const std::string& text, const std::vector<std::string>& sets) {
  ScenarioFamily family(text, "scenario", {});
  if (!family.complaints().empty()) throw Rejection(family.complaints());
  std::vector<Member> members;
  for (const std::string& set : sets) {
    const auto [path, value] = parsed_set(set);
    Reading reading = family.read({path}, {family.add_value(value)});
    if (!reading.no_start.empty()) throw Error(reading.no_start);
    if (!reading.scenario) throw Rejection(reading.complaints);
    if (!reading.scenario->section) throw Error("found no run.section; allowed a scenario with a section");
    scenarios_.push_back(std::move(*reading.scenario));
    members.push_back(member_of(scenarios_.back()));
  }
  counts_.assign(sets.size(), 0);
  failures_.assign(sets.size(), "");
  const auto found = [this](std::size_t start, const SectionPoint& point) { take(start, point); };
  for (std::size_t k = 0; k < scenarios_.size();) {
    const Scenario& first = scenarios_[k];
    width_ = 2 + 2 * first.start_q.size();
    // points within steps that bounce are located on a simulation of the start alone
    auto block = has_hard_walls(first.request) ? nullptr : block_for(first, members[k]);
    if (block == nullptr) {
      groups_.push_back(std::make_unique<Single>(first, k, [=](const SectionPoint& point) { found(k, point); }));
      ++k;
      continue;
    }
    const std::size_t some = std::min(block->lanes(), scenarios_.size() - k);
    groups_.push_back(std::make_unique<LaneGroup>(std::move(block), std::span(scenarios_).subspan(k, some),
                                                  std::span(members).subspan(k, some), k, found));
    k += some;
  }
}

Starts::~Starts() = default;

void Starts::take(std::size_t start, const SectionPoint& point) {
  if (counts_[start] >= most_) return;
  ++counts_[start];
  points_.push_back(static_cast<double>(start));
  points_.push_back(point.time);
  points_.insert(points_.end(), point.q.begin(), point.q.end());
  points_.insert(points_.end(), point.p.begin(), point.p.end());
}

bool Starts::is_done() const {
  for (std::size_t k = 0; k < counts_.size(); ++k) {
    if (counts_[k] < most_ && failures_[k].empty()) return false;
  }
  return true;
}

void Starts::advance(std::int64_t most, double milliseconds) {
  constexpr std::int64_t some = 256;
  const double end = emscripten_get_now() + milliseconds;
  most_ = most;
  points_.clear();
  while (!is_done() && emscripten_get_now() < end) {
    for (const auto& group : groups_) {
      group->advance(some);
      group->tell_failures(failures_);
    }
    step_ += some;
  }
}

}  // namespace hamflow
