// Gragg's modified midpoint rule, extrapolated in h^2 (Aitken-Neville), with adaptive sub-steps.   [HNW1993, II.9] It
// has any order in any arithmetic. A reference solution is checked with it, because it shares only the derivatives of H
// with the other methods. Scenarios cannot choose it.
//
// A sub-step of size tau has K columns of 2, 4, ..., 2 K parts. With separate max-norms of the q- and the p-block,
//   error = max over both blocks of |T_K,K - T_K,K-1|/(tolerance max(|x0|, |x1|, |tau x0'|)) <= 1,
//   next tau = tau clamp(0.8 error^(-1/(2K - 1)), 1/10, 4).
// K grows with the number of digits, which is about the cheapest choice. The increment of a sub-step is extrapolated
// instead of the state, so that its rounding error is relative to the increment.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/method_info.hpp"
#include "hamflow/core/outcome.hpp"
#include "hamflow/core/phase_point.hpp"
#include "hamflow/core/stop_question.hpp"
#include "hamflow/detail/core/step_clock.hpp"
#include "hamflow/detail/methods/substeps.hpp"

namespace hamflow {

struct ExtrapolationOptions {
  double tolerance = 1e-18;  // bounds the error of a sub-step, relative to the size of q and to the size of p
  int max_substeps = 1000000;
};

/// Returns the number of columns for a tolerance: 10 for 18 digits, 17 for 32.
inline int extrapolation_columns(double tolerance) {
  return std::clamp(static_cast<int>(std::ceil(-std::log10(tolerance) / 2)) + 1, 4, 150);
}

template <class P, Arithmetic A>
class ExtrapolatedMidpointMethod {
 public:
  static constexpr std::size_t n = P::dimension;
  using Real = typename A::Real;

  explicit ExtrapolatedMidpointMethod(const ExtrapolationOptions& options)
      : options_(options), columns_(extrapolation_columns(options.tolerance)) {}

  MethodInfo info() const {
    return {.name = "extrapolation",
            .summary = "modified midpoint rule, extrapolated",
            .reference = "HNW1993, II.9",
            .order = 2 * columns_,
            .weakly_reversible = true,
            .own_substeps = true};
  }
  Effort effort() const { return Separable<P> ? Effort{.force = evaluations_} : Effort{.gradient = evaluations_}; }

  /// Advances z to Psi_h(z). z is unchanged if the step fails or is stopped (StopQuestion).
  Outcome step(const P& problem, const Real& h, PhasePoint<A, n>& z) {
    const PhasePoint<A, n> start = z;
    const double whole = std::fabs(static_cast<double>(h));
    double proposal = proposed_ > 0 ? proposed_ / whole : 1;
    Substeps substeps;
    while (!substeps.finished()) {
      q_ = z.positions();
      p_ = z.momenta();
      derivative(problem, q_, p_, first_);
      double part = 0;
      for (bool repeated = false;; repeated = true) {
        part = substeps.next(proposal);
        if (part == 0 || substeps.taken() == options_.max_substeps) {
          z = start;
          return Outcome::not_converged;
        }
        const double error = attempt(problem, part == 1 ? h : exact_number<Real>(part) * h);
        if (stopped_) {
          stopped_ = false;
          z = start;
          return Outcome::stopped;
        }
        // growth is NaN if the sub-step left the domain of H.
        const double growth = 0.8 * pow(error, -1.0 / (2 * columns_ - 1));
        proposal = part * (growth > 4 ? 4 : growth > 0.1 ? growth : 0.1);
        if (repeated && error <= 1 && proposal > part) proposal = part;
        if (error <= 1) break;
      }
      z.move(row_.back().q);
      z.push(row_.back().p);
      substeps.take(part);
    }
    proposed_ = proposal * whole;
    return Outcome::done;
  }

  /// The method only remembers the size that the last sub-step proposed for the next one; 0: none.
  void invalidate() { proposed_ = 0; }
  template <class Archive>
  void archive(Archive& ar) {
    ar(proposed_, evaluations_);
  }

 private:
  using V = Vector<Real, n>;
  /// A change of the state, or its rate.
  struct Change {
    V q;
    V p;
  };

