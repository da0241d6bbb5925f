#include "sweep.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <limits>
#include <optional>
#include <span>
#include <system_error>
#include <thread>

#include "hamflow/run/observer.hpp"
#include "hamflow/run/section.hpp"
#include "lane_run.hpp"
#include "memory.hpp"

namespace hamflow {

namespace {

/// Each thread has its own copy of the scenario. An exception of a thread is passed on to the caller. Where the system
/// starts fewer threads, these do the work: it has the same bits. @return the number of threads, the caller included
template <class Work>
int on_threads(int threads, const Work& work) {
  std::exception_ptr trouble;
  std::mutex mutex;
  const auto guarded = [&] {
    try {
      work();
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!trouble) trouble = std::current_exception();
    }
  };
  int started = 1;
  {
    std::vector<std::jthread> others;
    try {
      for (; started < threads; ++started) others.emplace_back(guarded);
    } catch (const std::system_error&) {  // NOLINT: told by the number
    }
    guarded();
  }
  if (trouble) std::rethrow_exception(trouble);
  return started;
}

}  // namespace

Sweep::Sweep(const std::string& text, const std::string& name, const std::vector<std::string>& sets, Varied varied,
             SweepOptions options)
    : varied_(std::move(varied)), options_(std::move(options)), raw_text_(text), name_(name), sets_(sets) {
  MemberReader reader(varied_, text, name, sets);
  text_ = reader.family().text();
  for (const Complaint& complaint : reader.family().complaints()) complaints_.push_back(complaint.text());
  if (!complaints_.empty()) return;
  const std::size_t members = varied_.members();
  if (const std::string wrong = refused_members(members, coordinates_of_first(reader), available_memory());
      !wrong.empty()) {
    complaints_.push_back("--vary: error: " + wrong);
    return;
  }
  rows_.resize(members);
  starts_.resize(rows_.size());
  threads_ = options_.threads > 0 ? options_.threads : static_cast<int>(std::thread::hardware_concurrency());
  threads_ = std::max(threads_, 1);
  read_members(name);
  if (complaints_.empty() && !common_.events.empty()) {
    complaints_.push_back("run.events: error: found events; allowed in single runs: a sweep keeps none of its members");
  }
  if (complaints_.empty() && options_.observables_of) observables_ = options_.observables_of(common_);
}

/// 0 where it cannot be read, which is told later.
std::size_t Sweep::coordinates_of_first(MemberReader& reader) const {
  const Reading reading = reader.read(0);
  const std::optional<Scenario>& any = reading.scenario ? reading.scenario : reading.startless;
  return any ? any->start_q.size() : 0;
}

void Sweep::read_members(const std::string& name) {
  std::atomic<std::size_t> next{0};
  constexpr std::size_t batch = 64;
  const auto work = [&] {
    MemberReader reader(varied_, raw_text_, name, sets_);
    for (std::size_t begin = next.fetch_add(batch); begin < rows_.size(); begin = next.fetch_add(batch)) {
      for (std::size_t member = begin; member < std::min(begin + batch, rows_.size()); ++member) {
        const Reading reading = reader.read(member);
        if (reading.scenario) {
          add(member, *reading.scenario);
        } else if (reading.startless) {
          leave_without_start(member, reading);
        } else {
          add_complaints(member, reading, reader.paths());
        }
      }
    }
  };
  (void)on_threads(rows_.size() > 4 * batch ? threads_ : 1, work);
  if (!found_.empty()) {
    report(found_);
    return;
  }
  for (auto& [key, group] : groups_) std::sort(group.members.begin(), group.members.end());
}

void Sweep::add_complaints(std::size_t member, const Reading& reading, const std::vector<std::string>& paths) {
  const std::lock_guard lock(mutex_);
  for (const Complaint& complaint : reading.complaints) {
    std::string text = varied_.as_typed(complaint.text(), member);
    const bool of_vary = std::any_of(paths.begin(), paths.end(), [&](const std::string& path) {
      return path.starts_with(complaint.key) || complaint.key.starts_with(path);
    });
    if (complaint.line == 0 && of_vary) text = "--vary" + text.substr(std::string("--set").size());
    found_[text].push_back(member);
  }
}

