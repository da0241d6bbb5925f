#include "hamflow/verify/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <limits>

#include "rounding.hpp"

namespace hamflow {

namespace {
using Long = long double;

Frame start_of(const ComparisonRequest& asked, const ProblemEntry& problem) {
  Request request = asked.request;
  request.parameters = complete(problem.info, request.parameters);
  return problem.start(request);
}

State<double> joined(const Frame& frame) {
  State<double> z = frame.q;
  z.insert(z.end(), frame.p.begin(), frame.p.end());
  return z;
}

/// Angles that the closed form gives up to whole turns are moved to the nearest.
double largest_difference(const ProblemInfo& info, const State<double>& a, const State<double>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    double difference = std::abs(a[i] - b[i]);
    if (i < info.coordinates.size() && info.coordinates[i] == "phi") {
      difference = std::abs(std::remainder(difference, 2 * pi_value<double>()));
    }
    most = std::max(most, difference);
  }
  return most;
}

double size_of(const State<double>& z) {
  double most = 0;
  for (const double x : z) most = std::max(most, std::abs(x));
  return most;
}

/// The closed form, and what a rounding of the start makes of it: the numerics of the form itself are no worse.
std::optional<ReferenceSolution> closed_form(const ComparisonRequest& asked, const ProblemEntry& problem) {
  if (!problem.exact) return std::nullopt;
  const Texts parameters = complete(problem.info, asked.request.parameters);
  const Frame start = start_of(asked, problem);
  const auto exact = problem.exact(parameters, start.q, start.p, asked.t_end);
  if (!exact) return std::nullopt;
  ReferenceSolution found{"closed form", "the closed form of the problem, in double", joined(*exact), 0};
  found.uncertainty = 4 * epsilon * size_of(found.end);
  for (std::size_t i = 0; i < 2 * start.q.size(); ++i) {
    Frame near = start;
    double& x = i < start.q.size() ? near.q[i] : near.p[i - start.q.size()];
    x += x != 0 ? epsilon * x : epsilon * size_of(joined(start));
    const auto moved = problem.exact(parameters, near.q, near.p, asked.t_end);
    if (moved) found.uncertainty += largest_difference(problem.info, joined(*moved), found.end);
  }
  return found;
}

/// The flow in equal pieces, between which one can stop.
std::optional<State<Long>> pieces(const StepMap& map, State<Long> z, Long t_end, int count,
                                  const std::function<bool()>& pulse) {
  for (int k = 0; k < count; ++k) {
    if (pulse && !pulse()) return std::nullopt;
    z = map.flow(z, t_end / static_cast<Long>(count));
  }
  return z;
}

/// A tolerance for adaptive methods, in place of the k-th dt: a hundredth of the one before, from 1e-3 to 1e-13.
double usual_tolerance(std::size_t k, std::size_t count) {
  return count < 2 ? 1e-8 : std::pow(10.0, -3.0 - 10.0 * static_cast<double>(k) / static_cast<double>(count - 1));
}

/// Whether a method chooses its sub-steps itself: then it has a tolerance to vary, and steps that do not matter.
bool set_tolerance(MethodSpec& method, double tolerance) {
  if (!describe(method).own_substeps) return false;
  method.options[tolerance_option] = shortest(tolerance);
  return true;
}
constexpr std::int64_t adaptive_steps = 32;  // few, as each cuts a sub-step short

struct Timing {
  Outcome outcome = Outcome::done;
  double wall = 0;
  double processor = 0;
};

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

/// The medians of at least seven runs and 20 ms, of the bare steps: no probe, no set-up. Runs that take a second are
/// timed less often.
Timing timed(const Request& request, std::int64_t steps, const std::function<bool(std::int64_t)>& pulse) {
  using Clock = std::chrono::steady_clock;
  constexpr double enough = 0.02;
  constexpr std::size_t most = 2000;
  Request bare = request;
  bare.watch = false;
  std::vector<double> wall;
  std::vector<double> processor;
  double sum = 0;
  while ((sum < enough || (wall.size() < 7 && sum < 1)) && wall.size() < most) {
    const auto simulation = make_simulation(bare);
    const double processor_begin = processor_seconds();
    const auto begin = Clock::now();
    const Outcome outcome = run(*simulation, steps, {}, pulse);
    wall.push_back(std::chrono::duration<double>(Clock::now() - begin).count());
    processor.push_back(processor_seconds() - processor_begin);
    sum += wall.back();
    if (outcome != Outcome::done) return {outcome, 0, 0};
  }
  return {Outcome::done, median(wall), median(processor)};
}

std::string reason_of(const Simulation& simulation, Outcome outcome) {
  Frame frame;
  simulation.look(frame);
  const std::string why = outcome == Outcome::not_converged ? simulation.failure() : std::string(message(outcome));
  return fmt::format("step {}, from t = {}: {}", frame.step + 1, shortest(frame.time), why);
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

ReferenceSolution reference_solution(const ComparisonRequest& asked, const std::function<bool()>& pulse) {
  const ProblemEntry& problem = find_problem(asked.request.problem, asked.request.variant);
  if (const auto exact = closed_form(asked, problem)) return *exact;
  const Frame start = start_of(asked, problem);
  const auto map =
      problem.step_map(complete(problem.info, asked.request.parameters), asked.methods.at(0), start.q.size());
  if (!map) throw Error("there is no reference for " + asked.request.problem);
  const State<double> z = joined(start);
  const State<Long> from(z.begin(), z.end());
  constexpr int coarse = 45;  // pieces; no step of the one is a step of the other
  constexpr int fine = 64;
  const auto first = pieces(*map, from, asked.t_end, fine, pulse);
  const auto second = first ? pieces(*map, from, asked.t_end, coarse, pulse) : std::nullopt;
  ReferenceSolution found{"extrapolation", "", {}, 0};
  if (!second) return found;  // stopped
  Long most = 0;
  for (std::size_t i = 0; i < z.size(); ++i) {
    if (!std::isfinite((*first)[i]) || !std::isfinite((*second)[i])) {
      throw Error("there is no reference: the motion cannot be followed to t = " + shortest(asked.t_end));
    }
    found.end.push_back(static_cast<double>((*first)[i]));
    most = std::max(most, std::abs((*first)[i] - (*second)[i]));
  }
  found.uncertainty = static_cast<double>(most) + epsilon / 2 * size_of(found.end);
  found.description = fmt::format(
      "modified midpoint rule, extrapolated, in long double with {} digits; two ways of taking its steps "
      "differ by {:.1e}",
      std::numeric_limits<Long>::digits10, static_cast<double>(most));
  return found;
}

Comparison compare(const ComparisonRequest& asked, const std::function<bool(std::size_t)>& progress) {
  const ProblemEntry& problem = find_problem(asked.request.problem, asked.request.variant);
  Comparison found{asked.request.problem, asked.request.arithmetic, asked.t_end, {}, {}, false};
  const auto go_on = [&] {
    found.stopped = found.stopped || (progress && !progress(found.points.size()));
    return !found.stopped;
  };
  const auto pulse = [&](std::int64_t) { return go_on(); };
  if (!go_on()) return found;
  found.reference = reference_solution(asked, go_on);
  for (const MethodSpec& method : asked.methods) {
    for (std::size_t k = 0; k < asked.steps.size(); ++k) {
      if (!go_on()) return found;
      Request request = asked.request;
      request.method = method;
      request.watch = true;
      ComparisonPoint point;
      const double tolerance = usual_tolerance(k, asked.steps.size());
      point.steps = asked.steps[k];
      if (set_tolerance(request.method, tolerance)) {
        point.tolerance = tolerance;
        point.steps = adaptive_steps;
      }
      point.dt = asked.t_end / static_cast<double>(point.steps);
      request.dt = shortest(point.dt);
      const MethodInfo info = describe(request.method);
      point.method = describe(method).name;  // as requested: the tolerance varies like a step
      point.order = info.order;
      point.explicit_step = info.explicit_step;

      const auto simulation = make_simulation(request);
      point.outcome = run(*simulation, point.steps, {}, pulse);
      if (point.outcome == Outcome::stopped) return found;
      const Effort effort = simulation->effort();
      point.force = effort.force;
      point.gradient = effort.gradient;
      point.hessian = effort.hessian;
      point.linear_solves = effort.linear_solves;
      if (!point.done()) {
        point.failure = reason_of(*simulation, point.outcome);
        found.points.push_back(point);
        continue;
      }
      Frame end;
      simulation->look(end);
      point.error = largest_difference(problem.info, joined(end), found.reference.end);
      const Excursion energy = simulation->energy();
      const double scale = simulation->energy_scale() > 0 ? simulation->energy_scale() : 1;
      point.max_energy_error = energy.max_error / scale;
      point.end_energy_error = std::abs(energy.final - energy.initial) / scale;
      const Timing timing = timed(request, point.steps, pulse);
      if (timing.outcome == Outcome::stopped) return found;
      point.wall_seconds = timing.wall;
      // Time that other programs take from the processor is not the method's; a clock of the processor, though, is
      // slow to read.
      point.seconds = std::min(timing.wall, timing.processor);
      found.points.push_back(point);
    }
  }
  return found;
}

namespace {
/// log10(work) at which a method first reaches log10(error) = level, by the segments between its points.
std::optional<double> work_for(const std::vector<const ComparisonPoint*>& points, double level, bool by_time,
                               double floor) {
  std::vector<std::pair<double, double>> curve;  // work, error
  for (const ComparisonPoint* p : points) {
    const double work = by_time ? p->seconds : p->evaluations();
    if (work > 0 && std::isfinite(p->error)) {
      curve.emplace_back(std::log10(work), std::log10(std::max(p->error, floor)));
    }
  }
  std::sort(curve.begin(), curve.end());
  for (std::size_t i = 0; i + 1 < curve.size(); ++i) {
    const auto [w0, e0] = curve[i];
    const auto [w1, e1] = curve[i + 1];
    if (e0 >= level && e1 <= level) return e0 == e1 ? w0 : w0 + (w1 - w0) * (e0 - level) / (e0 - e1);
  }
  return std::nullopt;
}
}  // namespace

std::vector<ComparisonWinner> winners(const Comparison& comparison) {
  const double floor = std::max(comparison.reference.uncertainty, 1e-300);
  std::vector<std::pair<std::string, std::vector<const ComparisonPoint*>>> methods;
  int highest = -400;
  int lowest = 400;
  for (const ComparisonPoint& p : comparison.points) {
    if (methods.empty() || methods.back().first != p.method) methods.push_back({p.method, {}});
    if (!p.done() || !std::isfinite(p.error)) continue;
    methods.back().second.push_back(&p);
    highest = std::max(highest, static_cast<int>(std::floor(std::log10(std::max(p.error, floor)))));
    // An error that is not well above the uncertainty of the reference is none.
    lowest = std::min(lowest, static_cast<int>(std::ceil(std::log10(std::max(p.error, 4 * floor)))));
  }
  std::vector<ComparisonWinner> all;
  for (const bool by_time : {false, true}) {
    for (int level = highest; level >= lowest; --level) {
      std::vector<std::pair<double, std::string>> ranking;
      for (const auto& [name, points] : methods) {
        if (!by_time && !find_method(parse_method(name).name).family->counts_forces) continue;
        if (const auto work = work_for(points, level, by_time, floor)) ranking.emplace_back(*work, name);
      }
      if (ranking.empty()) continue;
      std::sort(ranking.begin(), ranking.end());
      ComparisonWinner w{std::pow(10.0, level),
                         by_time ? "seconds" : "evaluations",
                         ranking[0].second,
                         std::pow(10.0, ranking[0].first),
                         "",
                         0};
      if (ranking.size() > 1) {
        w.second = ranking[1].second;
        w.second_work = std::pow(10.0, ranking[1].first);
      }
      all.push_back(w);
    }
  }
  return all;
}

}  // namespace hamflow
