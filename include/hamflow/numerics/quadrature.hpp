// Double exponential quadrature to rounding, for integrands that are analytic inside the interval; at its ends they may
// be singular as long as they are integrable.   [TakahasiMori1974]   In long double, by Boost.Math, whose headers stay
// in src/numerics/quadrature.cpp.
#pragma once

#include <functional>

namespace hamflow {

/// An integral and an estimate of its error.
struct Integral {
  long double value = 0;
  long double error = 0;
};

/// The integral of f over an interval of the given length, not negative. f(from_left, to_right) gets the distances to
/// both ends, each to full relative precision: what vanishes or is singular at an end is written with its distance. A
/// value that is not finite counts as nothing (a point may fall on the end when f adds the distance to something).
Integral integrate_from_ends(const std::function<long double(long double, long double)>& f, long double length);

/// The integral of f(x) from a to b.
Integral integrate(const std::function<long double(long double)>& f, long double a, long double b);

}  // namespace hamflow
