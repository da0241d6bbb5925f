// Kahan's and Li's composition of order 8 with 17 stages, on the Kepler orbit and in the Henon-Heiles potential. There
// a force is so cheap that the cost of everything else is visible.
#include "composition_loops.hpp"
#include "hamflow/methods/compositions/kahan_li8.hpp"
#include "hamflow/methods/splitting.hpp"
#include "hamflow/problems/henon_heiles.hpp"

namespace bench {

namespace {

/// The force of the Henon-Heiles potential; `strength` is the factor of the kick, lambda = k.
struct Well {
  double lambda, twice;
  explicit Well(double k) : lambda(k), twice(2 * k) {}
  void find_kick(Plane& s, double strength) const {
    s.kick_x = strength * (-s.x - twice * s.x * s.y);
    s.kick_y = strength * (-s.y - lambda * (s.x * s.x - s.y * s.y));
  }
  static void kick(Plane& s) {
    s.px += s.kick_x;
    s.py += s.kick_y;
  }
};

/// The operations of hamflow in the same order.
template <const auto& weights>
[[gnu::noinline]] void hand_well(Orbit& z, double mass, double k, double h, std::int64_t steps) {
  const Factors<weights> factors(1 / mass, 1, h);
  const Well well(k);
  Plane s = load(z);
  well.find_kick(s, factors.c[factors.stages - 1]);
  for (std::int64_t i = 0; i < steps; ++i) {
    Well::kick(s);
#pragma GCC unroll 20
    for (std::size_t j = 0; j < factors.stages; ++j) {
      drift(s, factors.d[j]);
      well.find_kick(s, factors.c[j]);
      Well::kick(s);
    }
  }
  save(s, z);
}

/// Joins the kicks of neighbouring steps. The loop over the stages is as in a textbook.
template <const auto& weights>
[[gnu::noinline]] void hand_well_folded(Orbit& z, double mass, double k, double h, std::int64_t steps) {
  Factors<weights> factors(1 / mass, 1, h);
  const Well well(k);
  Plane s = load(z);
  const double half = factors.c[factors.stages - 1];
  factors.c[factors.stages - 1] = 2 * half;
  well.find_kick(s, half);
  Well::kick(s);
  for (std::int64_t i = 0; i < steps; ++i) {
    for (std::size_t j = 0; j < factors.stages; ++j) {
      drift(s, factors.d[j]);
      well.find_kick(s, factors.c[j]);
      Well::kick(s);
    }
  }
  well.find_kick(s, -half);
  Well::kick(s);
  save(s, z);
}

/// A regular motion at H = 0.01, a sixteenth of the energy of the saddle.
Task well_task(const Task& like) {
  Task task = like;
  task.mass = task.k = 1;
  task.start = {{0.1, 0}, {0, 0.1}};
  return task;
}

template <class Recipe>
Workload well_workload(const Task& task, int forces, const Recipe& recipe) {
  const std::string method = "kahan-li8";
  // The longest chain: q2 -> q2^2 -> q1^2 - q2^2 -> times lambda -> F2 -> increment of p2 -> p2 -> increment of q2 ->
  // q2.
  Workload w = begin(task, "henon-heiles", forces, {4 * forces + 1, 4 * forces, 0, 0}, hand_well<kahan_li8_weights>);
  // The bound of the Kepler orbit holds here, too: the motion is regular, an error changes actions by at most 0.2 times
  // its size, and frequencies, which are 1 + O(E) with coefficients below 1, by less.
  w.contenders.push_back(
      {"hand, folded",
       [=](std::int64_t steps) { return run_hand(task, hand_well_folded<kahan_li8_weights>, forces, steps); }, "hand",
       0, false});
  w.contenders.push_back({"typed",
                          [=](std::int64_t steps) {
                            const hamflow::HenonHeiles<double> problem(task.k);
                            auto simulation =
                                hamflow::simulate<false>(problem, recipe, task.start.q, task.start.p, task.h);
                            return run_block(simulation, steps);
                          },
                          "hand", 1.1});
  const auto by_name = [=](bool watch) {
    return [=](std::int64_t steps) {
      hamflow::Request request;
      request.problem = "henon-heiles";
      request.parameters = {{"lambda", hamflow::shortest(task.k)}};
      return run_request(std::move(request), task, method, watch, steps);
    };
  };
  w.contenders.push_back({"named", by_name(false), "hand", 1.1});
  w.contenders.push_back({"watched", by_name(true), "hand"});
  return w;
}

}  // namespace

std::vector<Workload> order_eight_workloads(const Task& task) {
  const hamflow::Composition<hamflow::compositions::kahan_li8> recipe;
  constexpr int forces = 17;
  Workload w = begin(task, "kahan-li8", forces, splitting_chain(forces), hand_table<kahan_li8_weights>);
  w.contenders.push_back(
      {"hand, folded",
       [=](std::int64_t steps) { return run_hand(task, hand_folded<kahan_li8_weights>, forces, steps); }, "hand", 0,
       false});
  add_library_contenders(w, task, recipe, 1.1, true);
  add_compensated_contenders(w, task);
  add_lane_contenders(w, task);
  return {w, well_workload(well_task(task), forces, recipe)};
}

}  // namespace bench
