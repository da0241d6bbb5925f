// Forces along the lines between bodies, or to a centre, as functions of the square of the distance.
#pragma once

#include <vector>

#include "hamflow/core/concepts.hpp"

namespace hamflow {

/// One term strength * phi(u) of V, u = |x_a - x_b|^2, or u = |x_a|^2 about the centre.
template <class R>
struct RadialTerm {
  static constexpr std::size_t centre = static_cast<std::size_t>(-1);
  std::size_t a = 0;       // index of the first coordinate of one body
  std::size_t b = centre;  // and of the other, or the centre
  R strength{};
};

/// phi and its derivatives with respect to u.
template <class S>
struct RadialLaw {
  S value{};
  S first{};
  S second{};
};

/// **RadialForces**: T = sum |p_i|^2/(2 m_i) with one constant mass for each body, V = sum over terms of one law
/// phi(u). radial_space() is the number of coordinates of a body, radial_terms() the terms, radial_law(u) the law, a
/// template over the number type.
template <class P>
concept RadialForces = QuadraticKinetic<P> && requires(const P& problem, const RealOf<P>& u) {
  { problem.radial_space() } -> std::convertible_to<std::size_t>;
  { problem.radial_terms() } -> std::same_as<std::vector<RadialTerm<RealOf<P>>>>;
  { problem.radial_law(u) } -> std::same_as<RadialLaw<RealOf<P>>>;
};

}  // namespace hamflow
