// DOP853, the explicit Runge-Kutta method of Dormand and Prince of order 8 with 12 stages, and its step control by two
// embedded formulas of orders 5 and 3.   [HNW1993, II.5, (II.10.17), and the code DOP853] It is not a geometric
// integrator and its energy drifts. It serves as a reference for comparisons.
//
// One step advances by h in sub-steps tau. With separate max-norms for the q- and p-block,
//     scale = max(|x0|, |x1|, |tau x0'|),   e_m = max over both blocks of |tau sum_i e^(m)_i k_i|/(tolerance scale),
//     error = e_5^2/sqrt(e_5^2 + 0.01 e_3^2) <= 1,   next tau = tau clamp(0.9 error^(-1/8), 1/3, 6).
// The term |tau x0'| keeps the scale above 0 when a block passes through 0. The last proposal is kept for the next
// step.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/number.hpp"
#include "hamflow/core/outcome.hpp"
#include "hamflow/core/phase_point.hpp"
#include "hamflow/core/stop_question.hpp"
#include "hamflow/detail/core/step_clock.hpp"
#include "hamflow/detail/methods/adaptive_options.hpp"
#include "hamflow/detail/methods/dop853_tableau.hpp"
#include "hamflow/detail/methods/substeps.hpp"

namespace hamflow {

namespace dop853 {

/// The tableau in one arithmetic. Its zero entries are known at compile time.
template <class R>
struct Coefficients {
  R a[stages][stages]{};
  R b[stages]{};
  R error5[stages]{};
  R error3[stages]{};

  Coefficients() {
    for (const Entry& e : dop853::a) a[e.row][e.column] = evaluate_number<R>(e.value);
    for (const Weight& w : dop853::b) b[w.stage] = evaluate_number<R>(w.value);
    for (const Weight& w : dop853::error5) error5[w.stage] = evaluate_number<R>(w.value);
    for (const Weight& w : dop853::error3) error3[w.stage] = evaluate_number<R>(w.value);
  }
};

constexpr bool has_entry(std::size_t row, std::size_t column) {
  for (const Entry& e : a) {
    if (e.row == row && e.column == column) return true;
  }
  return false;
}
/// Whether a stage has a weight in b and in the error formulas; all stages but two have.
constexpr bool has_weight(std::size_t stage) {
  for (const Weight& w : b) {
    if (w.stage == stage) return true;
  }
  return false;
}

}  // namespace dop853

template <class P, Arithmetic A>
class DormandPrince853 {
 public:
  static_assert(Differentiable<P>,
                "hamflow: dop853 needs a Differentiable problem; one of dynamic size "
                "must define velocity and force, or gradient");
  static constexpr std::size_t n = P::dimension;
  static constexpr std::size_t stages = dop853::stages;
  using Real = typename A::Real;
  using Base = base_scalar<Real>;

  explicit DormandPrince853(const AdaptiveOptions& options)
      : options_(options), tableau_(std::make_shared<const dop853::Coefficients<Base>>()) {}

  MethodInfo info() const { return describe_dop853(options_); }
  Effort effort() const { return Separable<P> ? Effort{.force = evaluations_} : Effort{.gradient = evaluations_}; }
  /// The numbers of sub-steps taken and rejected since construction.
  long long substeps() const { return substeps_; }
  long long rejected() const { return rejected_; }

  Outcome step(const P& problem, const Base& h, PhasePoint<A, n>& z) { return advance(problem, h, z, nullptr); }

  /// Repeats the failed step and returns why it failed. Changes nothing.
  std::string failure(const P& problem, const Base& h, const PhasePoint<A, n>& z) const {
    DormandPrince853 again = *this;
    PhasePoint<A, n> copy = z;
    std::string why;
    (void)again.advance(problem, h, copy, &why);
    return why;
  }

  /// Drops the length that the last sub-step proposed for the next one.
  void invalidate() { proposed_ = 0; }
  template <class Archive>
  void archive(Archive& ar) {
    ar(proposed_, evaluations_, substeps_, rejected_);
  }

