// The contenders of hamflow: the simulation by type, and by name as the command makes it.
#pragma once

#include <algorithm>
#include <chrono>
#include <limits>
#include <stdexcept>

#include "contender.hpp"
#include "hamflow/problems/potentials/kepler.hpp"
#include "hamflow/run/catalog.hpp"
#include "hamflow/run/simulation_of.hpp"

namespace bench {

/// Measures the nanoseconds that f takes.
template <class F>
double timed(F&& f) {
  const auto begin = std::chrono::steady_clock::now();
  f();
  return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - begin).count();
}

/// An upper bound for the distance of two runs on this orbit that round differently. An error delta of the state
/// changes the energy -1/4 by at most (|k/q^2| + |p/mass|) delta < 2 delta, so the mean motion 1/4 by a relative 1.5 x
/// 2 delta/(1/4) = 12 delta. The speed is below 1, so this moves the state by at most 12 t delta after a time t. The
/// error itself grows at most by a factor 10 along one revolution. Each step adds an error of `roundings` epsilon.
inline double parting(double h, int roundings, std::int64_t steps) {
  const auto count = static_cast<double>(steps);
  return roundings * std::numeric_limits<double>::epsilon() * (10 * count + 6 * h * count * count);
}

/// Times one block. The call is virtual for `hamflow::Simulation`, and direct for a typed simulation.
template <class S>
Run run_block(S& simulation, std::int64_t steps) {
  Run run;
  hamflow::Outcome outcome{};
  run.nanoseconds = timed([&] { outcome = simulation.advance(steps); });
  if (outcome != hamflow::Outcome::done) throw std::runtime_error(std::string(hamflow::name(outcome)));
  hamflow::Frame frame;
  simulation.look(frame);
  run.end = {{frame.q[0], frame.q[1]}, {frame.p[0], frame.p[1]}};
  run.forces = static_cast<double>(frame.effort.force);
  return run;
}

/// Returns the problem of a task.
inline hamflow::CentralForce<double, hamflow::Kepler> kepler(const Task& task) {
  return {task.mass, hamflow::Kepler<double>(task.k)};
}

template <class Recipe>
Run run_typed(const Task& task, const Recipe& recipe, std::int64_t steps) {
  auto simulation = hamflow::simulate<false>(kepler(task), recipe, task.start.q, task.start.p, task.h);
  return run_block(simulation, steps);
}

/// Times steps of a request. The first steps, in which the step is recorded and compiled, are not timed.
/// @param until_recorded the number of these steps
inline Run run_recorded(const hamflow::Request& request, std::int64_t steps, std::int64_t until_recorded = 300) {
  const auto simulation = hamflow::make_simulation(request);
  const std::int64_t before = std::min(steps / 2, until_recorded);
  if (simulation->advance(before) != hamflow::Outcome::done) throw std::runtime_error("no steps");
  Run run = run_block(*simulation, steps - before);
  run.nanoseconds *= static_cast<double>(steps) / static_cast<double>(steps - before);
  return run;
}

/// Times a method by name.   @param request the problem and the arithmetic
inline Run run_request(hamflow::Request request, const Task& task, const std::string& method, bool watch,
                       std::int64_t steps) {
  for (const double x : task.start.q) request.start.q.push_back(hamflow::shortest(x));
  for (const double x : task.start.p) request.start.p.push_back(hamflow::shortest(x));
  request.method = hamflow::parse_method(method);
  request.dt = task.h_text;
  request.watch = watch;
  return run_recorded(request, steps);
}

inline hamflow::Request kepler_request(const Task& task, const std::string& arithmetic) {
  hamflow::Request request;
  request.problem = "central-force";
  request.variant = {{"potential", "kepler"}};
  request.parameters = {{"mass", hamflow::shortest(task.mass)}, {"k", hamflow::shortest(task.k)}};
  request.arithmetic = arithmetic;
  return request;
}

inline Run run_named(const Task& task, const std::string& method, bool watch, std::int64_t steps,
                     const std::string& arithmetic = "double") {
  return run_request(kepler_request(task, arithmetic), task, method, watch, steps);
}

template <class Recipe>
void add_typed(Workload& workload, const Task& task, const Recipe& recipe, double goal, bool same_bits) {
  workload.contenders.push_back(
      {"typed", [=](std::int64_t steps) { return run_typed(task, recipe, steps); }, "hand", goal, same_bits});
}

/// Adds the contenders "typed", "named" and "watched".
template <class Recipe>
void add_library_contenders(Workload& workload, const Task& task, const Recipe& recipe, double typed_goal,
                            bool same_bits) {
  const std::string method = workload.method;
  add_typed(workload, task, recipe, typed_goal, same_bits);
  workload.contenders.push_back(
      {"named", [=](std::int64_t steps) { return run_named(task, method, false, steps); }, "typed", 1.1, same_bits});
  workload.contenders.push_back(
      {"watched", [=](std::int64_t steps) { return run_named(task, method, true, steps); }, "named", 0, same_bits});
}

}  // namespace bench
