#include <algorithm>
#include <chrono>

#include "hamflow/core/stop_question.hpp"
#include "hamflow/detail/run/step_sums.hpp"
#include "hamflow/run/observer.hpp"

namespace hamflow {

namespace {
struct Frames {
  Frame of_step;
  Frame between;  // of a partial step
};

/// Calls the observers that are due at the simulation's step, in their order.
Outcome wake(const Simulation& simulation, std::span<Observer* const> observers, Frames& frames) {
  // A partial step that was given up would count as one that failed.
  const StopQuestion::Suspended suspended;
  const std::int64_t now = simulation.step();
  bool looked = false;
  Outcome outcome = Outcome::done;
  const auto show = [&](Observer& observer, const Frame& frame) {
    if (observer.observe(frame) == Verdict::stop) outcome = Outcome::stopped;
  };
  for (Observer* observer : observers) {
    if (observer->next_due(now) != now) continue;
    const auto times = observer->times(now);
    for (const std::string& time : times) {
      const Outcome ahead = simulation.look_ahead(time, frames.between);
      if (ahead != Outcome::done) return ahead;
      show(*observer, frames.between);
    }
    if (!times.empty()) continue;
    if (!looked) simulation.look(frames.of_step);
    looked = true;
    show(*observer, frames.of_step);
  }
  return outcome;
}

/// One observer of every step that needs sums alone is spared the steps, where the simulation adds by itself.
class SparedObserver {
 public:
  /// @param observers have seen the present state
  SparedObserver(Simulation& simulation, std::span<Observer* const> observers)
      : simulation_(simulation), others_(observers.begin(), observers.end()) {
    for (auto each = others_.begin(); each != others_.end(); ++each) {
      spared_ = dynamic_cast<SummedSteps*>(*each);
      if (spared_ == nullptr) continue;
      if (simulation.add_to_sums(spared_->summed(), spared_->sums())) {
        others_.erase(each);
      } else {
        spared_ = nullptr;
      }
      return;
    }
  }
  ~SparedObserver() {
    if (spared_ != nullptr) (void)simulation_.add_to_sums({}, {});
  }
  SparedObserver(const SparedObserver&) = delete;
  SparedObserver& operator=(const SparedObserver&) = delete;

  std::span<Observer* const> others() const { return others_; }
  /// Before anybody else sees the state, or asks what was seen.
  void reach(Frame& frame) {
    if (spared_ == nullptr) return;
    simulation_.look(frame);
    spared_->reach(frame);
  }

 private:
  Simulation& simulation_;
  std::vector<Observer*> others_;
  SummedSteps* spared_ = nullptr;
};

std::int64_t earliest_due(std::int64_t from, std::int64_t last, std::span<Observer* const> observers) {
  std::int64_t due = last;
  for (const Observer* observer : observers) due = std::min(due, observer->next_due(from));
  return due;
}
}  // namespace

Outcome run(Simulation& simulation, std::int64_t last_step, std::span<Observer* const> observers,
            const std::function<bool(std::int64_t)>& pulse) {
  using Clock = std::chrono::steady_clock;
  constexpr double wanted_seconds = 0.02;  // between looks at the clock: quick to stop, far too rare to cost anything
  std::int64_t block = 1;                  // a step in many digits can take a second
  std::int64_t since_pulse = 0;
  Clock::time_point pulsed = Clock::now();
  Frames frames;
  if (const Outcome first = wake(simulation, observers, frames); first != Outcome::done) return first;
  SparedObserver spared(simulation, observers);
  while (simulation.step() < last_step) {
    const std::int64_t now = simulation.step();
    const std::int64_t target = std::min(earliest_due(now + 1, last_step, spared.others()), now + block - since_pulse);
    Outcome outcome = simulation.advance(target - now);
    since_pulse += target - now;
    spared.reach(frames.of_step);
    if (outcome == Outcome::done) {
      outcome = wake(simulation, spared.others(), frames);
    } else if (is_failure(outcome)) {
      for (Observer* observer : observers) {
        if (observer->observe_failed_step() == Verdict::stop) outcome = Outcome::stopped;
      }
    }
    if (outcome != Outcome::done) return outcome;
    if (since_pulse >= block) {
      const double seconds = std::chrono::duration<double>(Clock::now() - pulsed).count();
      if (seconds < wanted_seconds / 2) block = std::min(block * (block < 256 ? 16 : 2), std::int64_t{1} << 30);
      if (seconds > wanted_seconds * 2) block = std::max(block / 2, std::int64_t{1});
      pulsed = Clock::now();
      since_pulse = 0;
      if (pulse && !pulse(simulation.step())) return Outcome::stopped;
    }
  }
  return Outcome::done;
}

}  // namespace hamflow
