// Steps of wisdom-holman and saba: symplectic and symmetric, in the plane and in space; the powers of dt and of the
// masses in their errors; massless bodies.
#include "hamflow/methods/wisdom_holman_step.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/corrected_simulation.hpp"
#include "hamflow/arithmetic/compensated.hpp"
#include "hamflow/arithmetic/plain.hpp"
#include "hamflow/orbits/bodies.hpp"
#include "hamflow/problems/of_any_size/n_body.hpp"

namespace hamflow {
namespace {

struct Chosen {
  WisdomHolmanOptions options;
  MethodInfo info;
};
std::vector<Chosen> all_methods() {
  std::vector<Chosen> all;
  for (const WisdomHolmanOptions& options :
       {WisdomHolmanOptions{}, WisdomHolmanOptions{.coordinates = WisdomHolmanCoordinates::heliocentric},
        WisdomHolmanOptions{.kernel = WisdomHolmanKernel::lazy}, WisdomHolmanOptions{.corrector = 3},
        WisdomHolmanOptions{.corrector = 17}}) {
    all.push_back({options, describe(options)});
  }
  for (std::size_t k = 0; k < kepler_tables().size(); ++k) all.push_back({{.table = k}, describe_saba(k)});
  return all;
}

NBody<double> bodies(const std::vector<double>& masses, std::size_t space, double softening = 0) {
  Parameters<double> parameters;
  parameters.set_list("masses", masses);
  parameters.set("gravitational_constant", 1);
  parameters.set("softening", softening);
  return NBody<double>(parameters, space * masses.size());
}

template <class A>
PhasePoint<A, dynamic> point(const std::vector<double>& q, const std::vector<double>& p) {
  Vector<typename A::Real, dynamic> x(q.size());
  Vector<typename A::Real, dynamic> y(q.size());
  for (std::size_t i = 0; i < q.size(); ++i) {
    x[i] = typename A::Real(q[i]);
    y[i] = typename A::Real(p[i]);
  }
  PhasePoint<A, dynamic> z;
  z.store(x, y);
  return z;
}

TEST(WisdomHolmanStep, IsSymplecticAndSymmetric) {
  using D = Dual<double, 1>;
  using P = NBody<double>;
  for (const double softening : {0.0, 0.5}) {
    for (const std::size_t space : {2u, 3u}) {
      const std::size_t n = 3 * space;
      const P problem = bodies({1, 0.3, 0.2}, space, softening);
      const double given_q[] = {0, 0, 0.1, 1, 0, -0.1, 0, -1.5, 0.05};
      const double given_p[] = {0, -0.1, 0, 0, 0.3, 0.02, 0.16, 0, 0.01};
      std::vector<double> q;
      std::vector<double> p;
      for (std::size_t i = 0; i < 9; ++i) {
        if (i % 3 >= space) continue;
        q.push_back(given_q[i]);
        p.push_back(given_p[i]);
      }
      for (const Chosen& method : all_methods()) {
        std::vector<std::vector<double>> jacobian(2 * n, std::vector<double>(2 * n));
        std::vector<double> end_q(n);
        std::vector<double> end_p(n);
        for (std::size_t c = 0; c < 2 * n; ++c) {
          auto z = point<Plain<D>>(q, p);
          (c < n ? z.q[c] : z.p[c - n]).slope[0] = 1;
          WisdomHolmanStep<P, Plain<D>> stepper(problem, method.options, method.info);
          for (int k = 0; k < 5; ++k) ASSERT_EQ(stepper.step(problem, 0.05, z), Outcome::done);
          for (std::size_t i = 0; i < n; ++i) {
            jacobian[i][c] = z.q[i].slope[0];
            jacobian[n + i][c] = z.p[i].slope[0];
            end_q[i] = z.q[i].value;
            end_p[i] = z.p[i].value;
          }
        }
        double defect = 0;  // of J^T (0 1; -1 0) J
        for (std::size_t a = 0; a < 2 * n; ++a) {
          for (std::size_t b = 0; b < 2 * n; ++b) {
            double sum = b == a + n ? -1 : a == b + n ? 1 : 0;
            for (std::size_t i = 0; i < n; ++i) {
              sum += jacobian[i][a] * jacobian[n + i][b] - jacobian[n + i][a] * jacobian[i][b];
            }
            defect = std::max(defect, std::abs(sum));
          }
        }
        if (method.info.symplectic) {
          EXPECT_LT(defect, 1e-14) << method.info.name;  // sums of up to 9 products of numbers near 1
        } else {
          EXPECT_GT(defect, 1e-12) << method.info.name;
        }
        if (!method.info.symmetric) continue;
        auto back = point<Plain<double>>(end_q, end_p);
        WisdomHolmanStep<P, Plain<double>> stepper(problem, method.options, method.info);
        for (int k = 0; k < 5; ++k) ASSERT_EQ(stepper.step(problem, -0.05, back), Outcome::done);
        for (std::size_t i = 0; i < n; ++i) {
          EXPECT_NEAR(back.q[i], q[i], 1e-15) << method.info.name;
          EXPECT_NEAR(back.p[i], p[i], 1e-15) << method.info.name;
        }
      }
    }
  }
}

/// Two planets, and perhaps a massless body.
struct System {
  std::vector<double> masses;
  std::vector<double> q;
  std::vector<double> p;
};
System system_of(double mass, bool with_dust) {
  const auto on = [](double a, double e, double tilt, double node, double pericentre, double mean) {
    Orbit<double> orbit;
    orbit.a = a;
    orbit.e = e;
    orbit.inclination = tilt;
    orbit.node = node;
    orbit.pericentre = pericentre;
    orbit.mean_anomaly = mean;
    return orbit;
  };
  std::vector<BodyStart<double>> given{{.mass = 1},
                                       {.mass = mass, .orbit = on(1, 0.05, 0.02, 1, 2, 0)},
                                       {.mass = mass / 2, .orbit = on(2.3, 0.1, 0.05, 3, 0, 2)}};
  if (with_dust) given.push_back({.orbit = on(1.5, 0.2, 0.3, 2, 0, 0), .primary = Primary::body});
  System system;
  for (const BodyStart<double>& body : given) system.masses.push_back(body.mass);
  const auto placed = states_of(given, 1.0);
  for (std::size_t i = 0; i < given.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      system.q.push_back(placed.states[i].position[k]);
      system.p.push_back(placed.states[i].velocity[k] * (given[i].mass > 0 ? given[i].mass : 1));
    }
  }
  return system;
}

/// The system after a time of 8.
template <class A>
std::vector<double> moved(const Chosen& method, int steps, double mass, bool with_dust) {
  const System system = system_of(mass, with_dust);
  const NBody<double> problem = bodies(system.masses, 3);
  auto z = point<A>(system.q, system.p);
  WisdomHolmanStep<NBody<double>, A> stepper(problem, method.options, method.info);
  for (int k = 0; k < steps; ++k) EXPECT_EQ(stepper.step(problem, 8.0 / steps, z), Outcome::done);
  const auto found = z.positions();
  return {found.begin(), found.end()};
}

double distance(const std::vector<double>& a, const std::vector<double>& b, std::size_t first, std::size_t last) {
  double most = 0;
  for (std::size_t i = first; i < last; ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

TEST(WisdomHolmanStep, OrdersAndMasslessBodies) {
  const Chosen best{{.table = 6}, describe_saba(6)};
  const auto exact = moved<Compensated<double>>(best, 2000, 1e-2, true);
  for (const Chosen& method : all_methods()) {
    if (method.options.table >= 5) continue;  // at rounding after few steps
    const auto coarse = moved<Plain<double>>(method, 40, 1e-2, true);
    const auto fine = moved<Plain<double>>(method, 80, 1e-2, true);
    const double order = std::log2(distance(coarse, exact, 0, 9) / distance(fine, exact, 0, 9));
    EXPECT_NEAR(order, method.info.order, 0.3) << method.info.name;
    const double of_dust = std::log2(distance(coarse, exact, 9, 12) / distance(fine, exact, 9, 12));
    EXPECT_NEAR(of_dust, method.info.order, 0.5) << method.info.name;
    EXPECT_EQ(distance(moved<Plain<double>>(method, 40, 1e-2, false), coarse, 0, 9), 0) << method.info.name;
  }
}

/// Gauss nodes leave the error that is proportional to the squares of the masses.
TEST(WisdomHolmanStep, PowersOfTheMasses) {
  const Chosen best{{.table = 6}, describe_saba(6)};
  const auto error = [&](const Chosen& method, double mass) {
    const auto exact = moved<Compensated<double>>(best, 2000, mass, false);
    return distance(moved<Plain<double>>(method, 60, mass, false), exact, 0, 9);
  };
  for (const auto& [table, power] : {std::pair{0u, 1}, std::pair{2u, 2}, std::pair{3u, 2}}) {
    const Chosen method{{.table = table}, describe_saba(table)};
    EXPECT_NEAR(std::log10(error(method, 1e-2) / error(method, 1e-3)), power, 0.2) << method.info.name;
  }
}

template <class A>
auto corrected(const System& system, const WisdomHolmanOptions& options, double h) {
  using P = NBody<double>;
  const P problem = bodies(system.masses, 3);
  const auto start = point<Plain<double>>(system.q, system.p);
  return CorrectedSimulation<P, WisdomHolmanStep<P, A>, A>(problem, {problem, options, describe(options)}, start.q,
                                                           start.p, h, A{});
}

TEST(CorrectedSimulation, TakesTheStepsOfTheMethod) {
  const System system = system_of(1e-2, true);
  for (const int order : {3, 5, 7, 11, 17}) {
    const WisdomHolmanOptions options{.corrector = order};
    auto simulation = corrected<Plain<double>>(system, options, 0.1);
    Frame frame;
    simulation.look(frame);
    EXPECT_EQ(frame.q, system.q);
    ASSERT_EQ(simulation.advance(80), Outcome::done);
    simulation.look(frame);
    const auto by_steps = moved<Plain<double>>({options, describe(options)}, 80, 1e-2, true);
    EXPECT_LE(distance(frame.q, by_steps, 0, 12), 80 * 33 * 1e-16) << order;  // a rounding for each drift
    const auto without = moved<Plain<double>>({{}, describe(WisdomHolmanOptions{})}, 80, 1e-2, true);
    EXPECT_GT(distance(frame.q, without, 0, 12), 1e-6) << order;
  }
}

/// Correctors remove the errors that are linear in the masses; the powers of dt that are left grow with the order.
TEST(CorrectedSimulation, EnergyErrors) {
  const System system = system_of(1e-6, false);
  double before = 0;
  for (const int order : {0, 3, 5, 7, 11}) {
    const WisdomHolmanOptions options{.corrector = order};
    auto simulation = corrected<Compensated<double>>(system, options, 0.3);
    Frame frame;
    for (int k = 0; k < 300; ++k) {
      ASSERT_EQ(simulation.advance(1), Outcome::done);
      simulation.look(frame);
    }
    const double error = simulation.energy().max_error;
    if (order > 0) {
      EXPECT_LT(error, before / 3) << order;
    }
    before = error;
  }
}

TEST(CorrectedSimulation, StepsInPartsAndSavedStates) {
  const System system = system_of(1e-2, true);
  const WisdomHolmanOptions options{.corrector = 7, .kernel = WisdomHolmanKernel::lazy};
  auto whole = corrected<Compensated<double>>(system, options, 0.1);
  auto parts = corrected<Compensated<double>>(system, options, 0.1);
  ASSERT_EQ(whole.advance(50), Outcome::done);
  for (int k = 0; k < 20; ++k) ASSERT_EQ(parts.advance(1), Outcome::done);
  auto restored = corrected<Compensated<double>>(system, options, 0.1);
  restored.restore(parts.save());
  EXPECT_EQ(restored.save(), parts.save());
  ASSERT_EQ(restored.advance(30), Outcome::done);
  EXPECT_EQ(restored.bits(), whole.bits());
  EXPECT_EQ(restored.save(), whole.save());
}

/// C depends on the sign of dt: after a turn the steps begin in other variables.
TEST(CorrectedSimulation, TurnsBack) {
  const System system = system_of(1e-2, true);
  for (const bool by_momenta : {false, true}) {
    auto simulation = corrected<Plain<double>>(system, {.corrector = 11}, 0.1);
    ASSERT_EQ(simulation.advance(50), Outcome::done);
    Frame before;
    simulation.look(before);
    by_momenta ? simulation.negate_momenta() : simulation.reverse_time();
    Frame turned;
    simulation.look(turned);
    EXPECT_EQ(turned.q, before.q);
    ASSERT_EQ(simulation.advance(50), Outcome::done);
    Frame end;
    simulation.look(end);
    // What C(-dt) and C(dt) differ by is of higher order in dt and in the masses.
    EXPECT_LE(distance(end.q, system.q, 0, 12), 1e-6) << by_momenta;
  }
}

TEST(WisdomHolmanStep, SeesCloseEncounters) {
  using P = NBody<double>;
  // The inner body overtakes the outer one at a distance of 0.03; 3 Hill radii are 0.021 and 0.045.
  const double offset = 0.03;
  for (const auto coordinates : {WisdomHolmanCoordinates::jacobi, WisdomHolmanCoordinates::heliocentric}) {
    for (const double mass : {1e-6, 1e-5}) {
      const double a = 1 + offset;
      const double fast = 1.0;
      const double slow = 1 / std::sqrt(a);
      const double lead = 0.02;  // the inner body begins behind the outer one
      const System system{{1, mass, 0},
                          {0, 0, 0, 1, 0, 0, a * std::cos(lead), a * std::sin(lead), 0},
                          {0, 0, 0, 0, mass * fast, 0, -slow * std::sin(lead), slow * std::cos(lead), 0}};
      const P problem = bodies(system.masses, 3);
      const WisdomHolmanOptions options{.coordinates = coordinates};
      WisdomHolmanStep<P, Plain<double>> stepper(problem, options, describe(options));
      auto z = point<Plain<double>>(system.q, system.p);
      for (int k = 0; k < 100; ++k) ASSERT_EQ(stepper.step(problem, 0.01, z), Outcome::done);
      const auto found = stepper.first_encounter();
      EXPECT_EQ(found.step > 0, 3 * std::cbrt(mass / 3) > offset) << mass;
      if (found.step == 0) continue;
      EXPECT_EQ(found.one, 1u);
      EXPECT_EQ(found.other, 2u);
    }
  }
}

}  // namespace
}  // namespace hamflow
