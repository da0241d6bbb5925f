// Reversible steps of varying size: against their definition, their order, the way back, and broken recurrences.
#include "hamflow/detail/methods/step_density.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "../support/arithmetics.hpp"
#include "hamflow/arithmetic/plain.hpp"
#include "hamflow/formula/problem_texts.hpp"
#include "hamflow/methods/compositions/verlet.hpp"
#include "hamflow/methods/splitting.hpp"
#include "hamflow/methods/step_monitors.hpp"
#include "hamflow/problems/potentials/kepler.hpp"
#include "hamflow/problems/support/central_force.hpp"
#include "hamflow/run/catalog.hpp"
#include "hamflow/run/simulation_of.hpp"
#include "hamflow/verify/certificate.hpp"

namespace hamflow {
namespace {

/// Kepler's problem with k = mu = 1 and semi-axis 1, from the pericentre.
Request ellipse(double e, const std::string& method, const std::string& dt) {
  Request request;
  request.problem = "central-force";
  request.variant = {{"potential", "kepler"}, {"coordinates", "cartesian"}};
  request.start.q = {shortest(1 - e), "0"};
  request.start.p = {"0", shortest(std::sqrt((1 + e) / (1 - e)))};
  request.method = parse_method(method);
  request.dt = dt;
  return request;
}

struct Plane {
  double x, y, u, v;
  double square() const { return x * x + y * y; }
  double radial() const { return x * u + y * v; }
  double energy() const { return (u * u + v * v) / 2 - 1 / std::sqrt(square()); }
};
Plane at_pericentre(double e) { return {1 - e, 0, 0, std::sqrt((1 + e) / (1 - e))}; }

void kick(Plane& z, double h) {
  const double c = h / (z.square() * std::sqrt(z.square()));
  z.u -= c * z.x;
  z.v -= c * z.y;
}
void drift(Plane& z, double h) {
  z.x += h * z.u;
  z.y += h * z.v;
}
void verlet_step(Plane& z, double h) {
  kick(z, h / 2);
  drift(z, h);
  kick(z, h / 2);
}

double rate_by_distance(const Plane& z) { return -1.5 * z.radial() / z.square(); }
/// sigma = 1/S, S^2 = |v|^2 + 1/r^4, since p' = -q/r^3.
double rate_by_arclength(const Plane& z) {
  const double r2 = z.square();
  const double r3 = r2 * std::sqrt(r2);
  const double s2 = z.u * z.u + z.v * z.v + 1 / (r2 * r2);
  // d/dt (|v|^2/2) = -q.v/r^3, d/dt (r^-4)/2 = -2 q.v/r^6
  return (-z.radial() / r3 - 2 * z.radial() / (r3 * r3)) / s2;
}

TEST(StepDensity, FollowsItsDefinition) {
  constexpr double e = 0.9;
  for (const bool by_distance : {true, false}) {
    SCOPED_TRACE(by_distance);
    const std::string monitor = by_distance ? "distance" : "arclength";
    const auto run = make_simulation(ellipse(e, "verlet(step_control=reversible,monitor=" + monitor + ")", "0.001"));
    Plane z = at_pericentre(e);
    double rho = 1;
    double t = 0;
    double longest = 0;
    for (int step = 1; step <= 400; ++step) {
      const double h = 0.001 / rho;
      longest = std::max(longest, h);
      verlet_step(z, h);
      t += h;
      rho += 0.001 * (by_distance ? rate_by_distance(z) : rate_by_arclength(z));
      ASSERT_EQ(run->advance(1), Outcome::done);
      Frame frame;
      run->look(frame);
      // A rounding at the pericentre has grown by some (1 - e)^-3 in a round.
      const double bound = 1000 * step * 0x1p-52;
      ASSERT_NEAR(frame.time, t, bound * t) << step;
      ASSERT_NEAR(frame.q[0], z.x, bound) << step;
      ASSERT_NEAR(frame.p[1], z.v, bound * 4.4) << step;
    }
    EXPECT_GT(longest, 0.01);  // steps vary: from r = 0.1 they go on to r = 1
    Frame start;
    const auto first = make_simulation(ellipse(e, "verlet(step_control=reversible)", "0.001"));
    ASSERT_EQ(first->advance(1), Outcome::done);
    first->look(start);
    EXPECT_EQ(start.time, 0.001);  // dt is the first step
  }
}

/// By type, and the same map: the order of operations differs.
TEST(StepDensity, OfATypedSimulation) {
  const CentralForce<double, Kepler> kepler(1, Kepler<double>(Parameters<double>(Texts{{"k", "1"}})));
  auto run = simulate(kepler, Composition<compositions::verlet>{}, {0.4, 0.0}, {0.0, 2.0}, 0.01);
  run.vary_steps(distance_monitor(kepler));
  auto around = simulate(kepler, Composition<compositions::verlet>{}, {0.4, 0.0}, {0.0, 2.0}, 0.01);
  around.vary_steps(arclength_monitor(kepler));
  for (auto* each : {&run, &around}) {
    const bool by_distance = each == &run;
    const std::string options = by_distance ? ",monitor=distance" : "";
    const auto named = make_simulation(ellipse(0.6, "verlet(step_control=reversible" + options + ")", "0.01"));
    ASSERT_EQ(each->advance(300), Outcome::done);
    ASSERT_EQ(named->advance(300), Outcome::done);
    Frame a, b;
    each->look(a);
    named->look(b);
    EXPECT_NEAR(a.time, b.time, 1e-11);  // 300 steps, 2 rounds
    EXPECT_NEAR(a.q[0], b.q[0], 1e-11);
    EXPECT_EQ(each->method().name, named->method().name);
    EXPECT_TRUE(each->method().symmetric);
    EXPECT_FALSE(each->method().symplectic);
  }
}

/// The slope of the error against the exact flow over halvings of dt, each with twice as many steps.
double slope(const std::vector<double>& errors) {
  return std::log2(errors.front() / errors.back()) / static_cast<double>(errors.size() - 1);
}

TEST(StepDensity, KeepsTheOrderOnKepler) {
  struct Case {
    std::string method;
    double order;
    std::int64_t steps;
  };
  for (const Case& each : {Case{"verlet", 2, 200},
                           {"stv4", 4, 100},
                           {"yoshida6", 6, 60},  // the leading coefficient of kahan-li6 is too small to be seen
                           {"cg(1,auto)", 2, 100},
                           {"cg(2,auto)", 4, 40},
                           {"gauss(3)", 6, 24},
                           {"chin4a", 4, 60}}) {
    for (const std::string monitor : {"arclength", "distance"}) {
      SCOPED_TRACE(each.method + " " + monitor);
      std::vector<double> errors;
      for (int k = 0; k < 4; ++k) {
        MethodSpec spec = parse_method(each.method);
        Request request = ellipse(0.6, "verlet", "");
        spec.options["step_control"] = "reversible";
        spec.options["monitor"] = monitor;
        request.method = spec;
        const std::int64_t steps = each.steps << k;
        request.dt = shortest(3.0 / static_cast<double>(steps));
        const auto problem_entry = find_problem(request);
        const ProblemEntry& problem = *problem_entry;
        const auto run = make_simulation(request);
        ASSERT_EQ(run->advance(steps), Outcome::done);
        Frame end;
        run->look(end);
        EXPECT_GT(end.time, 3.5);  // beyond the apocentre, where steps are longest
        const std::vector<double> q{0.4, 0};
        const auto exact = problem.exact(complete(problem.info, {}), q, {0, 2}, end.time);
        ASSERT_TRUE(exact.has_value());
        errors.push_back(std::hypot(end.q[0] - exact->q[0], end.q[1] - exact->q[1]));
      }
      EXPECT_NEAR(slope(errors), each.order, 0.3) << errors.front() << " " << errors.back();
    }
  }
}

/// The same where no closed form is known: against a Taylor series to the run's own time.
void expect_order(Request request, double order, std::int64_t steps, double length) {
  std::vector<double> errors;
  for (int k = 0; k < 4; ++k) {
    const std::int64_t count = steps << k;
    request.dt = shortest(length / static_cast<double>(count));
    const auto run = make_simulation(request);
    ASSERT_EQ(run->advance(count), Outcome::done);
    Frame end;
    run->look(end);
    Request reference = request;
    reference.method = parse_method("taylor(tolerance=1e-15)");
    reference.dt = shortest(end.time);
    const auto exact = make_simulation(reference);
    ASSERT_EQ(exact->advance(1), Outcome::done);
    Frame there;
    exact->look(there);
    double square = 0;
    for (std::size_t i = 0; i < end.q.size(); ++i) square += (end.q[i] - there.q[i]) * (end.q[i] - there.q[i]);
    errors.push_back(std::sqrt(square));
  }
  EXPECT_NEAR(slope(errors), order, 0.3) << errors.front() << " " << errors.back();
}

TEST(StepDensity, KeepsTheOrderElsewhere) {
  Request henon;
  henon.problem = "henon-heiles";
  henon.start.q = {"0.1", "-0.2"};
  henon.start.p = {"0.3", "0.25"};
  henon.method = parse_method("stv4(step_control=reversible)");
  expect_order(henon, 4, 40, 5);
  henon.method = parse_method("cg(2,auto,step_control=reversible)");
  expect_order(henon, 4, 16, 5);

  Request typed;  // not separable
  typed.problem = "formula";
  typed.variant = formula_choices(texts_of_hamiltonian("(q^2 + 1)*(p^2 + 1)/2", {}));
  typed.start.q = {"0.7"};
  typed.start.p = {"0.4"};
  typed.method = parse_method("cg(1,auto,step_control=reversible)");
  expect_order(typed, 2, 40, 4);
  typed.method = parse_method("tao4(step_control=reversible)");
  expect_order(typed, 4, 400, 4);

  Request bodies;
  bodies.problem = "n-body";
  bodies.parameters = {{"masses", "[1, 0.3, 0.2]"}};
  bodies.start.q = {"0", "0", "1", "0", "0", "-0.6"};
  bodies.start.p = {"0", "-0.1", "0", "0.3", "0.16", "0"};
  for (const std::string monitor : {"arclength", "distance"}) {
    SCOPED_TRACE(monitor);
    bodies.method = parse_method("stv4(step_control=reversible,monitor=" + monitor + ")");
    expect_order(bodies, 4, 80, 2);
  }
}

// What a broken recurrence does, seen from outside: whether a run comes back, and whether steps follow the distance.
struct Behaviour {
  double distance = 0;       // after 700 steps there and back
  double mismatch = 0;       // how far rho sigma is from its start, over ten rounds
  double energy_growth = 0;  // the largest energy error of the last of 40 rounds beside that of the first
};

/// @param Broken derives from StepDensity and hides what it does otherwise; place: where in the step G is looked at
template <class Density>
Behaviour behaviour_of(bool look_half_way = false) {
  constexpr double dt = 0.002;
  constexpr double e = 0.8;
  const auto advance = [&](Plane& z, Density& density) {
    const double h = density.length();
    Plane half = z;
    verlet_step(half, h / 2);
    verlet_step(z, h);
    density.advance(h, rate_by_distance(look_half_way ? half : z));
  };
  Behaviour found;
  {
    Plane z = at_pericentre(e);
    Density density(dt);
    for (int way = 0; way < 2; ++way) {
      for (int i = 0; i < 700; ++i) advance(z, density);
      z.u = -z.u;
      z.v = -z.v;
      density.turn(rate_by_distance(z));
    }
    found.distance = std::hypot(z.x - (1 - e), z.y);
  }
  Plane z = at_pericentre(e);
  Density density(dt);
  const double energy = z.energy();
  double worst = 0;
  double first = 0;
  for (int round = 0; round < 40; ++round) {
    worst = 0;
    for (double end = density.time() + 2 * 3.14159265358979; density.time() < end;) {
      const double h = density.length();
      advance(z, density);
      worst = std::max(worst, std::abs(z.energy() - energy));
      const double sigma = std::pow(z.square() / ((1 - e) * (1 - e)), 0.75);
      if (round < 10) found.mismatch = std::max(found.mismatch, std::abs(std::log(dt * sigma / h)));
    }
    if (round == 0) first = worst;
  }
  found.energy_growth = worst / first;
  return found;
}
bool is_sound(const Behaviour& found) {
  // Rounding grows by some 10^3 from one pericentre to the next; a step is beside its own ends by dt G < 0.02.
  return found.distance < 1e-10 && found.mismatch < 0.1 && found.energy_growth < 1.5;
}

using Sound = StepDensity<Plain<double>>;
struct WrongSign : Sound {
  using Sound::Sound;
  void advance(double h, double rate) { Sound::advance(h, -rate); }
};
struct Deaf : Sound {
  using Sound::Sound;
  void turn(double) {}
};
/// The size of a step from the point where it begins.
struct FromItsBeginning : Sound {
  using Sound::Sound;
  double length() const { return own_; }
  void advance(double h, double rate) {
    Sound::advance(h, rate);
    own_ *= std::exp(-h * rate);  // sigma' = -sigma G
  }
  double own_ = 0.002;
};
struct TwiceAsFast : Sound {
  using Sound::Sound;
  void advance(double h, double rate) { Sound::advance(h, 2 * rate); }
};

TEST(StepDensity, BrokenRecurrencesAreFound) {
  const Behaviour sound = behaviour_of<Sound>();
  EXPECT_TRUE(is_sound(sound)) << sound.distance << " " << sound.mismatch << " " << sound.energy_growth;
  EXPECT_FALSE(is_sound(behaviour_of<Sound>(true))) << "G half way through the step";
  EXPECT_FALSE(is_sound(behaviour_of<WrongSign>()));
  EXPECT_FALSE(is_sound(behaviour_of<Deaf>()));
  EXPECT_FALSE(is_sound(behaviour_of<FromItsBeginning>()));
  EXPECT_FALSE(is_sound(behaviour_of<TwiceAsFast>()));
}

TEST(StepDensity, ComesBack) {
  for (const std::string method : {"verlet", "stv4-dkd", "cg(2,auto)", "gauss(2)", "tao2(200)"}) {
    for (const std::string& arithmetic :
         test::present({"double", "compensated", "double-double", "quad", "mp(40)", "lattice"})) {
      for (const std::string monitor : {"arclength", "distance"}) {
        MethodSpec spec = parse_method(method);
        spec.options["step_control"] = "reversible";
        spec.options["monitor"] = monitor;
        Request request = ellipse(0.6, "verlet", "0.01");
        request.method = spec;
        request.arithmetic = arithmetic;
        if (!refusal(spec, arithmetic).empty()) continue;
        SCOPED_TRACE(describe(spec).name + " " + arithmetic);
        const auto problem_entry = find_problem(request);
        const ProblemEntry& problem = *problem_entry;
        const std::int64_t steps = digits_beyond_double(arithmetic) > 0 ? 60 : 300;
        const ReversalEvidence evidence = reversal_evidence(request, problem, steps, 300);
        if (describe(spec)
                .carries_copy) {  // its two copies may part, so that nothing is known of what rounding becomes
          EXPECT_NE(evidence.proves, ReversalProof::not_reversible) << evidence.reason;
          continue;
        }
        EXPECT_EQ(evidence.proves, arithmetic == "lattice" ? ReversalProof::every_bit : ReversalProof::to_rounding)
            << evidence.reason;
      }
    }
  }
}

/// Bodies, whose close encounters are unlike each other, on the lattice: every bit.
TEST(StepDensity, BodiesComeBackOnTheLattice) {
  Request request;
  request.problem = "n-body";
  request.parameters = {{"masses", "[1, 0.3, 0.2]"}};
  request.start.q = {"0", "0", "1", "0", "0", "-0.6"};
  request.start.p = {"0", "-0.1", "0", "0.3", "0.16", "0"};
  request.arithmetic = "lattice";
  request.dt = "0.005";
  for (const std::string monitor : {"arclength", "distance"}) {
    request.method = parse_method("stv4(step_control=reversible,monitor=" + monitor + ")");
    const auto run = make_simulation(request);
    const Reversal reversal = reverse(*run, 3000);
    EXPECT_EQ(reversal.outcome, Outcome::done);
    EXPECT_TRUE(reversal.bit_exact);
  }
}

/// A recorded step carries the density and the time as it carries the state.
TEST(StepDensity, RecordedStepsHaveTheSameBits) {
  Request henon;
  henon.problem = "henon-heiles";
  henon.start.q = {"0.1", "-0.2"};
  henon.start.p = {"0.3", "0.25"};
  henon.dt = "0.05";
  Request bodies;
  bodies.problem = "n-body";
  bodies.parameters = {{"masses", "[1, 0.001, 0.0005]"}};
  bodies.start.q = {"0", "0", "1", "0", "0", "-1.7"};
  bodies.start.p = {"0", "-0.001", "0", "0.001", "0.00038", "0"};
  bodies.dt = "0.05";
  for (Request request : {ellipse(0.8, "verlet", "0.002"), henon, bodies}) {
    for (const std::string method : {"verlet", "stv4-dkd", "blanes-moan-s6"}) {
      for (const std::string monitor : {"arclength", "distance"}) {
        for (const std::string arithmetic : {"double", "compensated"}) {
          MethodSpec spec = parse_method(method);
          spec.options["step_control"] = "reversible";
          spec.options["monitor"] = monitor;
          if (!refusal(spec, *find_problem(request)).empty()) continue;
          request.method = spec;
          request.arithmetic = arithmetic;
          request.record = true;
          const auto recorded = make_simulation(request);
          request.record = false;
          const auto plain = make_simulation(request);
          SCOPED_TRACE(plain->method().name + " on " + request.problem + " in " + arithmetic);
          for (const std::int64_t steps : {700, 1, 700}) {
            for (Simulation* run : {recorded.get(), plain.get()}) {
              ASSERT_EQ(run->advance(steps), Outcome::done);
              if (steps == 1) run->negate_momenta();
            }
            ASSERT_EQ(recorded->save(), plain->save());
          }
          EXPECT_TRUE(recorded->is_recorded());
          EXPECT_FALSE(plain->is_recorded());
        }
      }
    }
  }
}

TEST(StepDensity, TimeRunsBackToWhereItBegan) {
  const auto run = make_simulation(ellipse(0.6, "stv4(step_control=reversible)", "0.01"));
  ASSERT_EQ(run->advance(500), Outcome::done);
  Frame there;
  run->look(there);
  run->reverse_time();
  ASSERT_EQ(run->advance(500), Outcome::done);
  Frame back;
  run->look(back);
  EXPECT_NEAR(back.time, 0, 1e-10 * there.time);
  EXPECT_NEAR(back.q[0], 0.4, 1e-10);
  EXPECT_NEAR(back.p[1], 2, 1e-10);
  run->reverse_time();
  const double before = back.time;
  ASSERT_EQ(run->advance(1), Outcome::done);
  run->look(back);
  EXPECT_NEAR(back.time - before, 0.01, 1e-10);  // the first step once more
}

/// A part of a step has the time and the state in between.
TEST(StepDensity, LooksWithinAStep) {
  const auto run = make_simulation(ellipse(0.6, "stv4(step_control=reversible)", "0.01"));
  ASSERT_EQ(run->advance(37), Outcome::done);
  Frame before, half, whole, after;
  run->look(before);
  ASSERT_EQ(run->look_part(0.5, half), Outcome::done);
  ASSERT_EQ(run->look_part(1, whole), Outcome::done);
  ASSERT_EQ(run->advance(1), Outcome::done);
  run->look(after);
  EXPECT_NEAR(half.time, std::midpoint(before.time, after.time), 4e-16 * after.time);
  EXPECT_NEAR(whole.time, after.time, 4e-16 * after.time);
  EXPECT_NEAR(whole.q[0], after.q[0], 1e-15);
}

/// From far outside into the centre: G dt passes 1, and no step follows.
TEST(StepDensity, SaysWhereItEnds) {
  const auto run = make_simulation(ellipse(0.99, "verlet(step_control=reversible,monitor=distance)", "0.5"));
  EXPECT_EQ(run->advance(100), Outcome::not_converged);
  EXPECT_NE(run->failure().find("the density of steps became"), std::string::npos) << run->failure();
}

}  // namespace
}  // namespace hamflow
