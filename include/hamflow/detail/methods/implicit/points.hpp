// The functions of a problem at several points at once. Entry a of point l is at [a * point_stride + l]: the numbers of
// neighbouring points are contiguous, so that sums over points run over contiguous numbers and several points can be
// evaluated in one vector register. A problem behind virtual calls is called once for all points.
#pragma once

#include <algorithm>

#include "hamflow/core/derivatives.hpp"

namespace hamflow {

/// The largest number of points evaluated at once; more points are divided into blocks.
inline constexpr std::size_t point_stride = 8;

namespace detail {
template <class S, std::size_t N>
void take_point(const S* x, std::size_t l, Vector<S, N>& y) {
  for (std::size_t a = 0; a < y.size(); ++a) y[a] = x[a * point_stride + l];
}
template <class S, std::size_t N>
void put_point(const Vector<S, N>& y, std::size_t l, S* x) {
  for (std::size_t a = 0; a < y.size(); ++a) x[a * point_stride + l] = y[a];
}
template <class S, std::size_t N>
void put_point(const Matrix<S, N>& y, std::size_t l, S* x) {
  for (std::size_t a = 0; a < y.size(); ++a) {
    for (std::size_t b = 0; b < y.size(); ++b) x[(a * y.size() + b) * point_stride + l] = y[a][b];
  }
}
}  // namespace detail

/// f = -dV/dq at `count` points.
template <class P, class S>
void forces_at(const P& problem, std::size_t count, const S* q, S* f) {
  if constexpr (requires { problem.forces_at(count, q, f); }) {
    problem.forces_at(count, q, f);
  } else {
    auto x = zeros<S, P::dimension>(degrees_of_freedom(problem));
    auto y = x;
    for (std::size_t l = 0; l < count; ++l) {
      detail::take_point(q, l, x);
      force(problem, x, y);
      detail::put_point(y, l, f);
    }
  }
}

/// Evaluates forces and V''. Its entry (a, b) is entry a * size + b.
template <class P, class S>
void forces_and_hessians_at(const P& problem, std::size_t count, const S* q, S* f, S* h) {
  if constexpr (requires { problem.forces_and_hessians_at(count, q, f, h); }) {
    problem.forces_and_hessians_at(count, q, f, h);
  } else {
    auto x = zeros<S, P::dimension>(degrees_of_freedom(problem));
    auto y = x;
    auto second = zero_matrix(x);
    for (std::size_t l = 0; l < count; ++l) {
      detail::take_point(q, l, x);
      force_and_hessian(problem, x, y, second);
      detail::put_point(y, l, f);
      detail::put_point(second, l, h);
    }
  }
}

/// dH/dq and dH/dp.
template <class P, class S>
void gradients_at(const P& problem, std::size_t count, const S* q, const S* p, S* dq, S* dp) {
  if constexpr (requires { problem.gradients_at(count, q, p, dq, dp); }) {
    problem.gradients_at(count, q, p, dq, dp);
  } else {
    auto x = zeros<S, P::dimension>(degrees_of_freedom(problem));
    auto y = x;
    auto by_x = x;
    auto by_y = x;
    for (std::size_t l = 0; l < count; ++l) {
      detail::take_point(q, l, x);
      detail::take_point(p, l, y);
      gradient(problem, x, y, by_x, by_y);
      detail::put_point(by_x, l, dq);
      detail::put_point(by_y, l, dp);
    }
  }
}

/// All second derivatives of H, in the layout of V''.
template <class P, class S>
void hessians_at(const P& problem, std::size_t count, const S* q, const S* p, S* qq, S* qp, S* pp) {
  if constexpr (requires { problem.hessians_at(count, q, p, qq, qp, pp); }) {
    problem.hessians_at(count, q, p, qq, qp, pp);
  } else {
    auto x = zeros<S, P::dimension>(degrees_of_freedom(problem));
    auto y = x;
    auto by_xx = zero_matrix(x);
    auto by_xy = by_xx;
    auto by_yy = by_xx;
    for (std::size_t l = 0; l < count; ++l) {
      detail::take_point(q, l, x);
      detail::take_point(p, l, y);
      hessian(problem, x, y, by_xx, by_xy, by_yy);
      detail::put_point(by_xx, l, qq);
      detail::put_point(by_xy, l, qp);
      detail::put_point(by_yy, l, pp);
    }
  }
}

/// `rows` rows of numbers, each for a block of points; stored in place if their number is known at compile time.
/// @tparam N the number, or `dynamic`
template <class S, std::size_t N>
using PointRows = Vector<S, N == dynamic ? dynamic : N * point_stride>;
template <class S, std::size_t N>
PointRows<S, N> point_rows(std::size_t rows) {
  if constexpr (N == dynamic) {
    return PointRows<S, N>(rows * point_stride);
  } else {
    return PointRows<S, N>{};
  }
}

/// Calls body(first, count) for blocks of points.
template <class Body>
void for_blocks(std::size_t points, const Body& body) {
  for (std::size_t first = 0; first < points; first += point_stride) {
    body(first, std::min(point_stride, points - first));
  }
}

}  // namespace hamflow