 private:
  using V = Vector<Real, n>;
  struct Stages {
    std::array<V, DormandPrince853::stages> dq{};  // q' and p' of the stages
    std::array<V, DormandPrince853::stages> dp{};
    V q0, p0, q1, p1;  // before and after the sub-step
    V increment_q, increment_p;
  };

  Outcome advance(const P& problem, const Base& h, PhasePoint<A, n>& z, std::string* why) {
    Stages s = stages_for(z);
    if (options_.fixed) {
      derivative(problem, s.q0, s.p0, s.dq[0], s.dp[0]);
      attempt(problem, h, s);
      accept(s, z);
      return Outcome::done;
    }
    const double whole = size_of(h);
    const PhasePoint<A, n> start = z;
    double proposal = proposed_ > 0 ? proposed_ / whole : 1;
    Substeps substeps;
    while (!substeps.finished()) {
      derivative(problem, s.q0, s.p0, s.dq[0], s.dp[0]);
      double part = 0;
      for (bool repeated = false;; repeated = true) {
        if (StopQuestion::stop_requested()) {
          z = start;
          return Outcome::stopped;
        }
        part = substeps.next(proposal);
        if (part == 0 || substeps.taken() == options_.max_substeps) {
          z = start;
          if (why != nullptr) *why = reason(part * whole, proposal * whole, substeps);
          return Outcome::not_converged;
        }
        const Base tau = part == 1 ? h : exact_number<Base>(part) * h;
        attempt(problem, tau, s);
        const double error = error_of(tau, s, clocks_of(problem));
        // NaN: the sub-step left the domain of H.
        if (!(error <= 1)) ++rejected_;
        const double growth = error < 1e-12 ? 6.0 : 0.9 * pow(error, -1.0 / 8.0);
        proposal = part * (growth > 6 ? 6 : growth > 1.0 / 3.0 ? growth : 1.0 / 3.0);
        if (repeated && error <= 1 && proposal > part) proposal = part;
        if (error <= 1) break;
      }
      accept(s, z);
      substeps.take(part);
    }
    proposed_ = proposal * whole;
    return Outcome::done;
  }

  static Stages stages_for(const PhasePoint<A, n>& z) {
    Stages s;
    s.q0 = z.positions();
    s.p0 = z.momenta();
    if constexpr (n == dynamic) {
      s.dq.fill(zeros_like(s.q0));
      s.dp.fill(zeros_like(s.q0));
    }
    s.q1 = s.p1 = s.increment_q = s.increment_p = zeros_like(s.q0);
    return s;
  }

  template <class F>
  static void for_each_stage(F&& f) {
    [&]<std::size_t... i>(std::index_sequence<i...>) { (f.template operator()<i>(), ...); }
    (std::make_index_sequence<stages>{});
  }
  /// Computes all stages except the first, which is known, and the increments of the formula of order 8.
  void attempt(const P& problem, const Base& tau, Stages& s) {
    const dop853::Coefficients<Base>& c = *tableau_;
    const std::size_t size = s.q0.size();
    for_each_stage([&]<std::size_t i>() {
      if constexpr (i > 0) {
        for (std::size_t k = 0; k < size; ++k) {
          Real sum_q = c.a[i][0] * s.dq[0][k];
          Real sum_p = c.a[i][0] * s.dp[0][k];
          for_each_stage([&]<std::size_t j>() {
            if constexpr (j > 0 && dop853::has_entry(i, j)) {
              sum_q += c.a[i][j] * s.dq[j][k];
              sum_p += c.a[i][j] * s.dp[j][k];
            }
          });
          s.q1[k] = s.q0[k] + tau * sum_q;
          s.p1[k] = s.p0[k] + tau * sum_p;
        }
        derivative(problem, s.q1, s.p1, s.dq[i], s.dp[i]);
      }
    });
    for (std::size_t k = 0; k < size; ++k) {
      s.increment_q[k] = tau * weighted(c.b, s.dq, k);
      s.increment_p[k] = tau * weighted(c.b, s.dp, k);
      s.q1[k] = s.q0[k] + s.increment_q[k];
      s.p1[k] = s.p0[k] + s.increment_p[k];
    }
  }
  static Real weighted(const Base (&weights)[stages], const std::array<V, stages>& slopes, std::size_t k) {
    Real sum = weights[0] * slopes[0][k];
    for_each_stage([&]<std::size_t i>() {
      if constexpr (i > 0 && dop853::has_weight(i)) sum += weights[i] * slopes[i][k];
    });
    return sum;
  }
  void accept(Stages& s, PhasePoint<A, n>& z) {
    z.move(s.increment_q);
    z.push(s.increment_p);
    s.q0 = z.positions();
    s.p0 = z.momenta();
    ++substeps_;
  }

