// A start of given energy: one component of p, or of v, is left open, and is the largest or the smallest x with
// H(q, p(x)) = E. Where H is at most quadratic in x, as with every mechanical system, that is a quadratic equation,
// solved in the arithmetic of the run; else the outermost zero that a search finds in double is refined.
#pragma once

#include <cmath>
#include <optional>

#include "hamflow/core/derivatives.hpp"
#include "hamflow/numerics/outer_root.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow {

namespace detail {

template <class R, std::size_t N>
R dot_product(const Vector<R, N>& x, const Vector<R, N>& y) {
  R sum(0);
  for (std::size_t i = 0; i < x.size(); ++i) sum += x[i] * y[i];
  return sum;
}

template <class R>
bool is_finite(const R& x) {
  return x - x == R(0);
}

/// d^T H_pp d at a state.
template <class P, class R, std::size_t N>
R curvature_along(const P& problem, const Start<R, N>& at, const Vector<R, N>& d) {
  Matrix<R, N> pp = zero_matrix(d);
  if constexpr (QuadraticKinetic<P>) {
    pp = inverse_mass_matrix(problem);
  } else {
    Matrix<R, N> qq = pp;
    Matrix<R, N> qp = pp;
    hessian(problem, at.q, at.p, qq, qp, pp);
  }
  return dot_product(d, apply(pp, d));
}

/// Whether H(x) = c + b x + a x^2 to rounding, at 16 points of each power of 2 from 2^-20 to 2^20, of both signs: what
/// a smooth H has between them shows in the last digits far around.
template <class R, class EnergyOf>
bool is_parabola(const EnergyOf& energy_of, const R& c, const R& b, const R& a) {
  const R tolerance = R(10000) * std::numeric_limits<R>::epsilon();
  for (int i = -20 * 16; i <= 20 * 16; ++i) {
    const R magnitude(std::exp2(static_cast<double>(i) / 16));
    for (const R& x : {magnitude, R(-magnitude)}) {
      const R linear = b * x;
      const R square = a * x * x;
      const R off = abs(energy_of(x) - c - linear - square);
      if (!(off <= tolerance * (abs(c) + abs(linear) + abs(square)))) return false;
    }
  }
  return true;
}

/// "p[0]".
inline std::string name_of_open(const StartSpec& spec) {
  const std::vector<std::string>& given = spec.v.empty() ? spec.p : spec.v;
  const auto at = std::find_if(given.begin(), given.end(), is_left_to_energy);
  return std::string(spec.v.empty() ? "p" : "v") + "[" + std::to_string(at - given.begin()) + "]";
}

}  // namespace detail

/// The component that a start leaves to the energy.
/// @param at the start with a value for that component; q and p are linear in it
/// @throws NoStart when no value has that energy
template <class P, class At, class R = typename P::Real>
R left_to_energy(const P& problem, const At& at, const StartSpec& spec) {
  const std::vector<std::string>& given = spec.v.empty() ? spec.p : spec.v;
  const bool largest = std::find(given.begin(), given.end(), largest_root) != given.end();
  const R level = evaluate_number<R>(spec.energy);
  const auto base = at(R(0));
  auto direction = at(R(1)).p;
  for (std::size_t i = 0; i < direction.size(); ++i) direction[i] -= base.p[i];
  const auto energy_of = [&](const R& x) {
    const auto state = at(x);
    return R(energy(problem, state.q, state.p));
  };

  // H = H(0) + b x + a x^2, where that holds.
  auto force_at_base = base.p;
  auto rates = base.p;
  gradient(problem, base.q, base.p, force_at_base, rates);
  const R a = detail::curvature_along(problem, base, direction) / R(2);
  const R b = detail::dot_product(direction, rates);
  const R at_base = energy_of(R(0));
  const R epsilon = std::numeric_limits<R>::epsilon();
  const R noise = R(8) * epsilon * (abs(at_base) + abs(level));
  const auto root = quadratic_root<R>(a, b, at_base - level, noise, largest);
  bool quadratic = detail::is_finite(a) && detail::is_finite(b) && detail::is_finite(at_base) && abs(a) > R(0);
  if constexpr (!QuadraticKinetic<P>) {
    const R reach = R(1) + (root ? R(2) * abs(*root) : R(0));
    for (const R& x : {reach, -reach}) {
      if (!quadratic) break;
      const R there = detail::curvature_along(problem, at(x), direction) / R(2);
      quadratic = abs(there - a) <= R(1000) * epsilon * abs(a);
    }
    quadratic = quadratic && detail::is_parabola<R>(energy_of, at_base, b, a);
  }
  const std::string open = detail::name_of_open(spec);
  if (quadratic) {
    if (root) return *root;
    const R extreme = at_base - b * b / (R(4) * a);
    throw NoStart("no " + open + " has it: along " + open + " H is at " + (a > R(0) ? "least " : "most ") +
                  shortest(static_cast<double>(extreme)));
  }
  // H(x) is the energy to the rounding of x and of the terms of H, which are as large as H is between 0 and x. The
  // rounding of a large x alone excuses no more than a million roundings of H.
  const auto has_energy = [&](const R& x) {
    const auto state = at(x);
    const R found = energy(problem, state.q, state.p);
    R size = abs(found) + abs(level);
    for (const R& part : {R(0), R(0.25), R(0.5), R(0.75)}) {
      const R there = abs(energy_of(part * x));
      if (detail::is_finite(there) && there > size) size = there;
    }
    auto force = state.p;
    auto rate = state.p;
    gradient(problem, state.q, state.p, force, rate);
    const R slack = R(64) * epsilon * size + R(4) * epsilon * abs(x * detail::dot_product(direction, rate));
    const R most = R(1e6) * epsilon * size;
    return abs(found - level) <= (slack < most ? slack : most);
  };
  const auto above = [&](double x) { return static_cast<double>(energy_of(R(x)) - level); };
  const auto refined = [&](double x) { return refined_root<R>([&](const R& y) { return energy_of(y) - level; }, x); };
  const OuterRoot outer = outer_root(above, largest, [&](double x) { return has_energy(refined(x)); });
  if (!outer.told) {
    throw NoStart(std::string("no ") + (largest ? "largest" : "smallest") + " root along " + open +
                  " can be told: H oscillates, or stays at the energy, as far as it is looked at; give " + open +
                  " as a number");
  }
  if (outer.x) {
    const R x = refined(*outer.x);
    if (has_energy(x)) return x;
  }
  throw NoStart("no " + open + " is found to have it: H - energy has no zero along " + open + " among |" + open +
                "| up to 2^100, but for dips between the points of the search");
}

}  // namespace hamflow
