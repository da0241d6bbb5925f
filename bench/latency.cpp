#include "latency.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace bench {

namespace {

/// Measures the nanoseconds of applying f to its own result: the best of a few short runs.
template <class F>
double chained(F&& f) {
  constexpr int length = 20000;
  volatile double source = 1.2345678901234567;  // hides the value from the compiler
  double best = 1e9;
  for (int run = 0; run < 5; ++run) {
    const double a = source;
    double x = a;
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < length; ++i) x = f(x, a);
    const auto end = std::chrono::steady_clock::now();
    source = 1.2 + 0.01 * std::fmod(std::fabs(x), 1.0);  // uses the result, so that the loop is not removed
    best = std::min(best, std::chrono::duration<double, std::nano>(end - begin).count() / length);
  }
  return best;
}

}  // namespace

Latencies measure_latencies() {
  Latencies l;
  // The factors use all bits, because some dividers finish early on short numbers. Several operations in a row make the
  // cost of the loop negligible.
  l.multiplication = chained([](double x, double a) { return (((x * a) * 0.81) * a) * 0.81; }) / 4;
  // An addition is measured after a multiplication, as it occurs in the chains. On some machines an addition after an
  // addition is faster.
  l.addition = chained([](double x, double a) { return ((x * a - 0.7) * 0.5) + a; }) / 2 - l.multiplication;
  l.division = chained([](double x, double a) { return a / (1.1 / (a / (1.3 / x))); }) / 4;
  l.square_root = chained([](double x, double a) { return std::sqrt(std::sqrt(x * a) * a); }) / 2 - l.multiplication;
  return l;
}

}  // namespace bench
