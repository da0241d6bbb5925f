// Double exponential quadrature to rounding, for integrands that are analytic inside the interval; integrable
// singularities at the ends are allowed.   [TakahasiMori1974] In long double, by Boost.Math, whose headers stay in
// src/numerics/quadrature.cpp.
#pragma once

#include <functional>

namespace hamflow {

/// An integral and an estimate of its error.
struct Integral {
  long double value = 0;
  long double error = 0;
};

/// The integral of f over an interval of the given length, not negative. f(from_left, to_right) receives the distances
/// to both ends, each with full relative precision, for functions that vanish or are singular at an end. A value that
/// is not finite counts as 0 (a point may coincide with the end if f adds the distance to a number).
Integral integrate_from_ends(const std::function<long double(long double, long double)>& f, long double length);

/// The integral of f(x) from a to b.
Integral integrate(const std::function<long double(long double)>& f, long double a, long double b);

}  // namespace hamflow
