#include "hamflow/numerics/root.hpp"

#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace hamflow {

namespace {

template <class R>
R found_between(const std::function<R(R)>& f, R a, R b, R at_a, R at_b) {
  constexpr R epsilon = std::numeric_limits<R>::epsilon();
  if (b < a) {
    std::swap(a, b);
    std::swap(at_a, at_b);
  }
  if (at_a == 0) return a;
  if (at_b == 0) return b;
  if (std::isfinite(at_a) && std::isfinite(at_b) && (at_a > 0) == (at_b > 0)) {
    return std::numeric_limits<R>::quiet_NaN();  // rounding hides the zero
  }
  R best = a + (b - a) / 2;
  R least = std::numeric_limits<R>::infinity();
  const auto watched = [&](R x) {
    const R value = f(x);
    if (std::abs(value) < least) {
      least = std::abs(value);
      best = x;
    }
    return value;
  };
  // Bisection until the values at both ends are known and the ends have a similar size: secants over many powers of ten
  // do not converge.
  const bool rising = at_a < at_b;
  while (least > 0 && !(std::isfinite(at_a) && std::isfinite(at_b) && (a <= 0 || b <= 4 * a))) {
    const R x = a > 0 && b > 4 * a ? std::sqrt(a) * std::sqrt(b) : a + (b - a) / 2;
    if (!(a < x && x < b)) return best;
    const R value = watched(x);
    const bool above = (value > 0) == rising;  // whether x is above the zero; NaN counts as not positive
    (above ? b : a) = x;
    (above ? at_b : at_a) = value;
    if (b - a <= 2 * epsilon * std::abs(a)) return best;
  }
  if (least == 0) return best;
  std::uintmax_t passes = 400;
  (void)boost::math::tools::toms748_solve(
      watched, a, b, at_a, at_b, [](R left, R right) { return right - left <= 2 * epsilon * std::abs(left); }, passes);
  return best;
}

}  // namespace

double bracketed_root(const std::function<double(double)>& f, double a, double b, double at_a, double at_b) {
  return found_between<double>(f, a, b, at_a, at_b);
}
long double bracketed_root(const std::function<long double(long double)>& f, long double a, long double b,
                           long double at_a, long double at_b) {
  return found_between<long double>(f, a, b, at_a, at_b);
}

}  // namespace hamflow