void Sweep::leave_without_start(std::size_t member, const Reading& reading) {
  const std::lock_guard lock(mutex_);
  take_as_common(member, *reading.startless);
  rows_[member].no_start = true;
  rows_[member].message = reading.no_start;
}

void Sweep::report(const std::map<std::string, std::vector<std::size_t>>& found) {
  constexpr std::size_t most = 10;
  std::vector<std::pair<std::size_t, std::string>> lines;
  for (const auto& [text, members] : found) {
    const std::size_t first = *std::min_element(members.begin(), members.end());
    const bool all = members.size() == rows_.size();
    lines.emplace_back(first, all ? text
                                  : text + " (" + varied_.described(first) +
                                        (members.size() > 1 ? "; " + std::to_string(members.size()) + " members" : "") +
                                        ")");
  }
  std::sort(lines.begin(), lines.end());
  for (std::size_t i = 0; i < std::min(lines.size(), most); ++i) complaints_.push_back(lines[i].second);
  if (lines.size() > most) {
    complaints_.push_back("error: and " + std::to_string(lines.size() - most) + " more of this kind");
  }
}

/// Rows of one table have the same columns. What the first member with a start has, all have.
void Sweep::take_as_common(std::size_t member, const Scenario& scenario) {
  const bool has_start = !scenario.start_p.empty() && scenario.start_p.front() == scenario.start_p.front();
  const bool alike = common_.problem == nullptr || (scenario.start_q.size() == common_.start_q.size() &&
                                                    scenario.problem->info.name == common_.problem->info.name);
  if (!alike) {
    found_
        ["--vary: error: problem: found members of different problems or numbers of coordinates; allowed one table, "
         "that is one problem of one size"]
            .push_back(member);
  }
  const bool better = has_start == common_has_start_ ? member < common_member_ : has_start;
  if (common_.problem != nullptr && !better) return;
  common_ = scenario;
  common_member_ = member;
  common_has_start_ = has_start;
}

void Sweep::add(std::size_t member, const Scenario& scenario) {
  const Request& request = scenario.request;
  const Parameters<double> parameters(request.parameters);
  ParameterShape shape;
  MemberStart start{scenario.start_q, scenario.start_p, {}, evaluate_number<double>(request.dt)};
  std::string key = request.problem + '\n' + request.method.name + '\n' + request.arithmetic + '\n' + request.kernel;
  for (const auto& [option, value] : request.method.options) key += '\n' + option + '=' + value;
  for (const auto& [choice, value] : request.variant) key += '\n' + choice + '=' + value;
  for (const ParameterInfo& info : scenario.problem->info.parameters) {
    if (!parameters.has(info.name)) continue;
    const std::vector<double>& numbers = parameters.list(info.name);
    shape.emplace_back(info.name, numbers.size());
    start.parameters.insert(start.parameters.end(), numbers.begin(), numbers.end());
    key += '\n' + info.name + ' ' + std::to_string(numbers.size());
  }
  key += '\n' + std::to_string(scenario.steps);

  const std::lock_guard lock(mutex_);
  take_as_common(member, scenario);
  auto [at, is_new] = groups_.try_emplace(key);
  Group& group = at->second;
  if (is_new) {
    group.request = request;
    group.shape = shape;
    group.steps = scenario.steps;
    const auto block = make_ensemble_block(request, options_.lanes);
    group.lanes = block == nullptr || !block->load(shape, {&start, 1}) ? 0 : block->lanes();
  }
  group.members.push_back(member);
  total_steps_ += scenario.steps;
  beyond_double_ = beyond_double_ || digits_beyond_double(request.arithmetic) > 0;
  if (group.lanes > 0) {
    ++in_lanes_;
    lane_count_ = group.lanes;
    starts_[member] = std::move(start);
  }
}

/// The resources of one thread.
class Sweep::Worker {
 public:
  explicit Worker(Sweep& sweep) : sweep_(sweep) {}

  void carry_out(const Task& task) {
    if (task.group->lanes == 0) {
      run_alone(task.group->members[task.first]);
    } else {
      run_in_lanes(task);
    }
  }

