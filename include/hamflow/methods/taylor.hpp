// The Taylor series method: z(t0 + tau) = sum_k z_k tau^k up to any order, the coefficients by automatic
// differentiation of the problem's own formulas.   [JorbaZou2005]
// Non-geometric: it drifts. Here as a reference to compare against.
//
// One step advances by h in sub-steps. The last two coefficients of the q- and of the p-block, in the max-norm, show
// how far the series reaches (as [JorbaZou2005, (3-8)], with the size of a block taken within that reach, so that a
// block that passes through 0 does not stop the motion):
//     rho_j = max_{k=0,1,2} (|x_k|/|x_j|)^(1/(j - k)),   rho = the least rho_j, j = p - 1, p, of both blocks,
//     tau <= rho (tolerance e^-2)^(1/p) exp(-0.7/(p - 1)).
// For the cheapest order, p = ceil(1 - ln(tolerance)/2), that is rho/e^2 and their safety factor. What is left of h is
// divided into equal parts that are no longer. No sub-step depends on the one before it: there is no memory.
#pragma once

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/number.hpp"
#include "hamflow/core/outcome.hpp"
#include "hamflow/core/phase_point.hpp"
#include "hamflow/core/step_clock.hpp"
#include "hamflow/methods/adaptive_options.hpp"
#include "hamflow/methods/substeps.hpp"
#include "hamflow/methods/tape_of_motion.hpp"
#include "hamflow/numerics/taylor_series.hpp"

namespace hamflow {

template <class P, Arithmetic A>
class TaylorMethod {
 public:
  static constexpr std::size_t n = P::dimension;
  using Real = typename A::Real;
  using Base = base_scalar<Real>;
  static_assert(Traceable<P, Base>,
                "hamflow: taylor needs a Differentiable problem whose functions are templates over the number type");

  /// Records H at a state like any other, so that what cannot be recorded is refused before anything runs.
  TaylorMethod(const P& problem, const AdaptiveOptions& options)
      : options_(options), order_(options.order > 0 ? options.order : cheapest_order(options.tolerance)) {
    const auto [q, p] = detail::any_state<Base, n>(problem);
    record(problem, q, p);
  }
  /// [JorbaZou2005, (3-7)]
  static int cheapest_order(double tolerance) { return static_cast<int>(std::ceil(1 - std::log(tolerance) / 2)); }

  MethodInfo info() const { return describe_taylor(options_, order_); }
  int order() const { return order_; }
  /// One sweep over the tape, as long as an evaluation of the gradient, is counted for each coefficient.
  Effort effort() const { return {.gradient = sweeps_}; }
  long long substeps() const { return substeps_; }
  const Tape<Base>& tape() const { return *tape_; }

  Outcome step(const P& problem, const Base& h, PhasePoint<A, n>& z) { return advance(problem, h, z, nullptr); }

  /// Repeats the step that failed and returns why it failed. Changes nothing.
  std::string failure(const P& problem, const Base& h, const PhasePoint<A, n>& z) const {
    TaylorMethod again = *this;
    PhasePoint<A, n> copy = z;
    std::string why;
    (void)again.advance(problem, h, copy, &why);
    return why;
  }

  void invalidate() {}
  template <class Archive>
  void archive(Archive& ar) {
    ar(sweeps_, substeps_);
  }

 private:
  /// The coefficients need not be copied with the method: every expansion writes them anew.
  struct Scratch {
    Scratch() = default;
    Scratch(const Scratch&) {}
    Scratch& operator=(const Scratch&) { return *this; }
    TaylorSeries<Real> series;
  };

  Outcome advance(const P& problem, const Base& h, PhasePoint<A, n>& z, std::string* why) {
    if (options_.fixed) {
      expand(problem, h, z);
      add(Base(1), z);
      return Outcome::done;
    }
    const PhasePoint<A, n> start = z;
    Substeps substeps;
    double unit = 1;  // of time, in steps: less where powers of the step would leave the range
    while (!substeps.finished()) {
      double allowed = 0;
      for (;;) {
        expand(problem, unit == 1 ? h : exact_number<Base>(unit) * h, z);
        allowed = unit * reach(clocks_of(problem));
        if (allowed == allowed || unit < Substeps::shortest) break;
        unit /= 1024;
      }
      const double part = substeps.next(allowed);
      if (part == 0 || substeps.taken() == options_.max_substeps) {
        z = start;
        if (why != nullptr) *why = reason(part, allowed * std::fabs(static_cast<double>(h)), substeps);
        return Outcome::not_converged;
      }
      add(part == unit ? Base(1) : exact_number<Base>(part / unit), z);
      substeps.take(part);
    }
    return Outcome::done;
  }

