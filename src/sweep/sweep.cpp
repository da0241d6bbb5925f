#include "sweep.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <limits>
#include <optional>
#include <span>
#include <system_error>
#include <thread>

#include "engine/planetary_steps.hpp"
#include "hamflow/core/stop_question.hpp"
#include "hamflow/run/section.hpp"
#include "lane_run.hpp"
#include "on_threads.hpp"

namespace hamflow {

void Sweep::restore(std::size_t member, MemberRow row) {
  steps_before_ += row.steps;
  rows_[place(member)] = std::move(row);
}

std::size_t Sweep::members_left() const {
  return static_cast<std::size_t>(
      std::count_if(rows_.begin(), rows_.end(), [](const MemberRow& row) { return !row.is_finished(); }));
}

void Sweep::put(std::size_t member, MemberRow row) {
  const bool is_finished = row.is_finished();
  {
    const std::lock_guard lock(rows_mutex_);
    rows_[place(member)] = std::move(row);
  }
  if (!is_finished || !finished_) return;
  const std::lock_guard lock(finished_mutex_);
  finished_(member);
}

/// Calls the caller's pulse, at most every 20 ms and only on the caller's thread. So its exceptions reach the caller,
/// and no second thread is needed.
class Sweep::Pulse {
 public:
  Pulse(Sweep& sweep, const std::function<bool(std::int64_t)>& pulse) : sweep_(sweep), pulse_(pulse) {}
  bool is_on_this_thread() const { return std::this_thread::get_id() == caller_; }
  void ask_if_due() {
    const Clock::time_point now = Clock::now();
    if (!pulse_ || sweep_.stop_ || now - last_ < interval) return;
    last_ = now;
    if (!pulse_(sweep_.steps_taken_)) sweep_.stop_ = true;
  }
  static constexpr std::chrono::milliseconds interval{20};

 private:
  using Clock = std::chrono::steady_clock;
  Sweep& sweep_;
  const std::function<bool(std::int64_t)>& pulse_;
  std::thread::id caller_ = std::this_thread::get_id();
  Clock::time_point last_ = Clock::now();
};

/// The resources of one thread.
class Sweep::Worker {
 public:
  /// @param pulse null: another thread calls it
  Worker(Sweep& sweep, Pulse* pulse) : sweep_(sweep), pulse_(pulse) {}

  void carry_out(const Task& task) {
    if (task.group->lanes == 0) {
      run_alone(task.group->members[task.first]);
    } else {
      run_in_lanes(task);
      // Members that differ in what a block shares, such as the position of a wall, form different groups.
      if (task.count == task.group->members.size()) blocks_.erase(task.group);
    }
  }

 private:
  using Clock = std::chrono::steady_clock;

  /// A member in a lane, with its observers.
  struct Watched {
    Scenario scenario;
    MemberRow row{};
    std::unique_ptr<MemberObserver> watch{};
    std::optional<SectionSearch> section{};
  };

  void run_in_lanes(const Task& task) {
    const Group& group = *task.group;
    auto& block = blocks_[task.group];
    if (!block) block = make_ensemble_block(group.request, sweep_.options_.lanes);
    const std::span<const std::size_t> members(group.members.data() + task.first, task.count);
    std::vector<MemberStart> starts;
    for (const std::size_t member : members) starts.push_back(sweep_.starts_[sweep_.place(member)]);
    const bool is_watched = group.observables.watch || group.has_section;
    if (!block->load(group.shape, starts)) {
      for (const std::size_t member : members) run_alone(member);
      return;
    }
    std::vector<std::unique_ptr<Watched>> watched;
    for (std::size_t lane = 0; is_watched && lane < task.count; ++lane)
      watched.push_back(watched_of(members[lane], group));
    LaneRun run(*block, observers_of(watched));
    std::int64_t chunk = 256;
    while (run.taken() < group.steps && goes_on()) {
      const auto begin = Clock::now();
      const std::int64_t steps = std::min(chunk, group.steps - run.taken());
      run.advance(steps);
      sweep_.steps_taken_ += steps * static_cast<std::int64_t>(task.count);
      if (Clock::now() - begin < std::chrono::milliseconds(10)) chunk = std::min(chunk * 2, std::int64_t{1} << 40);
    }
    run.take_sums();
    for (std::size_t lane = 0; lane < task.count; ++lane) {
      if (!is_watched) watched.push_back(std::make_unique<Watched>());
      finish_lane(members[lane], block->look(lane), run.taken(), group.steps, *watched[lane]);
    }
  }

