// Divided differences without cancellation, against differences in twice the digits.
#include "hamflow/detail/numerics/slope.hpp"

#include <functional>
#include <string>

#include "../support/near.hpp"
#include "hamflow/arithmetic/quad.hpp"
#include "hamflow/detail/methods/implicit/recorded_energy.hpp"
#include "hamflow/problems/henon_heiles.hpp"

namespace hamflow {
namespace {

using N = Slope<double>;
using T = Trace<double>;

struct Case {
  std::string name;
  double from;
  std::function<N(const N&)> slope;
  std::function<Quad(const Quad&)> exact;
  std::function<double(double)> derivative;
};

const std::vector<Case>& cases() {
  static const std::vector<Case> all{
      {"sqrt", 0.7, [](const N& x) { return sqrt(x); }, [](const Quad& x) { return sqrt(x); },
       [](double x) { return 0.5 / std::sqrt(x); }},
      {"exp", -1.3, [](const N& x) { return exp(x); }, [](const Quad& x) { return exp(x); },
       [](double x) { return std::exp(x); }},
      {"log", 0.6, [](const N& x) { return log(x); }, [](const Quad& x) { return log(x); },
       [](double x) { return 1 / x; }},
      {"sin", 0.4, [](const N& x) { return sin(x); }, [](const Quad& x) { return sin(x); },
       [](double x) { return std::cos(x); }},
      {"cos", 0.4, [](const N& x) { return cos(x); }, [](const Quad& x) { return cos(x); },
       [](double x) { return -std::sin(x); }},
      {"tan", 0.3, [](const N& x) { return tan(x); }, [](const Quad& x) { return tan(x); },
       [](double x) { return 1 + std::tan(x) * std::tan(x); }},
      {"atan", 0.8, [](const N& x) { return atan(x); }, [](const Quad& x) { return atan(x); },
       [](double x) { return 1 / (1 + x * x); }},
      {"sinh", 0.9, [](const N& x) { return sinh(x); }, [](const Quad& x) { return sinh(x); },
       [](double x) { return std::cosh(x); }},
      {"cosh", 0.9, [](const N& x) { return cosh(x); }, [](const Quad& x) { return cosh(x); },
       [](double x) { return std::sinh(x); }},
      {"tanh", 0.5, [](const N& x) { return tanh(x); }, [](const Quad& x) { return tanh(x); },
       [](double x) { return 1 - std::tanh(x) * std::tanh(x); }},
      {"x^-1.5", 0.9, [](const N& x) { return pow(x, -1.5); }, [](const Quad& x) { return Quad(1) / (x * sqrt(x)); },
       [](double x) { return -1.5 / (x * x * std::sqrt(x)); }},
      {"x^5", -0.9, [](const N& x) { return pow(x, 5); }, [](const Quad& x) { return x * x * x * x * x; },
       [](double x) { return 5 * x * x * x * x; }},
      {"1/x", 0.7, [](const N& x) { return N(1.0) / x; }, [](const Quad& x) { return Quad(1) / x; },
       [](double x) { return -1 / (x * x); }},
      {"|x|", -0.7, [](const N& x) { return abs(x); }, [](const Quad& x) { return abs(x); },
       [](double) { return -1.0; }}};
  return all;
}

TEST(Slope, RoundsLikeTheDerivativeForAnyDifference) {
  for (const Case& each : cases()) {
    for (const double step : {0.9, 0.3, 1e-2, 1e-5, 1e-9, 1e-15, -1e-12, -0.2}) {
      const double to = each.from + step;
      if (to <= 0 && each.name != "x^5" && each.name != "|x|" && each.name != "exp") continue;
      const Quad way = Quad(to) - Quad(each.from);  // what is left of the step in double
      const double exact = static_cast<double>((each.exact(Quad(to)) - each.exact(Quad(each.from))) / way);
      const double found = each.slope(N(each.from, to, 1.0)).slope;
      // Some ten operations; |x| alone may pass 0 and become small.
      EXPECT_NEAR(found, exact, 16 * test::epsilon * std::fmax(std::fabs(exact), each.name == "|x|" ? 1.0 : 0.0))
          << each.name << ' ' << step;
    }
    const double still = each.slope(N(each.from, each.from, 1.0)).slope;
    EXPECT_NEAR(still, each.derivative(each.from), 16 * test::epsilon * std::fabs(still)) << each.name;
  }
}

TEST(Slope, CarriesDualNumbers) {
  // d/dt of (f(x + t) - f(x))/t = (f'(x + t) - [f(x + t) - f(x)]/t)/t, for short t f''(x)/2.
  using D = Dual<double, 1>;
  for (const double t : {0.0, 1e-14, 1e-9}) {
    const D step = D::variable(t, 0);
    const Slope<D> x(D(0.4), D(0.4) + step, D(1.0));
    EXPECT_NEAR(sin(x).slope.slope[0], -std::sin(0.4) / 2, 1e-9 + 8 * test::epsilon) << t;
    EXPECT_NEAR(log(x).slope.slope[0], -0.5 / 0.16, 4e-8) << t;
  }
}

TEST(Slope, OfAnEnergyHasNoCancellation) {
  const HenonHeiles<double> problem;
  const HenonHeiles<Quad> fine;
  const RecordedEnergy<HenonHeiles<double>, double> recorded(problem);
  const Vector<double, dynamic> z{0.3, -0.15, 0.2, 0.25};
  const Vector<double, dynamic> along{1.0, -0.5, 0.25, 2.0};
  for (const double t : {0.5, 1e-4, 1e-10, 1e-16}) {
    const double slope = recorded.slope(problem, z, along, t);
    const auto at = [&](const Quad& s) {
      const auto x = [&](std::size_t i) { return Quad(z[i]) + s * Quad(along[i]); };
      return energy(fine, Vector<Quad, 2>{x(0), x(1)}, Vector<Quad, 2>{x(2), x(3)});
    };
    const double exact = static_cast<double>((at(Quad(t)) - at(Quad(0))) / Quad(t));
    EXPECT_NEAR(slope, exact, 16 * test::epsilon + 1e-33 / t) << t;  // the terms of dH/dt add up to less than 1
  }
}

/// V = |q|^3/3 + max(q, 0): branches within a step, and one that a recording takes by a guard.
struct Broken {
  using Real = double;
  static constexpr std::size_t dimension = 1;
  template <class S>
  S energy(const Vector<S, 1>& q, const Vector<S, 1>& p) const {
    const S size = abs(q[0]);
    return p[0] * p[0] / 2.0 + size * size * size / 3.0 + (q[0] < S(0) ? S(0) : q[0]);
  }
};

TEST(Slope, OnTwoSidesOfABranchIsTheDifference) {
  const Broken problem;
  const RecordedEnergy<Broken, double> recorded(problem);
  const Vector<double, dynamic> along{1.0, 0.0};
  const auto slope = [&](double q, double t) {
    return recorded.slope(problem, Vector<double, dynamic>{q, 0.5}, along, t);
  };
  EXPECT_NEAR(slope(-1, 0.5), (0.125 - 1) / 3 / 0.5, 8 * test::epsilon);
  EXPECT_NEAR(slope(1, 1), 7.0 / 3 + 1, 32 * test::epsilon);
  EXPECT_NEAR(slope(-1, 3), (8.0 / 3 + 2 - 1.0 / 3) / 3, 8 * test::epsilon);
}

}  // namespace
}  // namespace hamflow
