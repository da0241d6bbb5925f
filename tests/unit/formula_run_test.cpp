// Typed Hamiltonians run: by name beside the built-in problem, and as a C++ problem in the typed templates.
#include <gtest/gtest.h>

#include <set>

#include "../support/arithmetics.hpp"
#include "../support/near.hpp"
#include "hamflow/hamflow.hpp"

namespace hamflow {
namespace {

struct Pair {
  std::string name;
  Request built_in;
  FormulaTexts texts;
};

Request request_of(const std::string& problem, std::map<std::string, std::string> variant, Texts parameters,
                   std::vector<std::string> q, std::vector<std::string> p, const std::string& dt) {
  Request r;
  r.problem = problem;
  r.variant = std::move(variant);
  r.parameters = std::move(parameters);
  r.start.q = std::move(q);
  r.start.p = std::move(p);
  r.dt = dt;
  return r;
}

/// Every Hamiltonian of the reference file exact_flow.json, as it stands there, but for the double pendulum (below).
std::vector<Pair> pairs() {
  const std::string plane = "(p1^2+p2^2)";
  return {
      {"kepler",
       request_of("central-force", {{"potential", "kepler"}, {"coordinates", "cartesian"}}, {}, {"0.4", "0"},
                  {"0", "2"}, "0.02"),
       {.coordinates = {"q1", "q2"},
        .hamiltonian = "(p1^2+p2^2)/(2*mu)-k/sqrt(q1^2+q2^2)",
        .parameters = {{"mu", "1"}, {"k", "1"}}}},
      {"henon-heiles",
       request_of("henon-heiles", {}, {}, {"0.18", "0.18"}, {"0.18", "0.18"}, "0.1"),
       {.coordinates = {"q1", "q2"}, .hamiltonian = plane + "/2+(q1^2+q2^2)/2+q1^2*q2-q2^3/3"}},
      {"pendulum",
       request_of("pendulum", {}, {}, {"2.5"}, {"0"}, "0.1"),
       {.coordinates = {"q"}, .hamiltonian = "p^2/2-cos(q)"}},
      {"lennard-jones",
       request_of("lennard-jones-oscillator", {}, {}, {"1.5"}, {"0"}, "0.01"),
       {.coordinates = {"q"}, .hamiltonian = "p^2/2+q^-12-2*q^-6"}},
      {"binomial",
       request_of("central-force", {{"potential", "binomial"}, {"coordinates", "cartesian"}}, {}, {"1", "0"},
                  {"0.2", "1"}, "0.05"),
       {.coordinates = {"q1", "q2"}, .hamiltonian = plane + "/2+(k/2)*(q1^2+q2^2-1)^2", .parameters = {{"k", "1"}}}},
      {"duffing",
       request_of("duffing", {}, {{"alpha", "1"}, {"beta", "1"}}, {"1"}, {"0"}, "0.05"),
       {.coordinates = {"q"},
        .hamiltonian = "p^2/2+alpha*q^2/2+beta*q^4/4",
        .parameters = {{"alpha", "1"}, {"beta", "1"}}}}};
}

Request typed(const Pair& pair) {
  Request r = pair.built_in;
  r.problem = FormulaKeys::problem;
  r.variant = formula_choices(pair.texts);
  r.parameters = pair.texts.parameters;
  return r;
}

Frame end_of(Request request, const std::string& method, const std::string& arithmetic, std::int64_t steps) {
  request.method = parse_method(method);
  request.arithmetic = arithmetic;
  const auto run = make_simulation(request);
  EXPECT_EQ(run->advance(steps), Outcome::done) << method;
  Frame frame;
  run->look(frame);
  return frame;
}

TEST(FormulaRuns, HaveTheBitsOfTheBuiltInProblem) {
  for (const Pair& pair : pairs()) {
    const Request own = typed(pair);
    for (const char* method : {"verlet", "stv4", "kahan-li8", "pefrl", "rk4", "dop853", "taylor"}) {
      const std::int64_t steps = std::string(method) == "taylor" ? 50 : 1000;
      const Frame a = end_of(pair.built_in, method, "double", steps);
      const Frame b = end_of(own, method, "double", steps);
      EXPECT_EQ(a.q, b.q) << pair.name << " " << method;
      EXPECT_EQ(a.p, b.p) << pair.name << " " << method;
    }
    const Frame a = end_of(pair.built_in, "stv4", "compensated", 1000);
    const Frame b = end_of(own, "stv4", "compensated", 1000);
    EXPECT_EQ(a.q, b.q) << pair.name;
    EXPECT_EQ(a.p, b.p) << pair.name;
    const std::string most_digits = test::present({"double-double", "quad"}).back();
    const Frame c = end_of(pair.built_in, "verlet", most_digits, 20);
    const Frame d = end_of(own, "verlet", most_digits, 20);
    for (std::size_t i = 0; i < c.q.size(); ++i)
      EXPECT_NEAR(c.q[i], d.q[i], 4 * test::epsilon * std::fabs(c.q[i])) << pair.name;
  }
}

/// Newton's matrix has other last bits, so that an element converges to another neighbour of the root: some units of
/// rounding a step, which these orbits let grow with the square of the time at most.
TEST(FormulaRuns, ElementsAgreeToRounding) {
  constexpr std::int64_t steps = 200;
  for (const Pair& pair : pairs()) {
    const Frame a = end_of(pair.built_in, "cg(1,5)", "double", steps);
    const Frame b = end_of(typed(pair), "cg(1,5)", "double", steps);
    for (std::size_t i = 0; i < a.q.size(); ++i) {
      EXPECT_NEAR(a.q[i], b.q[i], 4.0 * steps * steps * test::epsilon) << pair.name;
      EXPECT_NEAR(a.p[i], b.p[i], 4.0 * steps * steps * test::epsilon) << pair.name;
    }
  }
}

TEST(FormulaRuns, OfTheDoublePendulum) {
  FormulaTexts texts{.coordinates = {"q1", "q2"},
                     .hamiltonian =
                         "(p1^2-4*cos(q1-q2)*p1*p2+5*p2^2)/(2*m*l^2*(5-4*cos(q1-q2)^2))"
                         "-m*g*l*(3*cos(q1)+cos(q2))",
                     .parameters = {{"m", "2"}, {"l", "3"}, {"g", "9.81"}}};
  const Pair pair{"double pendulum",
                  request_of("double-pendulum", {{"model", "nonlinear"}, {"angles", "absolute"}},
                             {{"masses", "[2, 2]"}, {"half_lengths", "[3, 3]"}}, {"0", "pi/2"}, {"0", "0"}, "0.01"),
                  texts};
  for (const char* method : {"cg(1,5)", "rk4", "dop853", "taylor"}) {
    const Frame a = end_of(pair.built_in, method, "double", 20);
    const Frame b = end_of(typed(pair), method, "double", 20);
    for (std::size_t i = 0; i < 2; ++i) {
      // Momenta of some hundred; dop853 and taylor choose their steps by estimates.
      EXPECT_NEAR(a.q[i], b.q[i], 1e-11) << method;
      EXPECT_NEAR(a.p[i], b.p[i], 1e-9) << method;
    }
  }
  Request splitting = typed(pair);
  splitting.method = parse_method("stv4");
  EXPECT_THROW((void)make_simulation(splitting), Error);
}

/// x'' = cos t from rest at 0: x = 1 - cos t. Kicks stand at the time of their stage.
TEST(FormulaRuns, CarryTheTime) {
  const FormulaTexts texts{.coordinates = {"x"}, .hamiltonian = "p_x^2/2 - x*cos(t)"};
  Request r = request_of(FormulaKeys::problem, formula_choices(texts), {}, {"0"}, {"0"}, "0.01");
  for (const char* method : {"kahan-li8", "yoshida6", "rk4", "cg", "dop853"}) {
    const Frame end = end_of(r, method, "double", 300);
    ASSERT_EQ(end.q.size(), 1U);
    const double tolerance = std::string(method) == "cg" ? 1e-4 : 1e-9;
    EXPECT_NEAR(end.q[0], 1 - std::cos(end.time), tolerance) << method;
    EXPECT_NEAR(end.p[0], std::sin(end.time), tolerance) << method;
  }
  // H - H(0) - int dH/dt is what is watched: H itself changes by 1.
  r.method = parse_method("kahan-li8");
  const auto run = make_simulation(r);
  EXPECT_EQ(run->advance(300), Outcome::done);
  EXPECT_LT(run->energy().max_error, 1e-12);
}

/// Order conditions for T quadratic in p, and the force gradient, hold with an explicit t: halving the step divides the
/// error by 2^order, here to a quarter of the exponent, since steps are long enough to be far from rounding.
TEST(FormulaRuns, WithTimeKeepTheOrderOfMethodsForQuadraticKineticEnergy) {
  const FormulaTexts texts{.coordinates = {"x", "y"},
                           .hamiltonian =
                               "p_x^2/2 + p_x*p_y/3 + p_y^2 + x^4/4 + y^2*(1 + sin(t)/2)/2 "
                               "+ x*y*cos(2*t)/3 - x*cos(t)"};
  Request r = request_of(FormulaKeys::problem, formula_choices(texts), {}, {"0.7", "-0.4"}, {"0.2", "0.5"}, "0.01");
  EXPECT_TRUE(find_problem(r)->structure->quadratic_kinetic);
  const auto end = [&](const std::string& method, int steps) {
    r.dt = "2/" + std::to_string(steps);
    return end_of(r, method, "double", steps);
  };
  const Frame exact = end("taylor(tolerance=1e-15)", 20);
  const auto distance = [&](const Frame& a) {
    double sum = 0;
    for (std::size_t i = 0; i < 2; ++i) sum += std::hypot(a.q[i] - exact.q[i], a.p[i] - exact.p[i]);
    return sum;
  };
  struct Case {
    const char* method;
    int order;
    int steps;
  };
  for (const Case& c :
       {Case{"srkn6b", 4, 16}, Case{"srkn11b", 6, 12}, Case{"srkn14a", 6, 12}, Case{"okunbor-skeel6", 6, 24},
        Case{"rkn8-s19", 8, 6}, Case{"chin4a", 4, 24}, Case{"chin4b", 4, 24}}) {
    const double coarse = distance(end(c.method, c.steps));
    const double fine = distance(end(c.method, 2 * c.steps));
    EXPECT_NEAR(std::log2(coarse / fine), c.order, 0.25 * c.order) << c.method << " " << coarse << " " << fine;
    EXPECT_GT(fine, 1e-12) << c.method;
  }
}

/// p = M v has nothing to do with the time.
TEST(FormulaRuns, WithTimeStartFromVelocities) {
  const FormulaTexts texts{.coordinates = {"x", "y"}, .hamiltonian = "p_x^2/4 + (p_y - x)^2/2 + x*y*cos(t)"};
  Request r = request_of(FormulaKeys::problem, formula_choices(texts), {}, {"0.5", "0.3"}, {}, "0.01");
  r.start.v = {"0.25", "-1"};
  for (const std::string& arithmetic : test::present({"double", "quad"})) {
    const Frame start = end_of(r, "cg", arithmetic, 0);
    EXPECT_EQ(start.p, (std::vector<double>{0.5, -0.5})) << arithmetic;
  }
}

/// |T| + |V| of an H that is their sum, whatever the method asks of it.
TEST(FormulaRuns, ScaleOfTheEnergyIsThatOfItsParts) {
  const FormulaTexts texts{.coordinates = {"x"}, .hamiltonian = "sqrt(1 + p_x^2) - 2*cosh(x)"};
  Request r = request_of(FormulaKeys::problem, formula_choices(texts), {}, {"0.5"}, {"0.75"}, "0.01");
  for (const std::string& arithmetic : test::present({"double", "quad"})) {
    for (const char* method : {"stv4", "rk4", "dop853", "taylor", "cg(1,5)"}) {
      if (arithmetic == "quad" && method == std::string("taylor")) continue;
      r.method = parse_method(method);
      r.arithmetic = arithmetic;
      EXPECT_NEAR(make_simulation(r)->energy_scale(), 1.25 + 2 * std::cosh(0.5), 1e-15) << method << arithmetic;
    }
  }
}

/// Elements of few coordinates are recorded: where second derivatives have the bits of those by hand, the runs have
/// them.
TEST(FormulaRuns, ElementsHaveTheBitsOfTheBuiltInProblem) {
  const FormulaTexts sextic{.coordinates = {"q"},
                            .hamiltonian = "p^3/3 - p/2 + q^6/30 + q^4/4 - q^3/3 + 1/6"};  // solved in (q, p)
  std::vector<Pair> all = pairs();
  all.push_back({"sextic", request_of("sextic", {}, {}, {"0.5"}, {"0.5"}, "0.05"), sextic});
  int same = 0;
  for (const Pair& pair : all) {
    const std::set<std::string> with_bits{"henon-heiles", "pendulum", "sextic", "duffing", "binomial", "lennard-jones"};
    if (!with_bits.contains(pair.name)) continue;
    for (const char* method :
         {"cg(1,5)", "cg", "cg(1,1)", "cg(quadrature=4,tolerance=1e-12)", "cg(1,2,diagnostics=true)"}) {
      const Frame a = end_of(pair.built_in, method, "double", 500);
      const Frame b = end_of(typed(pair), method, "double", 500);
      EXPECT_EQ(a.q, b.q) << pair.name << " " << method;
      EXPECT_EQ(a.p, b.p) << pair.name << " " << method;
      EXPECT_EQ(a.effort.linear_solves, b.effort.linear_solves) << pair.name << " " << method;
      EXPECT_EQ(a.effort.force + a.effort.gradient, b.effort.force + b.effort.gradient) << pair.name << " " << method;
      ++same;
    }
  }
  EXPECT_EQ(same, 30);
}

TEST(FormulaProblems, RunInTypedTemplates) {
  const auto pendulum = natural_formula_problem("p^2/2 - k*cos(q)", {{"k", "2"}});
  const Vector<double, dynamic> q{0.5};
  const Vector<double, dynamic> p{0.0};
  auto symplectic = simulate(pendulum, Composition<compositions::stv4>{}, q, p, 0.05);
  auto conserving = simulate(formula_problem("p^2/2 - k*cos(q)", {{"k", "2"}}), Cg{}, q, p, 0.05);
  EXPECT_EQ(symplectic.advance(1000), Outcome::done);
  EXPECT_EQ(conserving.advance(1000), Outcome::done);
  EXPECT_LT(conserving.energy().max_error, 1e-14);
  auto by_hand = simulate(Pendulum<double>(1, 1, 2), Composition<compositions::stv4>{}, {0.5}, {0.0}, 0.05);
  EXPECT_EQ(by_hand.advance(1000), Outcome::done);
  Frame a;
  Frame b;
  symplectic.look(a);
  by_hand.look(b);
  EXPECT_EQ(a.q, b.q);
  EXPECT_EQ(a.p, b.p);
}

TEST(FormulaProblems, HaveWhatTheirTypePromises) {
  EXPECT_THROW((void)separable_formula_problem("p_x^2/2 + x*p_x"), FormulaError);
  EXPECT_THROW((void)natural_formula_problem("sqrt(1 + p^2) + q^2"), FormulaError);
  EXPECT_EQ(separable_formula_problem("sqrt(1 + p^2) + q^2").size(), 1U);
  EXPECT_THROW((void)formula_problem("1 + x"), FormulaError);  // no momentum
  EXPECT_THROW((void)formula_problem("p^2/(2*m)"), FormulaError);
}

}  // namespace
}  // namespace hamflow