  void derivative(const P& problem, const V& q, const V& p, Change& rate) {
    rate.q = zeros_like(q);
    rate.p = zeros_like(q);
    motion(problem, q, p, rate.q, rate.p);
    ++evaluations_;
  }
  /// to = from + factor * rate.
  static void combine(const Change& from, const Real& factor, const Change& rate, Change& to) {
    to = from;
    for (std::size_t i = 0; i < to.q.size(); ++i) {
      to.q[i] += factor * rate.q[i];
      to.p[i] += factor * rate.p[i];
    }
  }
  /// Computes the rate at the state plus `change`.
  void rate_at(const P& problem, const Change& change, Change& rate) {
    V q = q_;
    V p = p_;
    for (std::size_t i = 0; i < q.size(); ++i) {
      q[i] += change.q[i];
      p[i] += change.p[i];
    }
    derivative(problem, q, p, rate);
  }
  /// Returns whether a trial is so far from the scale of the motion that its columns cannot agree. Continuing would
  /// only cost time: the sine of an angle of 10^(10^6) takes seconds in mp.
  bool is_beyond_limit(const Change& change) const {
    for (std::size_t i = 0; i < change.q.size(); ++i) {
      const double size =
          std::fmax(std::fabs(static_cast<double>(change.q[i])), std::fabs(static_cast<double>(change.p[i])));
      if (!(size <= trial_limit_)) return true;
    }
    return false;
  }
  /// Returns the bound of a trial: 10^60 times the state and its rate.
  double limit(const Real& tau) const {
    double size = 0;
    for (std::size_t i = 0; i < q_.size(); ++i) {
      for (const Real& x : {q_[i], p_[i], Real(tau * first_.q[i]), Real(tau * first_.p[i])}) {
        size = std::fmax(size, std::fabs(static_cast<double>(x)));
      }
    }
    return 1e60 * size;
  }
  /// Computes the increment over tau in an even number of parts, smoothed at the end (II.9.13c).
  Change modified_midpoint(const P& problem, const Real& tau, int parts) {
    const Real h = tau / Real(parts);
    Change before{zeros_like(q_), zeros_like(q_)};
    Change now;
    Change after;
    Change rate;
    combine(before, h, first_, now);
    for (int k = 1; k < parts; ++k) {
      stopped_ = StopQuestion::stop_requested();
      if (stopped_ || is_beyond_limit(now)) break;
      rate_at(problem, now, rate);
      combine(before, Real(2) * h, rate, after);
      before = now;
      now = after;
    }
    if (stopped_ || is_beyond_limit(now)) {
      beyond_limit_ = true;
      return now;
    }
    rate_at(problem, now, rate);
    combine(before, h, rate, after);
    for (std::size_t i = 0; i < q_.size(); ++i) {
      now.q[i] = (now.q[i] + after.q[i]) / Real(2);
      now.p[i] = (now.p[i] + after.p[i]) / Real(2);
    }
    return now;
  }

  /// Computes the last row of the table into row_; returns error/tolerance.
  double attempt(const P& problem, const Real& tau) {
    trial_limit_ = limit(tau);
    beyond_limit_ = false;
    for (int j = 0; j < columns_; ++j) {
      std::vector<Change> next{modified_midpoint(problem, tau, 2 * (j + 1))};
      if (beyond_limit_) return std::numeric_limits<double>::infinity();
      for (int k = 1; k <= j; ++k) {
        const Real ratio = Real(j + 1) / Real(j + 1 - k);
        const Real share = Real(1) / (ratio * ratio - Real(1));
        const Change& better = next.back();
        const Change& coarser = row_[static_cast<std::size_t>(k - 1)];
        Change difference = better;
        for (std::size_t i = 0; i < q_.size(); ++i) {
          difference.q[i] -= coarser.q[i];
          difference.p[i] -= coarser.p[i];
        }
        Change sum;
        combine(better, share, difference, sum);
        next.push_back(std::move(sum));
      }
      row_ = std::move(next);
    }
    const Change& last = row_[row_.size() - 1];
    const Change& other = row_[row_.size() - 2];
    return std::fmax(error_of(q_.size() - clocks_of(problem), q_, last.q, other.q, first_.q, tau),
                     error_of(p_.size(), p_, last.p, other.p, first_.p, tau));
  }
  /// Uses only the first `count` entries of a block, because an entry for the time may follow them.
  double error_of(std::size_t count, const V& x, const V& last, const V& other, const V& rate, const Real& tau) const {
    Real error(0);
    Real size(0);
    for (std::size_t i = 0; i < count; ++i) {
      error = larger(error, Real(abs(last[i] - other[i])));
      size = larger(size, larger(larger(Real(abs(x[i])), Real(abs(x[i] + last[i]))), Real(abs(tau * rate[i]))));
      if (!(last[i] - last[i] == Real(0))) return std::numeric_limits<double>::infinity();
    }
    if (error == Real(0)) return 0;
    return static_cast<double>(error / size) / options_.tolerance;
  }

  ExtrapolationOptions options_;
  int columns_;
  V q_, p_;
  Change first_;
  std::vector<Change> row_;
  double trial_limit_ = 0;
  bool beyond_limit_ = false;
  bool stopped_ = false;
  double proposed_ = 0;
  long long evaluations_ = 0;
};

/// The recipe of the method. No list contains its name; a Request with it goes to ProblemEntry::simulate_erased.
struct ExtrapolatedMidpoint {
  static constexpr const char* name = "(extrapolation)";
  static constexpr bool implicit = false;
  static constexpr bool bijective = false;
  template <class P>
  static constexpr bool accepts = Differentiable<P>;
  ExtrapolationOptions options{};
  template <class P, class A>
  using Stepper = ExtrapolatedMidpointMethod<P, A>;
  template <class P, class A>
  Stepper<P, A> bind(const P& /*problem*/) const {
    return Stepper<P, A>(options);
  }
};

}  // namespace hamflow
