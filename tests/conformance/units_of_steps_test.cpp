// An implicit step decides when its iteration has come to the rounding, which guess it trusts, and when it looks for
// another one. None of these decisions depends on the units of coordinates and momenta: in units that differ by powers
// of two, every number of a run differs by such a power.
#include <gtest/gtest.h>

#include <cmath>

#include "hamflow/core/text.hpp"
#include "hamflow/formula/problem_texts.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow::test {
namespace {

struct Units {
  double length = 1;
  double momentum = 1;
  double time = 1;
};

struct Case {
  const char* name;
  const char* hamiltonian;  // of X = x/L, Y = y/L, A = p_x/P, B = p_y/P, in units of L P/T
  double q[2];
  double p[2];
  double dt;
};

const Case cases[] = {
    {"rotor", "(A^2 + B^2/(2 + cos(X)))/2 - cos(X) + Y^2/2", {0.75, -0.5}, {0.25, 1.5}, 0.125},
    {"long steps", "(A^2 + B^2/(2 + cos(X)))/2 - cos(X) + Y^2/2", {2.5, -0.5}, {1.25, 4.5}, 1.5},
    {"natural", "(A^2 + B^2)/2 + X^2*Y + (X^2 + Y^2)/2 - Y^3/3", {0.25, -0.125}, {0.25, 0.125}, 0.125},
    {"orbit", "(A^2 + B^2)/2 - 1/sqrt(X^2 + Y^2)", {0.25, 0}, {0, 2.5}, 0.0625},
};

std::string with(std::string text, const std::string& symbol, const std::string& by) {
  for (std::size_t at = text.find(symbol); at != std::string::npos; at = text.find(symbol, at + by.size())) {
    text.replace(at, symbol.size(), by);
  }
  return text;
}

struct End {
  Outcome outcome{};
  std::vector<double> state;  // in units of L and P
  double solves = 0;          // of linear systems, a step
};

constexpr std::int64_t steps = 300;

End end_of(const Case& c, const std::string& method, const Units& units, std::int64_t steps_taken) {
  std::string h = c.hamiltonian;
  h = with(with(h, "X", "(x/L)"), "Y", "(y/L)");
  h = with(with(h, "A", "(p_x/P)"), "B", "(p_y/P)");
  Request r;
  r.problem = FormulaKeys::problem;
  r.variant = formula_choices(FormulaTexts{.coordinates = {"x", "y"},
                                           .hamiltonian = "(L*P/T)*(" + h + ")",
                                           .parameters = {{"L", "1"}, {"P", "1"}, {"T", "1"}}});
  r.parameters = {{"L", shortest(units.length)}, {"P", shortest(units.momentum)}, {"T", shortest(units.time)}};
  for (int i = 0; i < 2; ++i) {
    r.start.q.push_back(shortest(c.q[i] * units.length));
    r.start.p.push_back(shortest(c.p[i] * units.momentum));
  }
  r.dt = shortest(c.dt * units.time);
  r.method = parse_method(method);
  const auto run = make_simulation(r);
  End end{.outcome = run->advance(steps_taken)};
  Frame frame;
  run->look(frame);
  for (const double q : frame.q) end.state.push_back(q / units.length);
  for (const double p : frame.p) end.state.push_back(p / units.momentum);
  end.solves = static_cast<double>(run->effort().linear_solves) / static_cast<double>(steps_taken);
  return end;
}

const Units other_units[] = {{0x1p40, 0x1p-60, 0x1p10}, {0x1p-40, 0x1p100, 0x1p-20}, {0x1p-100, 0x1p-100, 1}};

/// Fixed points are found without a matrix: nothing rounds differently. Of discrete-gradient nothing is expected: its
/// definition has |(q1 - q0, p1 - p0)|, and so another step in other units.
TEST(UnitsOfSteps, ChangeNoBitWithoutAMatrix) {
  for (const Case& c : cases) {
    for (const std::string method :
         {"cg(1,3,iteration=fixed-point)", "cg(2,4,iteration=fixed-point)", "cg(2,auto,iteration=fixed-point)",
          "gauss(1,iteration=fixed-point)", "gauss(3,iteration=fixed-point)", "lobatto-3a-3b(3,iteration=fixed-point)",
          "rk4", "dop853(1e-10)", "taylor"}) {
      const End natural = end_of(c, method, {}, steps);
      for (const Units& units : other_units) {
        const End end = end_of(c, method, units, steps);
        EXPECT_EQ(end.outcome, natural.outcome) << c.name << " " << method << " L = " << units.length;
        EXPECT_EQ(end.state, natural.state) << c.name << " " << method << " L = " << units.length;
      }
    }
  }
}

/// A matrix of equations of q and p is factored with the largest pivots, which are others in other units: corrections
/// round differently, and nothing else. After 300 steps 2.6e-13 was the largest difference. Steps that are too long
/// amplify it without bound, so one of them is compared.
TEST(UnitsOfSteps, ChangeRoundingAlone) {
  for (const Case& c : cases) {
    const bool is_long = c.dt > 1;
    for (const std::string family : {"cg(1,3", "cg(2,4", "cg(2,auto", "gauss(1", "gauss(3", "lobatto-3a-3b(3"}) {
      for (const std::string iteration : {"newton", "simplified"}) {
        const std::string method = family + ",iteration=" + iteration + ")";
        const End natural = end_of(c, method, {}, is_long ? 1 : steps);
        for (const Units& units : other_units) {
          const End end = end_of(c, method, units, is_long ? 1 : steps);
          EXPECT_EQ(end.outcome, natural.outcome) << c.name << " " << method << " L = " << units.length;
          for (std::size_t i = 0; i < natural.state.size(); ++i) {
            EXPECT_NEAR(end.state[i], natural.state[i], 1e-11) << c.name << " " << method << " L = " << units.length;
          }
          if (is_long) continue;
          EXPECT_NEAR(end.solves, natural.solves, 0.03 * natural.solves)
              << c.name << " " << method << " L = " << units.length;
        }
      }
    }
  }
}

}  // namespace
}  // namespace hamflow::test
