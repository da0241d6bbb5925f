// The cost of compensated summation: each contender is compared with the same in plain double. A kick and a drift each
// add one addition to the chain from force to force: increment + low, before it is added to high. The other five
// additions of the two-sum, which find the error, are not on the chain.
#include "composition_loops.hpp"
#include "hamflow/methods/compositions/kahan_li8.hpp"
#include "hamflow/methods/compositions/stv4.hpp"
#include "hamflow/methods/splitting.hpp"

namespace bench {

namespace {

/// A number high + low.   [Knuth1997, 4.2.2]
struct Sum {
  double high, low = 0;
  void add(double r) {
    const double increment = r + low;
    const double sum = high + increment;
    const double part = sum - high;
    low = (high - (sum - part)) + (increment - part);
    high = sum;
  }
};

template <const auto& weights>
[[gnu::noinline]] void hand_compensated(Orbit& z, double mass, double k, double h, std::int64_t steps) {
  const Factors<weights> factors(1 / mass, k, h);
  Sum x{z.q[0]}, y{z.q[1]}, px{z.p[0]}, py{z.p[1]};
  double kick_x = 0, kick_y = 0;
  const auto find_kick = [&](double strength) {
    const double u = x.high * x.high + y.high * y.high;
    const double slope = strength / (u * std::sqrt(u));
    kick_x = -(slope * x.high);
    kick_y = -(slope * y.high);
  };
  find_kick(factors.c[factors.stages - 1]);
  for (std::int64_t i = 0; i < steps; ++i) {
    px.add(kick_x);
    py.add(kick_y);
#pragma GCC unroll 20
    for (std::size_t j = 0; j < factors.stages; ++j) {
      x.add(factors.d[j] * px.high);
      y.add(factors.d[j] * py.high);
      find_kick(factors.c[j]);
      px.add(kick_x);
      py.add(kick_y);
    }
  }
  z = {{x.high, y.high}, {px.high, py.high}};
}

using Arithmetic = hamflow::Compensated<double>;

template <class P, class Recipe>
Run run_compensated(const Task& task, const P& problem, const Recipe& recipe, std::int64_t steps) {
  auto simulation = hamflow::simulate<false>(problem, recipe, task.start.q, task.start.p, task.h, Arithmetic{});
  return run_block(simulation, steps);
}

/// The bound of plain arithmetic holds: each kick or drift has one more addition, to low, and one rounding less.
template <const auto& weights, class Recipe>
void add(Workload& w, const Task& task, const Recipe& recipe) {
  const auto put = [&](const std::string& plain, double goal, auto run, const std::string& bits_of) {
    w.contenders.push_back({plain + ", compensated", run, plain, goal, false, 1, bits_of});
  };
  const std::string hand = "hand, compensated";
  const auto named = [task, method = w.method](bool watch) {
    return [=](std::int64_t steps) { return run_named(task, method, watch, steps, "compensated"); };
  };
  put("hand", 0,
      [=](std::int64_t steps) {
        return run_hand(task, hand_compensated<weights>, static_cast<int>(weights.size()), steps);
      },
      {});
  put(
      "typed", 1.15, [=](std::int64_t steps) { return run_compensated(task, kepler(task), recipe, steps); }, hand);
  put("named", 1.15, named(false), hand);
  put("watched", 0, named(true), hand);
}

}  // namespace

void add_compensated_contenders(Workload& workload, const Task& task) {
  using namespace hamflow;
  if (workload.method == "stv4") {
    add<stv4_weights>(workload, task, Composition<compositions::stv4>{});
  } else if (workload.method == "kahan-li8") {
    add<kahan_li8_weights>(workload, task, Composition<compositions::kahan_li8>{});
  }
}

}  // namespace bench
