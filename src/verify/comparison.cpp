#include "hamflow/verify/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <optional>

#include "comparison_jobs.hpp"
#include "hamflow/core/stop_question.hpp"
#include "hamflow/detail/verify/state_units.hpp"
#include "state_difference.hpp"

namespace hamflow {

namespace {

using Clock = std::chrono::steady_clock;
/// Receives the finished fraction of a run; returns false to stop.
using Pulse = std::function<bool(double part)>;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double median(std::vector<double> xs) {
  const auto middle = xs.begin() + static_cast<std::ptrdiff_t>(xs.size() / 2);
  std::nth_element(xs.begin(), middle, xs.end());
  return *middle;
}

struct Timing {
  Outcome outcome = Outcome::done;
  std::vector<double> wall{};
  std::vector<double> processor{};
};

/// Runs in blocks that grow until the time for reading the clock is negligible. A single slow step is a block of its
/// own.
Outcome timed_run(Simulation& simulation, std::int64_t steps, const Pulse& pulse, Timing& timing) {
  const double processor_begin = processor_seconds();
  const auto begin = Clock::now();
  auto block_begin = begin;
  std::int64_t block = 1;
  while (simulation.step() < steps) {
    const Outcome outcome = simulation.advance(std::min(block, steps - simulation.step()));
    if (outcome != Outcome::done) return outcome;
    const auto now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - block_begin).count();
    block_begin = now;
    if (seconds < 0.002) {
      block *= 8;
      continue;
    }
    if (seconds > 0.05) block = std::max<std::int64_t>(block / 2, 1);
    if (!pulse(static_cast<double>(simulation.step()) / static_cast<double>(steps))) return Outcome::stopped;
  }
  timing.wall.push_back(seconds_since(begin));
  timing.processor.push_back(processor_seconds() - processor_begin);
  return Outcome::done;
}

/// Repeats the bare steps, without watching the energy, for the median of at least seven runs and 20 ms. A run that
/// takes longer than a quarter of a second is repeated less often. Beyond double the first run counts too, because
/// watching costs little compared with the steps.
Outcome time_again(const Request& request, std::int64_t steps, bool beyond_double, const Pulse& pulse, Timing& timing) {
  constexpr double enough = 0.02;
  constexpr double much = 0.25;
  constexpr std::size_t most = 2000;
  Request bare = request;
  bare.watch = false;
  if (!beyond_double) timing = {};
  double sum = timing.wall.empty() ? 0 : timing.wall.back();
  while ((sum < enough || (timing.wall.size() < 7 && sum < (beyond_double ? enough : much))) &&
         timing.wall.size() < most) {
    const auto simulation = make_simulation(bare);
    const Outcome outcome = timed_run(*simulation, steps, pulse, timing);
    if (outcome != Outcome::done) return outcome;
    sum += timing.wall.back();
  }
  return Outcome::done;
}

std::string reason_of(const Simulation& simulation, Outcome outcome) {
  Frame frame;
  simulation.look(frame);
  const bool says_more = outcome == Outcome::not_converged || outcome == Outcome::wall || outcome == Outcome::outside;
  const std::string own_words = says_more ? cause_of(simulation.failure()) : std::string();
  return fmt::format("step {}, from t = {}: {}", frame.step + 1, shortest(frame.time),
                     own_words.empty() ? std::string(message(outcome)) : own_words);
}

/// Runs a job, except for the error against the reference. Returns Outcome::stopped if the pulse stops it.
Outcome carry_out(ComparisonJob& job, const Pulse& pulse) {
  ComparisonPoint& point = job.point;
  const bool beyond_double = digits_beyond_double(job.request.arithmetic) > 0;
  const auto begin = Clock::now();
  const auto simulation = make_simulation(job.request);
  Timing timing;
  double whole = 1;  // the fraction of the job's time that this run takes
  const Pulse of_job = [&](double part) { return pulse(part * whole); };
  // Beyond double a step takes so long that the pulse is called within it.
  const std::function<bool()> goes_on = [&] {
    return of_job(static_cast<double>(simulation->step()) / static_cast<double>(point.steps));
  };
  std::optional<StopQuestion> question;
  if (beyond_double) question.emplace(goes_on);
  point.outcome = timed_run(*simulation, point.steps, of_job, timing);
  if (point.outcome == Outcome::stopped) return Outcome::stopped;
  job.seconds = seconds_since(begin);
  const Effort effort = simulation->effort();
  point.force = effort.force;
  point.gradient = effort.gradient;
  point.hessian = effort.hessian;
  point.linear_solves = effort.linear_solves;
  job.finished = true;
  if (!point.done()) {
    point.failure = reason_of(*simulation, point.outcome);
    return point.outcome;
  }
  Frame end;
  simulation->look(end);
  job.end = state_digits(end);
  const Excursion energy = simulation->energy();
  const double scale = simulation->energy_scale() > 0 ? simulation->energy_scale() : 1;
  point.max_energy_error = energy.max_error / scale;
  point.end_energy_error = beyond_double ? relative_difference(end.digits.energy, end.digits.initial_energy, scale,
                                                               digits_of(job.request.arithmetic) + 10)
                                         : Magnitude(std::abs(energy.final - energy.initial) / scale);
  if (energy.max_error == 0) point.max_energy_error = point.end_energy_error;  // the error is below the range of double
  if (time_again(
          job.request, point.steps, beyond_double, [&](double) { return pulse(1); }, timing) == Outcome::stopped) {
    job.finished = false;
    return Outcome::stopped;
  }
  point.wall_seconds = median(timing.wall);
  // The time that other programs take from the processor does not count. The smaller time is used, because reading the
  // processor's clock is slow.
  point.seconds = std::min(point.wall_seconds, median(timing.processor));
  return Outcome::done;
}

/// Moves angles by whole turns to the value nearest to the reference, because a closed form gives angles only up to
/// whole turns.
void unwind(const ProblemInfo& info, const ReferenceSolution& reference, std::vector<std::string>& end) {
  if (reference.kind != "closed form") return;
  const double turn = 2 * pi_value<double>();
  for (std::size_t i = 0; i < info.coordinates.size() && i < end.size() / 2; ++i) {
    if (info.coordinates[i] != "phi") continue;
    const double x = std::strtod(end[i].c_str(), nullptr);
    end[i] = exact_digits(reference.end[i] + std::remainder(x - reference.end[i], turn));
  }
}

/// Returns the largest difference of each group of numbers with one unit, in that unit.
std::vector<std::pair<std::string, Magnitude>> differences_of(const ProblemEntry& problem,
                                                              const std::vector<std::string>& end,
                                                              const std::vector<std::string>& reference, int digits) {
  const std::size_t n = end.size() / 2;
  const UnitGroups groups = unit_groups(problem, n);
  std::vector<std::pair<std::string, Magnitude>> all;
  for (std::size_t g = 0; g < 2 * groups.count(); ++g) {
    std::vector<std::string> a, b;
    for (std::size_t i = 0; i < 2 * n; ++i) {
      if ((i < n ? groups.group(i) : groups.count() + groups.group(i - n)) != g) continue;
      a.push_back(end[i]);
      b.push_back(reference[i]);
    }
    const std::string& name = g < groups.count() ? groups.q[g] : groups.p[g - groups.count()];
    all.emplace_back(name, largest_difference(a, b, std::vector<double>(a.size(), 1), digits));
  }
  return all;
}

void judge(ComparisonJob& job, const ProblemEntry& problem, const ReferenceSolution& reference) {
  if (job.end.empty()) return;
  unwind(problem.info, reference, job.end);
  // With twice the digits of the reference, differences of doubles, written as 45-digit decimals, are formed without
  // rounding.
  const int digits = std::max(100, 2 * digits_of(job.request.arithmetic));
  job.point.error = largest_difference(job.end, reference.digits, reference.sizes, digits);
  job.point.differences = differences_of(problem, job.end, reference.digits, digits);
  // A closed form that is known to the last digit has the uncertainty 0. Then an error of 0 is not a bound but a
  // result.
  job.point.below_uncertainty = Magnitude() < reference.uncertainty && !(reference.uncertainty < job.point.error);
}

}  // namespace