  std::unique_ptr<Watched> watched_of(std::size_t member, const Group& group) {
    auto one = std::make_unique<Watched>(Watched{scenario_of(member)});
    if (group.observables.watch) one->watch = group.observables.watch(one->scenario, nullptr);
    if (one->scenario.section) one->section.emplace(*one->scenario.section, points_of(one->row));
    return one;
  }
  static std::vector<LaneObservers> observers_of(const std::vector<std::unique_ptr<Watched>>& watched) {
    std::vector<LaneObservers> all;
    for (const auto& one : watched) {
      LaneObservers& observers = all.emplace_back();
      if (one->watch) observers = {one->watch->observers(), one->watch->tangents(), nullptr, one->watch->sums()};
      if (one->section) observers.section = &*one->section;
    }
    return all;
  }
  /// Returns a function that stores the points of a member's section in its row.
  static std::function<void(const SectionPoint&)> points_of(MemberRow& row) {
    return [&row](const SectionPoint& point) {
      row.section.push_back(point.time);
      row.section.insert(row.section.end(), point.q.begin(), point.q.end());
      row.section.insert(row.section.end(), point.p.begin(), point.p.end());
      if (point.digits.q.empty()) return;
      row.section_digits.push_back(point.digits.time);
      row.section_digits.insert(row.section_digits.end(), point.digits.q.begin(), point.digits.q.end());
      row.section_digits.insert(row.section_digits.end(), point.digits.p.begin(), point.digits.p.end());
    };
  }

  static void take_section(const SectionSearch& search, MemberRow& row) {
    row.section_residual = search.max_residual();
    row.section_message = search.message();
  }

  /// @param taken number of steps taken; less than `steps` if the sweep was stopped
  void finish_lane(std::size_t member, MemberEnd end, std::int64_t taken, std::int64_t steps, Watched& watched) {
    if (!end.regular) {  // a single run finds out what happened, and when
      if (taken == steps) run_alone(member);
      return;
    }
    MemberRow& row = watched.row;
    row.status = taken == steps ? Outcome::done : Outcome::stopped;
    row.steps = taken;
    row.t = 0.0 + static_cast<double>(taken) * sweep_.starts_[sweep_.place(member)].h;
    row.q = std::move(end.q);
    row.p = std::move(end.p);
    row.energy = energy_of(end.energy, sweep_.common());
    row.invariants = std::move(end.invariants);
    row.walls = std::move(end.walls);
    row.halved = end.halved;
    if (watched.section) take_section(*watched.section, row);
    if (row.status == Outcome::done) {
      if (watched.watch) row.observables = watched.watch->row();
      if (may_be_meaningless(row)) row.nonsense = sweep_.options_.is_meaningless(scenario_of(member), row);
    }
    sweep_.put(member, std::move(row));
  }

  /// Runs a simulation, counts its steps, and stops it after Ctrl-C.
  Outcome go(Simulation& simulation, std::int64_t steps, std::span<Observer* const> observers) {
    std::int64_t counted = 0;
    const auto count = [&](std::int64_t step) {
      sweep_.steps_taken_ += step - counted;
      counted = step;
      return goes_on();
    };
    const std::function<bool()> inside_a_step = [this] { return goes_on(); };
    const StopQuestion question(inside_a_step);
    const Outcome outcome = hamflow::run(simulation, steps, observers, count);
    count(simulation.step());
    return outcome;
  }

  void run_alone(std::size_t member) {
    const Scenario scenario = scenario_of(member);
    const auto simulation = make_simulation(scenario.request);
    MemberRow row;
    std::optional<SectionFinder> finder;
    std::vector<Observer*> observers;
    if (scenario.section) {
      finder.emplace(*simulation, *scenario.section, points_of(row));
      observers.push_back(&*finder);
    }
    std::unique_ptr<MemberObserver> watch;
    if (const MemberObservables seen = sweep_.observables_of(scenario); seen.watch) {
      watch = seen.watch(scenario, simulation.get());
      const std::vector<Observer*> more = watch->observers();
      observers.insert(observers.end(), more.begin(), more.end());
    }
    Outcome outcome = go(*simulation, scenario.steps, observers);
    if (watch) row.stopped_by = watch->stopped_by();
    if (outcome == Outcome::stopped && row.stopped_by) outcome = Outcome::done;  // one of its events stopped the run
    if (finder) take_section(finder->search(), row);
    Frame frame;
    simulation->look(frame);
    if (watch) advance_tangents_to_end(watch->tangents(), frame);
    row.status = outcome;
    row.steps = frame.step;
    row.t = frame.time;
    row.q = frame.q;
    row.p = frame.p;
    row.digits = frame.digits;
    row.energy = energy_of(simulation->energy(), scenario);
    row.invariants = simulation->invariants();
    row.walls = simulation->wall_counts();
    row.halved = simulation->effort().halved;
    if (const auto* const planets = dynamic_cast<const PlanetarySteps*>(simulation.get())) {
      row.close_encounter = planets->first_encounter().has_value();
    }
    if (watch) {
      row.events = watch->events();
      row.event_notes = watch->event_notes();
    }
    row.message =
        outcome == Outcome::non_finite || outcome == Outcome::lattice_overflow ? "" : cause_of(simulation->failure());
    if (row.message.empty() || !is_failure(outcome)) row.message = message(outcome);
    // Without a step, too, a member reports what its start shows, like a single run.
    if (watch && (frame.step > 0 || outcome != Outcome::stopped)) row.observables = watch->row();
    if (outcome == Outcome::done && may_be_meaningless(row))
      row.nonsense = sweep_.options_.is_meaningless(scenario, row);
    sweep_.put(member, std::move(row));
  }

