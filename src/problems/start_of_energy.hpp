// A start of given energy: one component of p or v is open, and is the largest or the smallest x with H(q, p(x)) = E.
// If H is at most quadratic in x, as for mechanical systems, this is a quadratic equation, solved in the arithmetic of
// the run. Otherwise a search in double finds the outermost zero, which is then refined.
#pragma once

#include <functional>
#include <vector>

#include "hamflow/core/derivatives.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// H as a function of the open component x. The search uses only this interface, so that it is compiled once for each
/// number type.
template <class R>
struct EnergyLine {
  std::function<R(const R& x)> energy;
  std::function<R(const R& x)> slope;      // dH/dx
  std::function<R(const R& x)> curvature;  // d^2H/dx^2, from H_pp
  bool is_parabola;                        // H is known to be quadratic in x
  std::vector<R> q;                        // does not depend on x
};

/// The open component; soft walls of the request are a term of H.
/// @param line of the problem without walls @throws NoStart if no value has that energy
template <class R>
R component_for_energy(const EnergyLine<R>& line, const Request& request);

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

}  // namespace detail

/// @param at the start with a value for the open component; q and p are linear in it. Called as long as the line
/// exists.
template <class P, class At, class R = typename P::Real>
EnergyLine<R> energy_line(const P& problem, const At& at) {
  const auto base = at(R(0));
  auto direction = at(R(1)).p;
  for (std::size_t i = 0; i < direction.size(); ++i) direction[i] -= base.p[i];
  EnergyLine<R> line;
  line.energy = [&problem, &at](const R& x) {
    const auto state = at(x);
    return R(energy(problem, state.q, state.p));
  };
  line.slope = [&problem, &at, direction](const R& x) {
    const auto state = at(x);
    auto force = state.p;
    auto rate = state.p;
    gradient(problem, state.q, state.p, force, rate);
    return detail::dot_product(direction, rate);
  };
  line.curvature = [&problem, &at, direction](const R& x) {
    return detail::curvature_along(problem, at(x), direction);
  };
  line.is_parabola = QuadraticKinetic<P>;
  line.q.assign(base.q.begin(), base.q.end());
  return line;
}

}  // namespace hamflow