std::vector<std::int64_t> usual_step_counts(std::int64_t steps, int count) {
  std::vector<std::int64_t> all;
  for (int k = 0; k < count; ++k) {
    const std::int64_t n = k == 0 ? std::max<std::int64_t>(1, (steps + 1) / 2) : steps << (k - 1);
    if (all.empty() || n != all.back()) all.push_back(n);
  }
  return all;
}

Comparison compare(const ComparisonRequest& asked, const std::function<bool(const ComparisonProgress&)>& progress) {
  const auto problem_entry = find_problem(asked.request);
  const ProblemEntry& problem = *problem_entry;
  Comparison found{asked.request.problem, asked.request.arithmetic, asked.t_end, {}, {}, false};
  found.reference.kind = "none";
  found.reference.description = "none, because the comparison was stopped before it was complete";
  const bool beyond_double = digits_beyond_double(asked.request.arithmetic) > 0;
  std::vector<ComparisonJob> jobs = comparison_jobs(asked);
  ComparisonClock clock(jobs, beyond_double);
  const auto go_on = [&](const ComparisonJob* running, double part) {
    found.stopped = found.stopped || (progress && !progress(clock.look(running, part)));
    return !found.stopped;
  };
  if (!go_on(nullptr, 0)) return found;

  const std::string t_end = asked.t_end_text.empty() ? shortest(asked.t_end) : asked.t_end_text;
  ReferenceRun reference(asked.request, t_end, *std::max_element(asked.steps.begin(), asked.steps.end()));
  const auto follow_reference = [&] {
    const auto begin = Clock::now();
    if (!reference.finished()) reference.advance([&] { return go_on(nullptr, 0); });
    clock.reference_spent(seconds_since(begin), reference.part());
    return go_on(nullptr, 0);
  };
  const auto run_jobs_if = [&](const auto& wanted) {
    for (ComparisonJob& job : jobs) {
      if (job.finished || !wanted(job)) continue;
      if (!go_on(&job, 0)) return false;
      if (carry_out(job, [&](double part) { return go_on(&job, part); }) == Outcome::stopped) return false;
    }
    return true;
  };
  // The shortest run of each method and a first piece of the reference are timed first, to estimate how long the rest
  // will take.
  bool going = follow_reference() && run_jobs_if([&](const ComparisonJob& job) { return job.work == 1; });
  while (going && !reference.finished()) going = follow_reference();
  if (!reference.finished()) return found;
  found.reference = reference.solution();
  if (going) (void)run_jobs_if([](const ComparisonJob&) { return true; });
  for (ComparisonJob& job : jobs) {
    if (!job.finished) continue;
    judge(job, problem, found.reference);
    found.points.push_back(job.point);
  }
  return found;
}

}  // namespace hamflow
