// An implicit step decides when its iteration has come to the rounding, which guess it trusts, and when it looks for
// another one. None of these decisions may depend on the units of coordinates and momenta: in units that differ by
// powers of two every number of a run differs by that power alone, to the last bit.
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

/// The state at the end in units of L and P, and the steps that were taken.
std::string end_of(const Case& c, const std::string& method, const Units& units) {
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
  const Outcome outcome = run->advance(300);
  Frame end;
  run->look(end);
  std::string all = std::to_string(static_cast<int>(outcome));
  for (const double q : end.q) all += " " + shortest(q / units.length);
  for (const double p : end.p) all += " " + shortest(p / units.momentum);
  return all;
}

TEST(UnitsOfSteps, ChangeNoBit) {
  const Units other[] = {{0x1p40, 0x1p-60, 0x1p10}, {0x1p-40, 0x1p100, 0x1p-20}, {0x1p-100, 0x1p-100, 1}};
  for (const Case& c : cases) {
    for (const char* family : {"cg(1,3", "cg(2,4", "cg(2,auto", "gauss(1", "gauss(3", "lobatto-3a-3b(3"}) {
      for (const char* iteration : {"newton", "simplified", "fixed-point"}) {
        const std::string method = std::string(family) + ",iteration=" + iteration + ")";
        const std::string natural = end_of(c, method, {});
        for (const Units& units : other) {
          EXPECT_EQ(end_of(c, method, units), natural) << c.name << " " << method << " L = " << units.length;
        }
      }
    }
    for (const char* method : {"verlet", "rk4", "discrete-gradient", "itoh-abe", "dop853(1e-10)", "taylor"}) {
      if (std::string(c.hamiltonian).find("cos") != std::string::npos && std::string(method) == "verlet") continue;
      const std::string natural = end_of(c, method, {});
      for (const Units& units : other) {
        EXPECT_EQ(end_of(c, method, units), natural) << c.name << " " << method << " L = " << units.length;
      }
    }
  }
}

}  // namespace
}  // namespace hamflow::test
