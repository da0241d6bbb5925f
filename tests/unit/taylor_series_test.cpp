// The recurrences of the Taylor coefficients against Cauchy's integral formula, which knows nothing of them, and the
// recording against the rules it promises.
#include "hamflow/detail/numerics/taylor_series.hpp"

#include <complex>
#include <functional>
#include <string>

#include "../support/near.hpp"

namespace hamflow {
namespace {

using L = long double;
using C = std::complex<long double>;
using T = Trace<long double>;

constexpr std::size_t order = 12;

/// Coefficients 0..order of f about 0 by the trapezoidal rule on |z| = radius, exact but for aliases of order 64.
std::vector<L> by_cauchy(const std::function<C(C)>& f, L radius) {
  constexpr int points = 64;
  const L pi = std::acos(-1.0L);
  std::vector<C> sums(order + 1);
  for (int m = 0; m < points; ++m) {
    const L angle = 2 * pi * m / points;
    const C value = f(std::polar(radius, angle));
    for (std::size_t k = 0; k <= order; ++k) sums[k] += value * std::polar(1.0L, -angle * static_cast<L>(k));
  }
  std::vector<L> coefficients;
  for (std::size_t k = 0; k <= order; ++k) {
    coefficients.push_back(sums[k].real() / points / std::pow(radius, static_cast<L>(k)));
  }
  return coefficients;
}

/// f(x(t)) for x = 0.6 + t + 0.3 t^2, t the only input, t' = 1.
Tape<L> tape_of(const std::function<T(const T&)>& f) {
  Recorder<L> recorder;
  const T t = recorder.input(0);
  const T y = f(t + 0.3L * (t * t) + 0.6L);
  return recorder.finish({T(1), y});
}
/// Its coefficients, in a series that holds those of another expansion: what is not yet known must not be used.
std::vector<L> by_tape(const Tape<L>& tape) {
  TaylorSeries<L> series;
  series.resize(tape, order);
  for (const L start : {0.125L, 0.0L}) {
    series.of(0)[0] = start;
    EXPECT_TRUE(series.solve(tape, order, 1.0L));
    for (std::size_t i = tape.inputs; i < tape.nodes.size(); ++i) series.extend(tape, static_cast<int>(i), order);
  }
  const L* const y = series.of(tape.outputs[1]);
  return {y, y + order + 1};
}

struct Case {
  std::string name;
  std::function<T(const T&)> traced;
  std::function<C(C)> exact;
};
std::vector<Case> cases() {
  return {
      {"product", [](const T& x) { return x * (x + 2) * (x - 1); }, [](C x) { return x * (x + 2.0L) * (x - 1.0L); }},
      {"square", [](const T& x) { return x * x; }, [](C x) { return x * x; }},
      {"cube", [](const T& x) { return pow(x, 3); }, [](C x) { return x * x * x; }},
      {"quotient", [](const T& x) { return (x + 1) / (2 - x); }, [](C x) { return (x + 1.0L) / (2.0L - x); }},
      {"divided by a constant", [](const T& x) { return -x / 7; }, [](C x) { return -x / 7.0L; }},
      {"inverse", [](const T& x) { return 3 / x; }, [](C x) { return 3.0L / x; }},
      {"sqrt", [](const T& x) { return sqrt(x); }, [](C x) { return std::sqrt(x); }},
      {"exp", [](const T& x) { return exp(x); }, [](C x) { return std::exp(x); }},
      {"log", [](const T& x) { return log(x); }, [](C x) { return std::log(x); }},
      {"sin", [](const T& x) { return sin(x); }, [](C x) { return std::sin(x); }},
      {"cos", [](const T& x) { return cos(x); }, [](C x) { return std::cos(x); }},
      {"tan", [](const T& x) { return tan(x); }, [](C x) { return std::tan(x); }},
      {"atan", [](const T& x) { return atan(x); }, [](C x) { return std::atan(x); }},
      {"sinh", [](const T& x) { return sinh(x); }, [](C x) { return std::sinh(x); }},
      {"cosh", [](const T& x) { return cosh(x); }, [](C x) { return std::cosh(x); }},
      {"tanh", [](const T& x) { return tanh(x); }, [](C x) { return std::tanh(x); }},
      {"pow", [](const T& x) { return pow(x, -1.7L); }, [](C x) { return std::pow(x, -1.7L); }},
      {"pow, negative and whole", [](const T& x) { return pow(x, -3); }, [](C x) { return 1.0L / (x * x * x); }},
      {"pow, half", [](const T& x) { return pow(x, 0.5L); }, [](C x) { return std::sqrt(x); }},
      {"nested", [](const T& x) { return exp(sin(x) * cos(x)) / sqrt(1 + x * x); },
       [](C x) { return std::exp(std::sin(x) * std::cos(x)) / std::sqrt(1.0L + x * x); }},
  };
}
/// The largest error of a coefficient, in units of the largest term of the series on |t| = radius. There every f of the
/// list is analytic: its singularity next to t = 0 is x = 0, at t = -0.78.
L error_of(const Tape<L>& tape, const std::function<C(C)>& exact) {
  constexpr L radius = 0.25L;  // (0.25/0.78)^64 = 1e-31: no alias
  const auto expected = by_cauchy([&](C t) { return exact(0.6L + t + 0.3L * t * t); }, radius);
  const auto got = by_tape(tape);
  L most = 0;
  L size = 0;
  for (std::size_t k = 0; k <= order; ++k) {
    const L weight = std::pow(radius, static_cast<L>(k));
    const L error = std::fabs(got[k] - expected[k]) * weight;
    if (!(error <= most)) most = error;
    size = std::max(size, std::fabs(expected[k]) * weight);
  }
  return most / size;
}
// Sums of at most 64 terms with their rounding.
constexpr L bound = 64 * test::long_epsilon;

TEST(TaylorSeries, recurrences_agree_with_cauchy) {
  for (const Case& c : cases()) EXPECT_LE(error_of(tape_of(c.traced), c.exact), bound) << c.name;
}

TEST(TaylorSeries, broken_recurrences_are_caught) {
  struct Mutant {
    Operation broken, as;
  };
  const Mutant mutants[] = {{Operation::sin, Operation::sinh},
                            {Operation::cos, Operation::cosh},
                            {Operation::sinh, Operation::sin},
                            {Operation::cosh, Operation::cos},
                            {Operation::tan, Operation::tanh},
                            {Operation::tanh, Operation::tan},
                            {Operation::atan, Operation::tanh},
                            {Operation::power_constant, Operation::scale},
                            {Operation::multiply, Operation::add},
                            {Operation::divide, Operation::multiply},
                            {Operation::square, Operation::negate},
                            {Operation::exp, Operation::log},
                            {Operation::log, Operation::exp},
                            {Operation::sqrt, Operation::square},
                            {Operation::invert, Operation::scale},
                            {Operation::scale, Operation::divide_constant},
                            {Operation::divide_constant, Operation::scale}};
  for (const Mutant& mutant : mutants) {
    bool met = false;
    for (const Case& c : cases()) {
      Tape<L> tape = tape_of(c.traced);
      bool changed = false;
      for (std::size_t i = 3; i < tape.nodes.size(); ++i) {
        if (tape.nodes[i].operation != mutant.broken) continue;
        tape.nodes[i].operation = mutant.as;
        changed = true;
      }
      if (!changed) continue;
      met = true;
      EXPECT_GT(error_of(tape, c.exact), 1000 * bound) << c.name;
    }
    EXPECT_TRUE(met || mutant.broken == Operation::scale) << static_cast<int>(mutant.broken);
  }
  Tape<L> tape = tape_of([](const T& x) { return pow(x, -1.7L); });
  for (L& c : tape.constants) c = c < 0 ? c + 1e-12L : c;
  EXPECT_GT(error_of(tape, [](C x) { return std::pow(x, -1.7L); }), 1000 * bound) << "exponent";
}

TEST(TaylorSeries, solves_the_exponential_to_rounding) {
  Recorder<L> recorder;
  const T x = recorder.input(1);
  const Tape<L> tape = recorder.finish({x});
  TaylorSeries<L> series;
  series.resize(tape, 20);
  series.of(0)[0] = 1;
  ASSERT_TRUE(series.solve(tape, 20, 1.0L));
  L factorial = 1;
  for (int k = 1; k <= 20; ++k) {
    factorial *= k;
    EXPECT_TRUE(test::same_to_rounding(series.of(0)[k], 1 / factorial, 20.0L)) << k;  // k divisions
  }
}

TEST(Tape, folds_constants_shares_what_is_equal_and_drops_what_is_unused) {
  Recorder<double> recorder;
  const Trace<double> x = recorder.input(2);
  const Trace<double> unused = exp(x) * 3;
  const Trace<double> y = sin(x) * (x * x) + (0 * x) + cos(x) * (x * x) * 1.0 + sqrt(Trace<double>(4));
  const Tape<double> tape = recorder.finish({y});
  EXPECT_EQ(unused.node, 2);
  // x, sin, cos, x^2, two products, their sum, + 2.
  EXPECT_EQ(tape.nodes.size(), 8u);
  EXPECT_EQ(tape.constants.size(), 2u) << "3, which nobody uses any more, and 2";
}

TEST(Tape, refuses_branches_on_the_state) {
  Recorder<double> recorder;
  const Trace<double> x = recorder.input(2);
  const std::string message = test::message_of<Error>([&] { (void)abs(x); });
  EXPECT_NE(message.find("branches that depend on the state"), std::string::npos) << message;
  EXPECT_THROW((void)(x < 1.0), Error);
  EXPECT_THROW((void)(1.0 >= x), Error);
  EXPECT_THROW((void)larger(x, x * x), Error);
  EXPECT_TRUE(abs(Trace<double>(-3)) > Trace<double>(2)) << "constants compare";
}

TEST(Tape, guards_tests_for_equality) {
  Recorder<double> recorder;
  const Trace<double> x = recorder.input(0);
  const Trace<double> y = x == 0.0 ? x : 1 / x;
  const Tape<double> tape = recorder.finish({y});
  TaylorSeries<double> series;
  series.resize(tape, 3);
  series.of(0)[0] = 0;
  EXPECT_TRUE(series.solve(tape, 3, 1.0));
  series.of(0)[0] = 0.5;
  EXPECT_FALSE(series.solve(tape, 3, 1.0)) << "1/x would be the branch";
}

}  // namespace
}  // namespace hamflow
