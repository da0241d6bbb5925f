// The exact flow to rounding, by an independent method: Gragg's modified midpoint rule extrapolated in h^2
// (Aitken-Neville), with step control. It is slow and accurate, and independent of the methods that it
// tests.   [HNW1993, II.9] It extrapolates the increment of a step instead of the state, so that rounding is relative
// to the increment, which is added to the state with compensation.
#pragma once

#include <limits>
#include <vector>

#include "hamflow/arithmetic/compensated.hpp"
#include "hamflow/core/derivatives.hpp"

namespace hamflow {

namespace detail {

template <class P, std::size_t N = P::dimension>
class ExtrapolatedFlow {
 public:
  using R = typename P::Real;
  static constexpr std::size_t M = N == dynamic ? dynamic : 2 * N;
  using Z = Vector<R, M>;
  explicit ExtrapolatedFlow(const P& problem) : problem_(problem), size_(degrees_of_freedom(problem)) {}

  /// z(t) from z(0); NaN if the orbit cannot be computed (a collision).
  Z flow(const Z& start, R t) const {
    using Axis = typename Compensated<R>::Axis;
    auto sum = zeros<typename Compensated<R>::Stored, M>(2 * size_);
    for (std::size_t i = 0; i < 2 * size_; ++i) sum[i] = Axis::store(start[i]);
    Z z = start;
    R done(0);
    R step = t;
    while (abs(done) < abs(t)) {
      if (abs(step) > longest_step()) step = t < R(0) ? -longest_step() : longest_step();
      if (abs(done + step) > abs(t)) step = t - done;
      Z increment = zeros_like(z);
      while (!try_step(z, step, increment)) {
        step = step / R(2);
        if (abs(step) < shortest_step()) {
          for (R& x : z) x = std::numeric_limits<R>::quiet_NaN();
          return z;
        }
      }
      for (std::size_t i = 0; i < 2 * size_; ++i) {
        Axis::add(sum[i], increment[i]);
        z[i] = Axis::read(sum[i]);
      }
      done += step;
      step = step * R(2);
    }
    return z;
  }

 private:
  static constexpr int columns = 10;
  static R longest_step() { return R(1) / R(8); }
  static R shortest_step() { return longest_step() / R(1 << 24); }

  Z derivative(const Z& z, const Z& increment) const {
    Vector<R, N> q = zeros<R, N>(size_);
    Vector<R, N> p = q;
    Vector<R, N> dq = q;
    Vector<R, N> dp = q;
    for (std::size_t i = 0; i < size_; ++i) {
      q[i] = z[i] + increment[i];
      p[i] = z[size_ + i] + increment[size_ + i];
    }
    motion(problem_, q, p, dq, dp);
    Z out = zeros_like(z);
    for (std::size_t i = 0; i < size_; ++i) {
      out[i] = dq[i];
      out[size_ + i] = dp[i];
    }
    return out;
  }
  Z combine(const Z& z, R factor, const Z& direction) const {
    Z out = z;
    for (std::size_t i = 0; i < 2 * size_; ++i) out[i] += factor * direction[i];
    return out;
  }
  /// The increment over `step` with an even number of parts, smoothed at the end (II.9.13c).
  Z modified_midpoint(const Z& z, R step, int parts) const {
    const R h = step / R(parts);
    Z before = zeros_like(z);
    Z now = combine(before, h, derivative(z, before));
    for (int k = 1; k < parts; ++k) {
      const Z after = combine(before, R(2) * h, derivative(z, now));
      before = now;
      now = after;
    }
    const Z last = combine(before, h, derivative(z, now));
    Z mean = zeros_like(z);
    for (std::size_t i = 0; i < 2 * size_; ++i) mean[i] = (now[i] + last[i]) / R(2);
    return mean;
  }
  static R size_of(const Z& z) {
    R size(0);
    for (const R& x : z) size = larger(size, R(abs(x)));
    return size;
  }
  /// True if two neighbours of the extrapolation table agree to the rounding of an increment, or stop converging at a
  /// distance of at most 256 roundings.
  bool try_step(const Z& z, R step, Z& out) const {
    std::vector<Z> row;
    R previous = std::numeric_limits<R>::max();
    for (int j = 0; j < columns; ++j) {
      std::vector<Z> next{modified_midpoint(z, step, 2 * (j + 1))};
      for (int k = 1; k <= j; ++k) {
        const R ratio = R(j + 1) / R(j + 1 - k);
        const R divisor = ratio * ratio - R(1);
        Z better = next.back();
        for (std::size_t i = 0; i < 2 * size_; ++i) {
          better[i] += (next.back()[i] - row[static_cast<std::size_t>(k - 1)][i]) / divisor;
        }
        next.push_back(better);
      }
      if (j >= 4) {
        R difference(0);
        for (std::size_t i = 0; i < 2 * size_; ++i) {
          difference = larger(difference, R(abs(next.back()[i] - row.back()[i])));
        }
        const R rounding = std::numeric_limits<R>::epsilon() * larger(size_of(next.back()), R(abs(step)) * size_of(z));
        if (difference <= R(2) * rounding) {
          out = next.back();
          return true;
        }
        if (difference >= previous && previous <= R(256) * rounding) {
          out = row.back();
          return true;
        }
        previous = difference;
      }
      row = std::move(next);
    }
    return false;
  }

  const P& problem_;
  std::size_t size_;
};

}  // namespace detail

/// z(t) for z = (q, p), to a few units of rounding per unit of time.
template <class P>
auto reference_flow(const P& problem, const typename detail::ExtrapolatedFlow<P>::Z& z, typename P::Real t) {
  return detail::ExtrapolatedFlow<P>(problem).flow(z, t);
}

}  // namespace hamflow