 private:
  using Clock = std::chrono::steady_clock;

  /// A member in a lane, with what observes it.
  struct Watched {
    Scenario scenario;
    std::unique_ptr<MemberWatch> watch{};
    std::optional<SectionSearch> section{};
  };

  void run_in_lanes(const Task& task) {
    const Group& group = *task.group;
    auto& block = blocks_[task.group];
    if (!block) block = make_ensemble_block(group.request, sweep_.options_.lanes);
    const std::span<const std::size_t> members(group.members.data() + task.first, task.count);
    std::vector<MemberStart> starts;
    for (const std::size_t member : members) starts.push_back(sweep_.starts_[member]);
    const bool is_watched = sweep_.observables_.watch || sweep_.common_.section;
    if (!block->load(group.shape, starts)) {
      for (const std::size_t member : members) run_alone(member);
      return;
    }
    std::vector<std::unique_ptr<Watched>> watched;
    for (std::size_t lane = 0; is_watched && lane < task.count; ++lane) watched.push_back(watched_of(members[lane]));
    LaneRun run(*block, observers_of(watched));
    std::int64_t chunk = 256;
    while (run.taken() < group.steps && !sweep_.stop_) {
      const auto begin = Clock::now();
      const std::int64_t steps = std::min(chunk, group.steps - run.taken());
      run.advance(steps);
      sweep_.steps_taken_ += steps * static_cast<std::int64_t>(task.count);
      if (Clock::now() - begin < std::chrono::milliseconds(10)) chunk = std::min(chunk * 2, std::int64_t{1} << 40);
    }
    run.take_sums();
    for (std::size_t lane = 0; lane < task.count; ++lane) {
      finish_lane(members[lane], block->look(lane), run.taken(), group.steps,
                  is_watched ? watched[lane].get() : nullptr);
    }
  }

