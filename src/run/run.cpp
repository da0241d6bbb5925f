#include <algorithm>
#include <chrono>

#include "hamflow/core/stop_question.hpp"
#include "hamflow/detail/run/step_sums.hpp"
#include "hamflow/run/observer.hpp"

namespace hamflow {

namespace {
struct Frames {
  Frame of_step;
  Frame between;  // for the state after a partial step
};

/// Calls the observers that are due at the present step, in order.
Outcome call_due_observers(const Simulation& simulation, std::span<Observer* const> observers, Frames& frames) {
  // A partial step that is cancelled would count as failed.
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

/// Takes one observer of every step that needs only sums out of the loop, if the simulation can add the sums itself.
class SummingObserver {
 public:
  /// @param observers that have observed the present state
  SummingObserver(Simulation& simulation, std::span<Observer* const> observers)
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
  ~SummingObserver() {
    if (spared_ != nullptr) (void)simulation_.add_to_sums({}, {});
  }
  SummingObserver(const SummingObserver&) = delete;
  SummingObserver& operator=(const SummingObserver&) = delete;

  std::span<Observer* const> others() const { return others_; }
  /// Call this before another observer sees the state or reads the sums.
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
  constexpr double wanted_seconds =
      0.02;                // between readings of the clock: short enough to stop quickly, long enough to cost nothing
  std::int64_t block = 1;  // start with 1, since a step in many digits can take a second
  std::int64_t since_pulse = 0;
  Clock::time_point pulsed = Clock::now();
  Frames frames;
  if (const Outcome first = call_due_observers(simulation, observers, frames); first != Outcome::done) return first;
  SummingObserver summing(simulation, observers);
  while (simulation.step() < last_step) {
    const std::int64_t now = simulation.step();
    const std::int64_t target = std::min(earliest_due(now + 1, last_step, summing.others()), now + block - since_pulse);
    Outcome outcome = simulation.advance(target - now);
    since_pulse += target - now;
    summing.reach(frames.of_step);
    if (outcome == Outcome::done) {
      outcome = call_due_observers(simulation, summing.others(), frames);
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