  void record(const P& problem, const Vector<Base, n>& q, const Vector<Base, n>& p) {
    tape_ = std::make_shared<const Tape<Base>>(tape_of_motion(problem, q, p));
  }
  /// The series at z; a tape that was recorded on another side of a test for equality is recorded anew.
  void expand(const P& problem, const Base& unit, const PhasePoint<A, n>& z) {
    const auto& q = z.positions();
    const auto& p = z.momenta();
    const auto order = static_cast<std::size_t>(order_);
    TaylorSeries<Real>& series = scratch_.series;
    for (int attempt = 0; attempt < 2; ++attempt) {
      series.resize(*tape_, order);
      for (std::size_t i = 0; i < q.size(); ++i) {
        series.of(static_cast<int>(i))[0] = q[i];
        series.of(static_cast<int>(q.size() + i))[0] = p[i];
      }
      if (series.solve(*tape_, order, unit)) break;
      record(problem, values(q), values(p));
    }
    sweeps_ += order_;
  }
  static Vector<Base, n> values(const Vector<Real, n>& x) {
    Vector<Base, n> y = zeros<Base, n>(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) y[i] = value_of(x[i]);
    return y;
  }
  /// z <- z + sum_{k>0} z_k s^k.
  void add(const Base& s, PhasePoint<A, n>& z) {
    Vector<Real, n> increment = zeros<Real, n>(z.q.size());
    const auto sum = [&](std::size_t first) {
      for (std::size_t i = 0; i < increment.size(); ++i) {
        const Real* const x = scratch_.series.of(static_cast<int>(first + i));
        Real total = x[order_];
        for (int k = order_ - 1; k > 0; --k) total = total * s + x[k];
        increment[i] = total * s;
      }
    };
    sum(0);
    z.move(increment);
    sum(increment.size());
    z.push(increment);
    ++substeps_;
  }

  /// The longest sub-step, in units; NaN: powers of the unit left the range.
  /// @param clocks last positions, which carry the time: their size is none of the motion
  double reach(std::size_t clocks) const {
    const double share = std::pow(options_.tolerance, 1.0 / order_) * std::exp(-2.0 / order_) *
                         (order_ > 1 ? std::exp(-0.7 / (order_ - 1)) : 0.5);
    const std::size_t size = tape_->inputs / 2;
    double least = std::numeric_limits<double>::infinity();
    for (const std::size_t first : {std::size_t{0}, size}) {
      const std::size_t count = size - (first == 0 ? clocks : 0);
      for (int j = order_ > 1 ? order_ - 1 : 1; j <= order_; ++j) {
        const double last = norm(first, count, j);
        if (!(last <= std::numeric_limits<double>::max())) return std::numeric_limits<double>::quiet_NaN();
        if (last == 0) continue;
        double rho = 0;
        for (int k = 0; k < 3 && k < j; ++k)
          rho = std::fmax(rho, std::pow(norm(first, count, k) / last, 1.0 / (j - k)));
        least = std::fmin(least, rho);
      }
    }
    return least * share;
  }
  /// max_i |x_k| over so many entries; not finite where one is not.
  double norm(std::size_t first, std::size_t count, int k) const {
    double most = 0;
    for (std::size_t i = first; i < first + count; ++i) {
      const double x = std::fabs(static_cast<double>(value_of(scratch_.series.of(static_cast<int>(i))[k])));
      if (most == most && !(x <= most)) most = x;
    }
    return most;
  }

  std::string reason(double part, double allowed, const Substeps& substeps) const {
    if (allowed != allowed) {
      return "the Taylor series has no finite coefficients after " + shortest(substeps.done()) +
             " of the step: is the motion at a singularity of H?";
    }
    if (part == 0) {
      return "taylor would need a sub-step of " + shortest(allowed) + " after " + shortest(substeps.done()) +
             " of the step, too short to add up: is the motion near a collision or another singularity?";
    }
    return "taylor took " + std::to_string(options_.max_substeps) + " sub-steps, the maximum, for " +
           shortest(substeps.done()) + " of the step: a shorter step or a larger tolerance would help";
  }

  AdaptiveOptions options_;
  int order_;
  std::shared_ptr<const Tape<Base>> tape_;
  Scratch scratch_;
  long long sweeps_ = 0;
  long long substeps_ = 0;
};

/// The recipe of taylor: Taylor{AdaptiveOptions{.tolerance = 1e-10}}.
struct Taylor {
  static constexpr bool implicit = false;
  static constexpr bool bijective = false;
  template <class P>
  static constexpr bool accepts = Traceable<P, RealOf<P>>;
  AdaptiveOptions options{};
  template <class P, class A>
  using Stepper = TaylorMethod<P, A>;
  template <class P, class A>
  Stepper<P, A> bind(const P& problem) const {
    return Stepper<P, A>(problem, options);
  }
};

}  // namespace hamflow
