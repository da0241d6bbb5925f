#include "equal_error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "hamflow/methods/averages.hpp"
#include "hamflow/methods/cg.hpp"
#include "hamflow/methods/compositions/kahan_li8.hpp"
#include "hamflow/methods/compositions/stv4.hpp"
#include "hamflow/methods/compositions/suzuki4.hpp"
#include "hamflow/methods/compositions/verlet.hpp"
#include "hamflow/methods/compositions/yoshida6.hpp"
#include "hamflow/methods/dop853.hpp"
#include "hamflow/methods/splitting.hpp"
#include "hamflow/methods/splittings/rkn8_s19.hpp"
#include "hamflow/methods/tableaus/rk4.hpp"
#include "hamflow/problems/support/fast_kernel.hpp"
#include "library.hpp"
#include "mclachlan.hpp"
#include "peers.hpp"

namespace bench {

namespace {

struct Racer {
  std::string name;
  int order;
  Runner run;
};

template <class Recipe>
Racer typed(const std::string& name, int order, const Recipe& recipe) {
  return {name, order, [=](const Task& task, std::int64_t steps) { return run_typed(task, recipe, steps); }};
}
template <class Recipe>
Racer typed_fast(const std::string& name, int order, const Recipe& recipe) {
  return {name, order, [=](const Task& task, std::int64_t steps) { return run_typed_fast(task, recipe, steps); }};
}

std::vector<Racer> racers() {
  using namespace hamflow;
  std::vector<Racer> all{typed("stv4", 4, Composition<compositions::stv4>{}),
                         typed("suzuki4", 4, Composition<compositions::suzuki4>{}),
                         typed("yoshida6", 6, Composition<compositions::yoshida6>{}),
                         typed("kahan-li8", 8, Composition<compositions::kahan_li8>{}),
                         typed("sb3a_m4", 4, SplittingBy<sb3a_m4>{}),
                         typed("rk4", 4, RungeKuttaBy<tableaus::rk4>{}),
                         typed("verlet", 2, Composition<compositions::verlet>{}),
                         typed("rkn8-s19", 8, SplittingBy<splittings::rkn8_s19>{}),
                         typed("dop853", 8, Dop853{{.fixed = true}}),
                         typed("cg(1,5)", 2, Cg{{.quadrature = 5}}),
                         typed("cg(2,4)", 4, CgOfDegree{{.degree = 2, .quadrature = 4}}),
                         typed("cg(3,6)", 6, CgOfDegree{{.degree = 3, .quadrature = 6}})};
  for (const int stages : {4, 8}) {
    const std::string name = "gauss(" + std::to_string(stages) + ")";
    all.push_back(typed(name, 2 * stages, Gauss{{.stages = stages}}));
    all.push_back(
        typed(name + ", fixed-point", 2 * stages,
              Gauss{{.stages = stages, .max_iterations = linear_iterations, .iteration = Iteration::fixed_point}}));
  }
  if (fast_kernel_available()) {
    all.push_back(typed_fast("stv4, fast", 4, Composition<compositions::stv4>{}));
    all.push_back(typed_fast("suzuki4, fast", 4, Composition<compositions::suzuki4>{}));
    all.push_back(typed_fast("yoshida6, fast", 6, Composition<compositions::yoshida6>{}));
    all.push_back(typed_fast("kahan-li8, fast", 8, Composition<compositions::kahan_li8>{}));
  }
  for (const auto& peers : {odeint_peers(), gsl_peers()}) {
    // At these accuracies a first-order method takes 10^8 steps and more.
    for (const Peer& peer : peers) {
      if (peer.order > 1) all.push_back({peer.library + " " + peer.stepper, peer.order, peer.run});
    }
  }
  return all;
}

// A period of so many microseconds is not timed in every round.
constexpr double long_period = 2e5;
constexpr int few_rounds = 3;

constexpr double period = 2 * std::numbers::pi;  // a = k = mass = 1

Task task_of(std::int64_t steps) { return unit_task(period / static_cast<double>(steps)); }

double error_after_period(const Racer& racer, std::int64_t steps) {
  const Task task = task_of(steps);
  const Orbit end = racer.run(task, steps).end;
  return std::hypot(end.q[0] - task.start.q[0], end.q[1] - task.start.q[1]);
}

/// The fewest steps, to a hundredth, even in number: the error goes as steps^-order once it is small. 0: rounding is
/// more than the target.
Placed place(const Racer& racer, double target) {
  Placed placed{racer.name, 0, 0, {}, {}};
  std::int64_t steps = 400;
  for (int attempt = 0; attempt < 40; ++attempt) {
    const double error = error_after_period(racer, steps);
    const bool enough = error <= target;
    if (enough && (placed.steps == 0 || steps < placed.steps)) {
      placed.steps = steps;
      placed.error = error;
    }
    const double factor = std::clamp(std::pow(error / target, 1.0 / racer.order), 0.25, 4.0);
    if (enough && factor > 0.99) break;
    // Where the law is not quite met, the wanted number is approached from above.
    const double next = static_cast<double>(steps) * (enough ? factor : std::max(factor * 1.002, 1.005));
    const std::int64_t even = 2 * static_cast<std::int64_t>(std::ceil(next / 2));
    if (even == steps || (enough && even >= placed.steps)) break;
    if (!enough && placed.steps != 0 && even >= placed.steps) break;
    steps = even;
  }
  return placed;
}

}  // namespace

std::vector<Race> race(const Plan& plan) {
  const std::vector<Racer> entered = racers();
  std::vector<Race> races;
  for (const double target : {1e-6, 1e-9, 1e-12}) {
    Race race{target, {}};
    std::vector<Racer> all;
    for (const Racer& racer : entered) {
      if (racer.order < 4 && target < 1e-9) continue;  // 10^8 steps
      const Placed placed = place(racer, target);
      if (placed.steps == 0) continue;
      race.placed.push_back(placed);
      all.push_back(racer);
    }
    // Whole periods: Newton's iterations are not spread evenly over the orbit.
    std::vector<std::vector<double>> times(all.size());
    std::vector<std::int64_t> periods(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      const std::int64_t steps = race.placed[i].steps;
      const double once = all[i].run(task_of(steps), steps).nanoseconds;
      periods[i] = 1 + static_cast<std::int64_t>(plan.block_nanoseconds / 3 / once);
    }
    for (int round = 0; round < plan.rounds; ++round) {
      for (std::size_t i = 0; i < all.size(); ++i) {
        const std::size_t at = (i + static_cast<std::size_t>(round)) % all.size();
        if (round >= few_rounds && times[at].front() > long_period) continue;
        const Task task = task_of(race.placed[at].steps);
        const Run run = all[at].run(task, race.placed[at].steps * periods[at]);
        times[at].push_back(run.nanoseconds / 1000 / static_cast<double>(periods[at]));
      }
    }
    for (std::size_t i = 0; i < all.size(); ++i) {
      race.placed[i].us_per_period = spread_of(times[i]);
      std::vector<double> ratios(times[i].size());
      for (std::size_t r = 0; r < ratios.size(); ++r) ratios[r] = times[i][r] / times[0][r];
      race.placed[i].ratio = spread_of(ratios);
    }
    races.push_back(race);
  }
  return races;
}

}  // namespace bench