  /// A map conserves a quantity that is not an energy and has no scale.
  static Excursion energy_of(Excursion energy, const Scenario& scenario) {
    if (scenario.map) energy.scale_at_start = std::numeric_limits<double>::quiet_NaN();
    return energy;
  }

  bool may_be_meaningless(const MemberRow& row) const {
    if (!sweep_.options_.is_meaningless || std::isnan(row.energy.scale())) return false;
    return row.energy.max_error > (row.energy.exchanged > 0 ? row.energy.exchanged : row.energy.scale());
  }

  bool goes_on() {
    if (pulse_ != nullptr) pulse_->ask_if_due();
    return !sweep_.stop_;
  }

  /// Reads the scenario again, because 10^5 scenarios at once would fill the memory.
  Scenario scenario_of(std::size_t member) {
    if (!reader_) reader_.emplace(sweep_.varied_, sweep_.raw_text_, sweep_.name_, sweep_.sets_);
    Reading reading = reader_->read(member);
    if (!reading.scenario) throw Error("a member of the sweep can no longer be read");
    return *std::move(reading.scenario);
  }

  Sweep& sweep_;
  Pulse* pulse_;
  std::map<const Group*, std::unique_ptr<EnsembleBlock>> blocks_;
  std::optional<MemberReader> reader_;
};

void Sweep::run(const std::function<bool(std::int64_t)>& pulse, const std::function<void(std::size_t)>& finished) {
  finished_ = finished;
  steps_taken_ = steps_before_;
  std::vector<Task> tasks;
  for (auto& [key, group] : groups_) {
    std::erase_if(group.members, [this](std::size_t member) { return row(member).is_finished(); });
    const std::size_t at_once = std::max<std::size_t>(group.lanes, 1);
    for (std::size_t i = 0; i < group.members.size(); i += at_once) {
      tasks.push_back({&group, i, std::min(at_once, group.members.size() - i)});
    }
  }
  // The longest tasks come first, so that at the end no thread is left with a long one.
  std::stable_sort(tasks.begin(), tasks.end(),
                   [](const Task& a, const Task& b) { return a.group->steps > b.group->steps; });
  std::atomic<std::size_t> next{0};
  Pulse asked(*this, pulse);
  std::mutex mutex;
  std::condition_variable one_is_done;
  int others = 0;  // working threads, without the caller's
  const auto take_tasks = [&](Pulse* own) {
    Worker worker(*this, own);
    for (std::size_t i = next++; i < tasks.size() && !stop_; i = next++) {
      if (own != nullptr) own->ask_if_due();
      worker.carry_out(tasks[i]);
    }
  };
  const int wanted = std::min<int>(threads_, static_cast<int>(std::max<std::size_t>(tasks.size(), 1)));
  const int started = on_threads(wanted, [&] {
    try {
      if (asked.is_on_this_thread()) {
        take_tasks(&asked);
        std::unique_lock lock(mutex);
        while (!one_is_done.wait_for(lock, Pulse::interval, [&] { return others == 0; })) asked.ask_if_due();
        return;
      }
      std::unique_lock lock(mutex);
      ++others;
      lock.unlock();
      const auto end = [&] {
        lock.lock();
        --others;
        one_is_done.notify_all();
      };
      try {
        take_tasks(nullptr);
      } catch (...) {
        end();
        throw;
      }
      end();
    } catch (...) {  // after a failure all threads stop
      stop_ = true;
      throw;
    }
  });
  if (started < wanted) threads_ = started;
}

}  // namespace hamflow
