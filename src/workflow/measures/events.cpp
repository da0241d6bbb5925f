// run.events: locates zeros of expressions in the same way as points of a Poincare section. Events are counted and
// recorded, and may end the run.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "measure.hpp"
#include "measure_list.hpp"
#include "number_text.hpp"
#include "recorder.hpp"
#include "section_text.hpp"
#include "summary.hpp"
#include "summary_fields.hpp"

namespace hamflow {

namespace {

class EventsMeasure final : public Measure, public Observer {
 public:
  EventsMeasure(const Scenario& scenario, const Simulation& simulation, Recorder* recorder)
      : events_(scenario.events), dt_(scenario.dt) {
    for (std::size_t i = 0; i < events_.size(); ++i) {
      finders_.push_back(std::make_unique<SectionFinder>(
          simulation, events_[i].zero, [this, recorder, i](const SectionPoint& point) { found(i, point, recorder); }));
    }
  }
  Observer& observer() override { return *this; }
  std::int64_t next_due(std::int64_t step) const override { return step; }
  Verdict observe(const Frame& frame) override {
    step_ = frame.step;
    end_ = frame.time;
    for (const auto& finder : finders_) (void)finder->observe(frame);
    return by_ ? Verdict::stop : Verdict::go_on;
  }
  /// An event that ends the run may occur before the point at which a step fails. Other events are only located in
  /// steps that succeeded.
  Verdict observe_failed_step() override {
    ++step_;
    end_ += dt_;
    for (std::size_t i = 0; i < finders_.size(); ++i) {
      if (events_[i].stops) finders_[i]->look_into_failed_step();
    }
    return by_ ? Verdict::stop : Verdict::go_on;
  }
  void archive(Writer& ar) override { fields(ar); }
  void archive(Reader& ar) override { fields(ar); }
  bool stops() const override { return by_.has_value(); }
  std::int64_t unseen_steps() const override {
    std::int64_t most = 0;
    for (const auto& finder : finders_) most = std::max(most, finder->unseen());
    return most;
  }
  void add_to(Summary& summary) const override {
    for (std::size_t i = 0; i < events_.size(); ++i) {
      summary.events.emplace_back("user:" + events_[i].name, finders_[i]->points());
    }
    if (by_) summary.stopped_by = stop_summary(events_[*by_].name, *stopped_by());
  }
  std::vector<std::string> event_notes() const override {
    std::vector<std::string> all;
    for (std::size_t i = 0; i < events_.size(); ++i) {
      if (finders_[i]->jumps() > 0) all.push_back(events_[i].name + ": " + jumps_text(finders_[i]->jumps()));
    }
    return all;
  }
  std::vector<std::int64_t> event_counts() const override {
    std::vector<std::int64_t> all;
    for (const auto& finder : finders_) all.push_back(finder->points());
    return all;
  }
  std::optional<MemberStop> stopped_by() const override {
    if (!by_) return std::nullopt;
    return MemberStop{*by_, where_.time, where_.q, where_.p, where_.digits};
  }

 private:
  void found(std::size_t event, const SectionPoint& point, Recorder* recorder) {
    if (recorder != nullptr) recorder->append(event, step_, point);
    if (!events_[event].stops) return;
    // The first event within a step is the one furthest from the end of the step, for both directions of time.
    if (by_ && std::abs(end_ - where_.time) >= std::abs(end_ - point.time)) return;
    by_ = event;
    where_ = point;
  }
  template <class Archive>
  void fields(Archive& ar) {
    ar(step_, by_, where_.time, where_.q, where_.p, where_.digits.time, where_.digits.q, where_.digits.p);
    for (const auto& finder : finders_) finder->archive(ar);
  }

  const std::vector<UserEvent>& events_;
  double dt_;
  std::vector<std::unique_ptr<SectionFinder>> finders_;
  std::int64_t step_ = 0;
  double end_ = 0;                 // time at the end of the step
  std::optional<std::size_t> by_;  // event that ends the run, the first one within its step
  SectionPoint where_;
};

template <class Ar>
void events_entry(Ar& ar, Summary& summary) {
  ar.if_any("event_notes", summary.event_notes);
  ar.if_any("stopped_by", summary.stopped_by);
}

}  // namespace

MeasureKind measure_events() {
  return {.key = "stopped_by",
          .label = "stopped by",
          .requested = [](const Scenario& scenario) { return !scenario.events.empty(); },
          .make_of_run = [](const Scenario& scenario, const Simulation& simulation, Recorder* recorder)
              -> std::unique_ptr<Measure> { return std::make_unique<EventsMeasure>(scenario, simulation, recorder); },
          .write = events_entry,
          .read = events_entry,
          .text =
              [](const Summary& s) {
                if (!s.stopped_by) return std::string();
                return s.stopped_by->event + " at t = " + number_text(time_of(*s.stopped_by), "{:.17g}");
              },
          .counts_events = true};
}

}  // namespace hamflow
