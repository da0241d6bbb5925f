// The zero of a function between two points, by algorithm 748 of the ACM.   [AlefeldPotraShi1995]   By Boost.Math,
// whose headers stay in src/numerics/root.cpp.
#pragma once

#include <functional>

namespace hamflow {

/// The x between a and b at which f changes its sign, to rounding of x: among the points at which f was evaluated the
/// one with the smallest |f|. Positive a and b may differ by large factors; bisection then uses a logarithmic scale.
/// @param at_a, at_b f(a) and f(b), of opposite signs, or 0: the zero is then that end. Pass an infinity if only the
/// sign is known; f is evaluated neither at a nor at b.
double bracketed_root(const std::function<double(double)>& f, double a, double b, double at_a, double at_b);
long double bracketed_root(const std::function<long double(long double)>& f, long double a, long double b,
                           long double at_a, long double at_b);

}  // namespace hamflow