  /// @param clocks number of last coordinates that hold the time and are exact
  double error_of(const Base& tau, const Stages& s, std::size_t clocks) const {
    const double length = size_of(tau);
    double fifth = 0;
    double third = 0;
    compare(length, s.q0.size() - clocks, s.q0, s.q1, s.dq, fifth, third);
    compare(length, s.p0.size(), s.p0, s.p1, s.dp, fifth, third);
    if (fifth == 0) return 0;
    return fifth * fifth / std::sqrt(fifth * fifth + 0.01 * third * third);
  }
  /// Compares the first `size` entries of a block. The errors become infinite if any number is NaN.
  void compare(double length, std::size_t size, const V& x0, const V& x1, const std::array<V, stages>& slopes,
               double& fifth, double& third) const {
    double scale = 0;
    double e5 = 0;
    double e3 = 0;
    for (std::size_t k = 0; k < size; ++k) {
      raise(scale, size_of(x0[k]));
      raise(scale, size_of(x1[k]));
      raise(scale, length * size_of(slopes[0][k]));
      raise(e5, length * size_of(weighted(tableau_->error5, slopes, k)));
      raise(e3, length * size_of(weighted(tableau_->error3, slopes, k)));
    }
    if (!(scale <= std::numeric_limits<double>::max())) e5 = std::numeric_limits<double>::quiet_NaN();
    if (e5 == 0 && e3 == 0) return;  // also if the block is at rest in 0
    const double tolerance = static_cast<double>(options_.tolerance);
    raise(fifth, e5 / (tolerance * scale));
    raise(third, e3 / (tolerance * scale));
  }
  /// most <- max(most, x); keeps NaN.
  static void raise(double& most, double x) {
    if (most == most && !(x <= most)) most = x;
  }
  template <class T>
  static double size_of(const T& x) {
    return std::fabs(static_cast<double>(value_of(x)));
  }

  std::string reason(double part, double proposal, const Substeps& substeps) const {
    if (part == 0) {
      return "dop853 would need a sub-step of " + shortest(proposal) + " after " + shortest(substeps.done()) +
             " of the step, which is too short to change the state. The motion may be near a collision or another "
             "singularity, or tolerance "
             "= " +
             shortest(static_cast<double>(options_.tolerance)) + " may be below the rounding of the arithmetic";
    }
    return "dop853 took " + std::to_string(options_.max_substeps) + " sub-steps, the maximum, for " +
           shortest(substeps.done()) + " of the step; a shorter step or a larger tolerance helps";
  }

  void derivative(const P& problem, const V& q, const V& p, V& dq, V& dp) {
    ++evaluations_;
    motion(problem, q, p, dq, dp);
  }

  AdaptiveOptions options_;
  std::shared_ptr<const dop853::Coefficients<Base>> tableau_;
  double proposed_ = 0;
  long long evaluations_ = 0;
  long long substeps_ = 0;
  long long rejected_ = 0;
};

/// The recipe of dop853: Dop853{AdaptiveOptions{.tolerance = 1e-10}}.
struct Dop853 {
  static constexpr bool implicit = false;
  static constexpr bool bijective = false;
  static constexpr int digits = dop853::digits;  // with more digits the order would be limited by the coefficients
  template <class P>
  static constexpr bool accepts = Differentiable<P>;
  AdaptiveOptions options{};
  template <class P, class A>
  using Stepper = DormandPrince853<P, A>;
  template <class P, class A>
  Stepper<P, A> bind(const P&) const {
    return Stepper<P, A>(options);
  }
};

}  // namespace hamflow
