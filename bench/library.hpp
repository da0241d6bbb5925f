// hamflow's contenders: the typed simulation, and the same by name as the command makes it.
#pragma once

#include <chrono>
#include <stdexcept>

#include "contender.hpp"
#include "hamflow/problems/potentials/kepler.hpp"
#include "hamflow/run/catalog.hpp"
#include "hamflow/run/simulation_of.hpp"

namespace bench {

/// Nanoseconds that f takes.
template <class F>
double timed(F&& f) {
  const auto begin = std::chrono::steady_clock::now();
  f();
  return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - begin).count();
}

/// Times one block; the call is virtual for `hamflow::Simulation`, direct for the typed one.
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

template <class Recipe>
Run run_typed(const Task& task, const Recipe& recipe, std::int64_t steps) {
  const hamflow::CentralForce<double, hamflow::Kepler> problem(task.mass, hamflow::Kepler<double>(task.k));
  auto simulation = hamflow::simulate<false>(problem, recipe, task.start.q, task.start.p, task.h);
  return run_block(simulation, steps);
}

inline Run run_named(const Task& task, const std::string& method, bool watch, std::int64_t steps) {
  hamflow::Request request;
  request.problem = "central-force";
  request.variant = {{"potential", "kepler"}};
  request.parameters = {{"mass", "2"}, {"k", "1"}};
  request.start.kind = "ellipse";
  request.start.orbit = {{"r_per", "1"}, {"r_aph", "3"}};
  request.method = hamflow::parse_method(method);
  request.dt = task.h_text;
  request.watch = watch;
  const auto simulation = hamflow::make_simulation(request);
  return run_block(*simulation, steps);
}

/// Appends (b), (c) and (d) of bench/README.md.
template <class Recipe>
void add_library_contenders(Workload& workload, const Task& task, const Recipe& recipe, double typed_goal,
                            bool same_bits) {
  const std::string method = workload.method;
  workload.contenders.push_back(
      {"typed", [=](std::int64_t steps) { return run_typed(task, recipe, steps); }, "hand", typed_goal, same_bits});
  workload.contenders.push_back(
      {"named", [=](std::int64_t steps) { return run_named(task, method, false, steps); }, "typed", 1.1, same_bits});
  workload.contenders.push_back(
      {"watched", [=](std::int64_t steps) { return run_named(task, method, true, steps); }, "named", 0, same_bits});
}

}  // namespace bench
