#include "hamflow/numerics/quadrature.hpp"

#include <boost/math/quadrature/tanh_sinh.hpp>
#include <cmath>
#include <limits>

namespace hamflow {

Integral integrate_from_ends(const std::function<long double(long double, long double)>& f, long double length) {
  using L = long double;
  if (!(length > 0)) return {};
  // The error is about the square of the last change, but at least its power 1.3 if the integrand turns close to an
  // end, as on a narrow orbit; so it is below rounding once the change is epsilon^0.75. At most eight refinements,
  // because an integrand with noise never gets there.
  static boost::math::quadrature::tanh_sinh<L> rule(8);  // may be used by several threads
  static const L accepted = std::pow(std::numeric_limits<L>::epsilon(), 0.75L);
  L change = 0;
  L size = 0;
  // The second argument is the distance to the nearer end, negative at the left one.
  const L value = rule.integrate(
      [&](L, L to_end) {
        const L near = std::abs(to_end);
        const L far = length - near;
        const L found = to_end < 0 ? f(near, far) : f(far, near);
        return std::isfinite(found) ? found : L(0);
      },
      L(0), length, accepted, &change, &size);
  change *= length / 2;  // of the interval from -1 to 1
  const bool converged = change <= accepted * size;
  return {value, converged && size > 0 ? change * change / size + std::numeric_limits<L>::epsilon() * size : change};
}

Integral integrate(const std::function<long double(long double)>& f, long double a, long double b) {
  const long double sign = a < b ? 1 : -1;
  Integral found = integrate_from_ends(
      [&](long double from_left, long double to_right) {
        return f(from_left < to_right ? a + sign * from_left : b - sign * to_right);
      },
      std::abs(b - a));
  found.value *= sign;
  return found;
}

}  // namespace hamflow
