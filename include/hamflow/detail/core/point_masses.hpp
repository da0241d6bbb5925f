// Bodies that attract each other as points.
#pragma once

#include <vector>

#include "hamflow/core/concepts.hpp"

namespace hamflow {

/// Masses in the order of q; 0: a massless body, whose momentum is its velocity.
template <class R>
struct PointMasses {
  std::size_t space = 3;
  std::vector<R> masses{};
  R gravitational_constant{};
  R softening_squared{};
};

/// **GravitatingBodies**: T = sum |p_i|^2/(2 m_i), V = -G sum m_i m_j/sqrt(r_ij^2 + softening^2), with these masses.
template <class P>
concept GravitatingBodies = QuadraticKinetic<P> && requires(const P& problem) {
  { problem.point_masses() } -> std::same_as<PointMasses<base_scalar<RealOf<P>>>>;
};

}  // namespace hamflow
