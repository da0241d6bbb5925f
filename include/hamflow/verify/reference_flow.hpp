// The exact flow to rounding, by a family of its own: Gragg's modified midpoint rule extrapolated in h^2
// (Aitken-Neville), with step control. Slow and accurate; it knows nothing of the methods it judges.   [Hairer,
// Norsett, Wanner 1993, II.9]
#pragma once

#include <limits>
#include <vector>

#include "hamflow/core/derivatives.hpp"

namespace hamflow {

namespace detail {

template <class P, std::size_t N = P::dimension>
class Extrapolation {
 public:
  using R = typename P::Real;
  using Z = Vector<R, 2 * N>;
  explicit Extrapolation(const P& problem) : problem_(problem) {}

  /// z(t) from z(0).
  Z flow(Z z, R t) const {
    R done(0);
    R step = t;
    const R limit = R(1) / R(8);
    while (abs(done) < abs(t)) {
      if (abs(step) > limit) step = t < R(0) ? -limit : limit;
      if (abs(done + step) > abs(t)) step = t - done;
      Z next{};
      while (!try_step(z, step, next)) step = step / R(2);
      z = next;
      done += step;
      step = step * R(2);
    }
    return z;
  }

 private:
  static constexpr int columns = 14;

  Z derivative(const Z& z) const {
    Vector<R, N> q{};
    Vector<R, N> p{};
    Vector<R, N> dq{};
    Vector<R, N> dp{};
    for (std::size_t i = 0; i < N; ++i) {
      q[i] = z[i];
      p[i] = z[N + i];
    }
    gradient(problem_, q, p, dq, dp);
    Z out{};
    for (std::size_t i = 0; i < N; ++i) {
      out[i] = dp[i];
      out[N + i] = -dq[i];
    }
    return out;
  }
  static Z combine(const Z& z, R factor, const Z& direction) {
    Z out = z;
    for (std::size_t i = 0; i < 2 * N; ++i) out[i] += factor * direction[i];
    return out;
  }
  Z modified_midpoint(const Z& z, R step, int parts) const {
    const R h = step / R(parts);
    Z before = z;
    Z now = combine(z, h, derivative(z));
    for (int k = 1; k < parts; ++k) {
      const Z after = combine(before, R(2) * h, derivative(now));
      before = now;
      now = after;
    }
    const Z last = combine(before, h, derivative(now));
    Z mean{};
    for (std::size_t i = 0; i < 2 * N; ++i) mean[i] = (now[i] + last[i]) / R(2);
    return mean;
  }
  /// True when two neighbours of the extrapolation table agree to rounding.
  bool try_step(const Z& z, R step, Z& out) const {
    std::vector<Z> row;
    for (int j = 0; j < columns; ++j) {
      std::vector<Z> next{modified_midpoint(z, step, 2 * (j + 1))};
      for (int k = 1; k <= j; ++k) {
        const R ratio = R(j + 1) / R(j + 1 - k);
        const R divisor = ratio * ratio - R(1);
        Z better = next.back();
        for (std::size_t i = 0; i < 2 * N; ++i)
          better[i] += (next.back()[i] - row[static_cast<std::size_t>(k - 1)][i]) / divisor;
        next.push_back(better);
      }
      if (j >= 4) {
        R difference(0);
        R size(0);
        for (std::size_t i = 0; i < 2 * N; ++i) {
          difference = larger(difference, R(abs(next.back()[i] - row.back()[i])));
          size = larger(size, R(abs(next.back()[i])));
        }
        if (difference <= R(4) * std::numeric_limits<R>::epsilon() * size) {
          out = next.back();
          return true;
        }
      }
      row = std::move(next);
    }
    return false;
  }

  const P& problem_;
};

}  // namespace detail

/// z(t) for z = (q, p), to a few units of rounding per unit of time.
template <class P>
Vector<typename P::Real, 2 * P::dimension> reference_flow(const P& problem,
                                                          const Vector<typename P::Real, 2 * P::dimension>& z,
                                                          typename P::Real t) {
  return detail::Extrapolation<P>(problem).flow(z, t);
}

}  // namespace hamflow