  std::unique_ptr<Watched> watched_of(std::size_t member) {
    auto one = std::make_unique<Watched>(Watched{scenario_of(member)});
    if (sweep_.observables_.watch) one->watch = sweep_.observables_.watch(one->scenario);
    if (one->scenario.section) one->section.emplace(*one->scenario.section, points_of(sweep_.rows_[member]));
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
  /// What takes the points of a member's section.
  static std::function<void(const SectionPoint&)> points_of(MemberRow& row) {
    return [&row](const SectionPoint& point) {
      row.section.push_back(point.time);
      row.section.insert(row.section.end(), point.q.begin(), point.q.end());
      row.section.insert(row.section.end(), point.p.begin(), point.p.end());
    };
  }

  /// @param taken of all steps: fewer where the sweep was stopped
  void finish_lane(std::size_t member, MemberEnd end, std::int64_t taken, std::int64_t steps, const Watched* watched) {
    MemberRow& row = sweep_.rows_[member];
    if (!end.regular) {  // the single run shows what happened, and when
      row.section.clear();
      if (taken == steps) run_alone(member);
      return;
    }
    row.status = taken == steps ? Outcome::done : Outcome::stopped;
    row.steps = taken;
    row.t = 0.0 + static_cast<double>(taken) * sweep_.starts_[member].h;
    row.q = std::move(end.q);
    row.p = std::move(end.p);
    row.energy = end.energy;
    row.energy_scale = end.energy_scale;
    row.invariants = std::move(end.invariants);
    row.walls = std::move(end.walls);
    if (watched != nullptr && watched->section) row.section_residual = watched->section->max_residual();
    if (row.status != Outcome::done) return;
    if (watched != nullptr && watched->watch) row.observables = watched->watch->row();
    if (is_suspect(row)) row.nonsense = sweep_.options_.is_nonsense(scenario_of(member), row);
  }

  /// A run whose steps are counted and which Ctrl-C ends.
  Outcome go(Simulation& simulation, std::int64_t steps, std::span<Observer* const> observers) {
    std::int64_t counted = 0;
    const auto count = [&](std::int64_t step) {
      sweep_.steps_taken_ += step - counted;
      counted = step;
      return !sweep_.stop_;
    };
    const Outcome outcome = hamflow::run(simulation, steps, observers, count);
    count(simulation.step());
    return outcome;
  }

  void run_alone(std::size_t member) {
    const Scenario scenario = scenario_of(member);
    const auto simulation = make_simulation(scenario.request);
    MemberRow& row = sweep_.rows_[member];
    std::optional<SectionFinder> finder;
    std::vector<Observer*> observers;
    if (scenario.section) {
      finder.emplace(*simulation, *scenario.section, points_of(row));
      observers.push_back(&*finder);
    }
    std::unique_ptr<MemberWatch> watch;
    if (sweep_.observables_.watch) {
      watch = sweep_.observables_.watch(scenario);
      const std::vector<Observer*> more = watch->observers();
      observers.insert(observers.end(), more.begin(), more.end());
    }
    const Outcome outcome = go(*simulation, scenario.steps, observers);
    if (finder) row.section_residual = finder->max_residual();
    Frame frame;
    simulation->look(frame);
    row.status = outcome;
    row.steps = frame.step;
    row.t = frame.time;
    row.q = frame.q;
    row.p = frame.p;
    row.digits = frame.digits;
    row.energy = simulation->energy();
    row.energy_scale = simulation->energy_scale();
    row.invariants = simulation->invariants();
    row.walls = simulation->wall_counts();
    row.message = outcome == Outcome::non_finite || outcome == Outcome::lattice_overflow ? "" : simulation->failure();
    if (row.message.empty() || !is_failure(outcome)) row.message = message(outcome);
    if (watch && frame.step > 0) row.observables = watch->row();
    if (outcome == Outcome::done && is_suspect(row)) row.nonsense = sweep_.options_.is_nonsense(scenario, row);
  }

  bool is_suspect(const MemberRow& row) const {
    return sweep_.options_.is_nonsense && row.energy.max_error > row.energy_scale;
  }

  /// Read anew: 10^5 scenarios at once would fill the memory.
  Scenario scenario_of(std::size_t member) {
    if (!reader_) reader_.emplace(sweep_.varied_, sweep_.raw_text_, sweep_.name_, sweep_.sets_);
    Reading reading = reader_->read(member);
    if (!reading.scenario) throw Error("a member of the sweep can no longer be read");
    return *std::move(reading.scenario);
  }

  Sweep& sweep_;
  std::map<const Group*, std::unique_ptr<EnsembleBlock>> blocks_;
  std::optional<MemberReader> reader_;
};

void Sweep::run(const std::function<bool(std::int64_t)>& pulse) {
  std::vector<Task> tasks;
  for (const auto& [key, group] : groups_) {
    const std::size_t at_once = std::max<std::size_t>(group.lanes, 1);
    for (std::size_t i = 0; i < group.members.size(); i += at_once) {
      tasks.push_back({&group, i, std::min(at_once, group.members.size() - i)});
    }
  }
  // The longest first, so that no thread is left with one at the end.
  std::stable_sort(tasks.begin(), tasks.end(),
                   [](const Task& a, const Task& b) { return a.group->steps > b.group->steps; });
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::condition_variable finished;
  bool over = false;
  const auto look = [&] {
    std::unique_lock lock(mutex);
    while (!finished.wait_for(lock, std::chrono::milliseconds(20), [&] { return over; })) {
      if (pulse && !pulse(steps_taken_)) stop_ = true;
    }
  };
  std::jthread watch;
  try {
    watch = std::jthread(look);
  } catch (const std::system_error& error) {
    throw Error(std::string("a sweep needs one thread beside its own, and none can be started here (") +
                error.code().message() + ")");
  }
  const auto end = [&] {
    const std::lock_guard lock(mutex);
    over = true;
    finished.notify_all();
  };
  try {
    const int wanted = std::min<int>(threads_, static_cast<int>(std::max<std::size_t>(tasks.size(), 1)));
    const int started = on_threads(wanted, [&] {
      Worker worker(*this);
      for (std::size_t i = next++; i < tasks.size() && !stop_; i = next++) worker.carry_out(tasks[i]);
    });
    if (started < wanted) threads_ = started;
  } catch (...) {
    end();
    throw;
  }
  end();
}

}  // namespace hamflow
