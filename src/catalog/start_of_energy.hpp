// A start of given energy: one component of p, or of v, is left open, and is the largest or the smallest x with
// H(q, p(x)) = E. Where H is at most quadratic in x, as with every mechanical system, that is a quadratic equation,
// solved in the arithmetic of the run; else the outermost zero is found in double and refined.
#pragma once

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
  bool quadratic = a == a && abs(a) > R(0);
  if constexpr (!QuadraticKinetic<P>) {
    const R reach = R(1) + (root ? R(2) * abs(*root) : R(0));
    for (const R& x : {reach, -reach}) {
      const R there = detail::curvature_along(problem, at(x), direction) / R(2);
      quadratic = quadratic && abs(there - a) <= R(1000) * epsilon * abs(a);
    }
  }
  const std::string open = detail::name_of_open(spec);
  if (quadratic) {
    if (root) return *root;
    const R extreme = at_base - b * b / (R(4) * a);
    throw NoStart("no " + open + " has it: along " + open + " H is at " + (a > R(0) ? "least " : "most ") +
                  shortest(static_cast<double>(extreme)));
  }
  const auto above = [&](double x) { return static_cast<double>(energy_of(R(x)) - level); };
  if (const auto near = outer_root(above, largest)) {
    const R x = refined_root<R>([&](const R& y) { return energy_of(y) - level; }, *near);
    const R found = energy_of(x);
    const R slack = R(64) * epsilon * (abs(found) + abs(level) + abs(at_base));
    const R reached = abs(energy_of(x + R(64) * epsilon * abs(x)) - found);
    if (abs(found - level) <= slack + reached) return x;
  }
  throw NoStart("no " + open + " has it: H - energy has no zero along " + open);
}

}  // namespace hamflow
