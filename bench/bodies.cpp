// N bodies in space: a heavy one, and light ones on circles about it. The typed method loops over bodies, whose number
// is known at run time; by name, the step is recorded. Six bodies are like the outer solar system, the step of ten
// bodies fits into the first-level instruction cache, and thirty are near the longest step that is recorded.
#include "hamflow/methods/compositions/stv4.hpp"
#include "hamflow/methods/compositions/verlet.hpp"
#include "hamflow/methods/splitting.hpp"
#include "hamflow/methods/wisdom_holman_step.hpp"
#include "hamflow/problems/of_any_size/n_body.hpp"
#include "library.hpp"

namespace bench {

namespace {

struct Bodies {
  std::vector<double> masses, q, p;
};

Bodies ring_of(std::size_t count) {
  Bodies all;
  for (std::size_t i = 0; i < count; ++i) {
    const auto k = static_cast<double>(i);
    const double mass = i == 0 ? 1 : 1e-4, radius = i == 0 ? 0 : 1 + 0.5 * k,
                 speed = i == 0 ? 0 : 1 / std::sqrt(radius);
    all.masses.push_back(mass);
    for (const double x : {radius * std::cos(k), radius * std::sin(k), 0.01 * k}) all.q.push_back(x);
    for (const double v : {-speed * std::sin(k), speed * std::cos(k), 0.0}) all.p.push_back(mass * v);
  }
  return all;
}

std::string listed(const std::vector<double>& numbers) {
  std::string text;
  for (const double x : numbers) text += (text.empty() ? "[" : ", ") + hamflow::shortest(x);
  return text + "]";
}

template <class Recipe>
Workload workload(std::size_t count, const std::string& method, const std::string& h_text, const Recipe& recipe) {
  const double h = std::stod(h_text);
  const Bodies bodies = ring_of(count);
  hamflow::Request request;
  request.problem = "n-body";
  request.parameters = {{"masses", listed(bodies.masses)}};
  for (const double x : bodies.q) request.start.q.push_back(hamflow::shortest(x));
  for (const double x : bodies.p) request.start.p.push_back(hamflow::shortest(x));
  request.method = hamflow::parse_method(method);
  request.dt = h_text;
  const auto typed = [=]<bool watch>(std::int64_t steps) {
    const hamflow::NBody<double> problem(
        hamflow::Parameters<double>(hamflow::complete(hamflow::find_problem("n-body", {})->info, request.parameters)),
        bodies.q.size());
    auto q = hamflow::zeros<double, hamflow::dynamic>(bodies.q.size()), p = q;
    std::copy(bodies.q.begin(), bodies.q.end(), q.begin());
    std::copy(bodies.p.begin(), bodies.p.end(), p.begin());
    auto simulation = hamflow::simulate<watch>(problem, recipe, q, p, h);
    return run_block(simulation, steps);
  };
  const auto named = [=](bool watch) {
    return [=](std::int64_t steps) {
      hamflow::Request one = request;
      one.watch = watch;
      return run_recorded(one, steps);
    };
  };
  Workload w{std::to_string(count) + " bodies, " + method, h_text, {}, {}, {}};
  // The circles of the light bodies are far apart, so they are almost Kepler orbits, for which the bound holds.
  w.bound = [=](std::int64_t steps) { return parting(h, 4 * static_cast<int>(count), steps); };
  w.contenders.push_back({"typed", [=](std::int64_t steps) { return typed.template operator()<false>(steps); }, {}});
  w.contenders.push_back(
      {"typed, watched", [=](std::int64_t steps) { return typed.template operator()<true>(steps); }, {}});
  w.contenders.push_back({"named", named(false), "typed", count <= 10 ? 0.7 : 1});
  w.contenders.push_back({"watched", named(true), "typed, watched", count <= 6 ? 0.55 : count <= 10 ? 0.7 : 1});
  return w;
}

}  // namespace

std::vector<Workload> body_workloads() {
  const hamflow::Composition<hamflow::compositions::verlet> verlet;
  const hamflow::Composition<hamflow::compositions::stv4> stv4;
  return {workload(6, "verlet", "0.01", verlet),
          workload(10, "verlet", "0.01", verlet),
          workload(10, "stv4", "0.01", stv4),
          workload(30, "verlet", "0.01", verlet),
          workload(6, "wisdom-holman", "0.1", hamflow::WisdomHolman{}),
          workload(6, "wisdom-holman(kernel=lazy)", "0.1",
                   hamflow::WisdomHolman{{.kernel = hamflow::WisdomHolmanKernel::lazy}})};
}

}  // namespace bench
