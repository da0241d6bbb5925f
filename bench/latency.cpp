#include "latency.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace bench {

namespace {

/// Nanoseconds per application of f to its own result; the best of a few short runs.
template <class F>
double chained(F&& f) {
  constexpr int length = 20000;
  volatile double source = 1.2345678901234567;  // not known to the compiler
  double best = 1e9;
  for (int run = 0; run < 5; ++run) {
    const double a = source;
    double x = a;
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < length; ++i) x = f(x, a);
    const auto end = std::chrono::steady_clock::now();
    source = 1.2 + 0.01 * std::fmod(std::fabs(x), 1.0);  // the chain is used
    best = std::min(best, std::chrono::duration<double, std::nano>(end - begin).count() / length);
  }
  return best;
}

}  // namespace

Latencies measure_latencies() {
  Latencies l;
  // Values without short digits: some dividers finish early on them. Several in a row make the loop itself negligible.
  l.multiplication = chained([](double x, double a) { return (((x * a) * 0.81) * a) * 0.81; }) / 4;
  // Behind a multiplication, where additions stand in our chains: some machines hand on from adder to adder faster.
  l.addition = chained([](double x, double a) { return ((x * a - 0.7) * 0.5) + a; }) / 2 - l.multiplication;
  l.division = chained([](double x, double a) { return a / (1.1 / (a / (1.3 / x))); }) / 4;
  l.square_root = chained([](double x, double a) { return std::sqrt(std::sqrt(x * a) * a); }) / 2 - l.multiplication;
  return l;
}

}  // namespace bench
