// Boost.Odeint as its documentation shows it: states are std::array, and systems are function objects that the compiler
// can inline.
#include "other_libraries.hpp"

#if HAMFLOW_BENCH_ODEINT

#include <array>
#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>
#include <boost/numeric/odeint/stepper/symplectic_euler.hpp>
#include <boost/numeric/odeint/stepper/symplectic_rkn_sb3a_m4_mclachlan.hpp>
#include <boost/numeric/odeint/stepper/symplectic_rkn_sb3a_mclachlan.hpp>
#include <boost/numeric/odeint/stepper/velocity_verlet.hpp>
#include <boost/version.hpp>
#include <cmath>
#include <utility>

#include "library.hpp"

namespace bench {

namespace {

namespace odeint = boost::numeric::odeint;
using Two = std::array<double, 2>;
using Four = std::array<double, 4>;

inline double slope_at(double x, double y, double k) {
  const double u = x * x + y * y;
  return k / (u * std::sqrt(u));
}

/// Steppers with separate q and p, for H = T + V.
template <class Stepper>
[[gnu::noinline]] void march_separable(Orbit& z, double mass, double k, double h, std::int64_t steps) {
  const double inverse_mass = 1 / mass;
  const auto system = std::make_pair(
      [inverse_mass](const Two& p, Two& dq) {
        dq = {p[0] * inverse_mass, p[1] * inverse_mass};
      },
      [k](const Two& q, Two& dp) {
        const double slope = slope_at(q[0], q[1], k);
        dp = {-slope * q[0], -slope * q[1]};
      });
  Stepper stepper;
  std::pair<Two, Two> state{{z.q[0], z.q[1]}, {z.p[0], z.p[1]}};
  for (std::int64_t i = 0; i < steps; ++i) stepper.do_step(system, state, 0.0, h);
  z = {{state.first[0], state.first[1]}, {state.second[0], state.second[1]}};
}

/// The stepper for q'' = a(q). It uses velocities instead of momenta, so `strength` contains the mass.
[[gnu::noinline]] void march_verlet(Orbit& z, double mass, double k, double h, std::int64_t steps) {
  const double strength = k / mass;
  const auto acceleration = [strength](const Two& q, const Two&, Two& a, double) {
    const double slope = slope_at(q[0], q[1], strength);
    a = {-slope * q[0], -slope * q[1]};
  };
  odeint::velocity_verlet<Two> stepper;
  std::pair<Two, Two> state{{z.q[0], z.q[1]}, {z.p[0] / mass, z.p[1] / mass}};
  for (std::int64_t i = 0; i < steps; ++i) stepper.do_step(acceleration, state, 0.0, h);
  z = {{state.first[0], state.first[1]}, {mass * state.second[0], mass * state.second[1]}};
}

[[gnu::noinline]] void march_rk4(Orbit& z, double mass, double k, double h, std::int64_t steps) {
  const double inverse_mass = 1 / mass;
  const auto system = [inverse_mass, k](const Four& s, Four& ds, double) {
    const double slope = slope_at(s[0], s[1], k);
    ds = {s[2] * inverse_mass, s[3] * inverse_mass, -slope * s[0], -slope * s[1]};
  };
  odeint::runge_kutta4<Four> stepper;
  Four state{z.q[0], z.q[1], z.p[0], z.p[1]};
  for (std::int64_t i = 0; i < steps; ++i) stepper.do_step(system, state, 0.0, h);
  z = {{state[0], state[1]}, {state[2], state[3]}};
}

using Loop = void (*)(Orbit&, double mass, double k, double h, std::int64_t steps);

Runner runner(Loop loop, int forces) {
  return [=](const Task& task, std::int64_t steps) {
    Run run;
    run.end = task.start;
    run.nanoseconds = timed([&] { loop(run.end, task.mass, task.k, task.h, steps); });
    run.forces = static_cast<double>(forces) * static_cast<double>(steps);
    return run;
  };
}

}  // namespace

std::vector<OtherLibraryMethod> odeint_peers() {
  using Euler = odeint::symplectic_euler<Two>;
  using M4 = odeint::symplectic_rkn_sb3a_m4_mclachlan<Two>;
  using Sb3a = odeint::symplectic_rkn_sb3a_mclachlan<Two>;
  // Roundings differ, and coefficients may differ in the last bit, so the bound is doubled. Forces are counted as
  // Odeint evaluates them.
  return {{"odeint", "symplectic_euler", "euler-a", 1, 2, runner(march_separable<Euler>, 1)},
          {"odeint", "velocity_verlet", "verlet", 2, 2, runner(march_verlet, 1)},
          {"odeint", "sb3a_m4_mclachlan", "sb3a_m4", 4, 2, runner(march_separable<M4>, 5)},
          {"odeint", "sb3a_mclachlan", "sb3a", 4, 2, runner(march_separable<Sb3a>, 6)},
          {"odeint", "runge_kutta4", "rk4", 4, 2, runner(march_rk4, 4)}};
}

std::string odeint_version() { return "Boost.Odeint " BOOST_LIB_VERSION; }

}  // namespace bench

#else

namespace bench {
std::vector<OtherLibraryMethod> odeint_peers() { return {}; }
std::string odeint_version() { return "without Boost.Odeint"; }
}  // namespace bench

#endif
