// The Taylor series method: z(t0 + tau) = sum_k z_k tau^k up to any order, the coefficients by automatic
// differentiation of the problem's own formulas.   [JorbaZou2005] It is not a geometric integrator and its energy
// drifts. It serves as a reference for comparisons.
//
// One step advances by h in sub-steps. The last two coefficients of the q- and p-block, in the max-norm, give the
// radius of convergence (as in [JorbaZou2005, (3-8)], but with the size of a block taken within that radius, so that a
// block that passes through 0 does not stop the motion):
//     rho_j = max_{k=0,1,2} (|x_k|/|x_j|)^(1/(j - k)),   rho = the smallest rho_j, j = p - 1, p, of both blocks,
//     tau <= rho (tolerance e^-2)^(1/p) exp(-0.7/(p - 1)).
// For the cheapest order, p = ceil(1 - ln(tolerance)/2), this is rho/e^2 times their safety factor. The rest of h is
// divided into equal parts that are not longer. No sub-step depends on the one before, so there is no memory.
//
// The last two coefficients of both blocks can vanish by a symmetry of the motion: the quartic oscillator x' = p, p' =
// -2 x^3 from x = 0 has only q-coefficients 1, 5, 9, ... and p-coefficients 0, 4, 8, .... Therefore the rho_j of all
// coefficients of the second half bound the sub-step, too, with three times the factor (at most 0.9).
//
// Sizes are kept as logarithms, because with many digits they leave the range of double: with 100 digits, powers of a
// unit 1024 times shorter than the radius fall below 10^-308. A coefficient below the range of the arithmetic counts as
// its smallest number, which can only shorten the sub-step. Before a sub-step is added, its last terms are compared
// with the first ones in the working arithmetic; if the series does not converge, the step fails.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/number.hpp"
#include "hamflow/core/outcome.hpp"
#include "hamflow/core/phase_point.hpp"
#include "hamflow/core/stop_question.hpp"
#include "hamflow/detail/core/step_clock.hpp"
#include "hamflow/detail/methods/adaptive_options.hpp"
#include "hamflow/detail/methods/substeps.hpp"
#include "hamflow/detail/methods/tape_of_motion.hpp"
#include "hamflow/detail/numerics/taylor_series.hpp"

namespace hamflow {

template <class P, Arithmetic A>
class TaylorMethod {
 public:
  static constexpr std::size_t n = P::dimension;
  using Real = typename A::Real;
  using Base = base_scalar<Real>;
  static_assert(Traceable<P, Base>,
                "hamflow: taylor needs a Differentiable problem whose functions are templates over the number type");

  /// Records H at a generic state, so that an H that cannot be recorded is refused before the run.
  TaylorMethod(const P& problem, const AdaptiveOptions& options)
      : options_(options), order_(options.order > 0 ? options.order : cheapest_order(options.tolerance)) {
    const auto [q, p] = detail::any_state<Base, n>(problem);
    record(problem, q, p);
  }
  /// [JorbaZou2005, (3-7)]
  static int cheapest_order(long double tolerance) { return static_cast<int>(std::ceil(1 - std::log(tolerance) / 2)); }

  MethodInfo info() const { return describe_taylor(options_, order_); }
  int order() const { return order_; }
  /// Counts one pass over the tape, which costs as much as a gradient, for each coefficient.
  Effort effort() const { return {.gradient = sweeps_}; }
  long long substeps() const { return substeps_; }
  const Tape<Base>& tape() const { return *tape_; }

  Outcome step(const P& problem, const Base& h, PhasePoint<A, n>& z) { return advance(problem, h, z, nullptr); }

  /// Repeats the failed step and returns why it failed. Changes nothing.
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
  /// Coefficients, which are not copied with the method because every expansion computes them again.
  struct Scratch {
    Scratch() = default;
    Scratch(const Scratch&) {}
    Scratch& operator=(const Scratch&) { return *this; }
    TaylorSeries<Real> series;
  };

  Outcome advance(const P& problem, const Base& h, PhasePoint<A, n>& z, std::string* why) {
    if (options_.fixed) {
      expand(problem, h, z);
      if (StopQuestion::stop_requested()) return Outcome::stopped;
      add(Base(1), z);
      return Outcome::done;
    }
    const PhasePoint<A, n> start = z;
    Substeps substeps;
    double unit = 1;  // of time, in steps; less than 1 if powers of the step would leave the range
    while (!substeps.finished()) {
      double allowed = 0;
      for (;;) {
        expand(problem, unit == 1 ? h : exact_number<Base>(unit) * h, z);
        allowed = unit * reach(clocks_of(problem));
        if (allowed == allowed || unit < Substeps::shortest) break;
        unit /= 1024;
      }
      if (StopQuestion::stop_requested()) {
        z = start;
        return Outcome::stopped;
      }
      const double part = substeps.next(allowed);
      if (part == 0 || substeps.taken() == options_.max_substeps) {
        z = start;
        if (why != nullptr) *why = reason(part, allowed * std::fabs(static_cast<double>(h)), substeps);
        return Outcome::not_converged;
      }
      const Base s = part == unit ? Base(1) : exact_number<Base>(part / unit);
      if (!converges_at(s, clocks_of(problem))) {
        z = start;
        if (why != nullptr) *why = divergence_reason(part, substeps);
        return Outcome::not_converged;
      }
      add(s, z);
      substeps.take(part);
      // A power of 2, which does not change a bit of the result.
      if (unit < 1) unit = allowed < 1 ? std::exp2(std::floor(std::log2(allowed))) : 1;
    }
    return Outcome::done;
  }

  void record(const P& problem, const Vector<Base, n>& q, const Vector<Base, n>& p) {
    tape_ = std::make_shared<const Tape<Base>>(tape_of_motion(problem, q, p));
  }
  /// Computes the series at z. The tape is recorded again if a guard shows that z takes another branch.
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
  /// @param clocks number of last coordinates that hold the time and do not count for sizes
  double reach(std::size_t clocks) const {
    const double share = root_of_tolerance() * exp(-2.0 / order_) * (order_ > 1 ? exp(-0.7 / (order_ - 1)) : 0.5);
    const double most = std::fmax(share, std::fmin(3 * share, 0.9));  // share of the bound by the second half
    double last_two = std::numeric_limits<double>::infinity();
    double second_half = std::numeric_limits<double>::infinity();
    for (const std::size_t block : {std::size_t{0}, tape_->inputs / 2}) {
      std::array<double, 3> sizes{};
      for (int k = 0; k < std::min(3, order_); ++k)
        sizes[static_cast<std::size_t>(k)] = log_size(block, end_of(block, clocks), k);
      for (int j = std::max(1, std::min(order_ / 2 + 1, order_ - 1)); j <= order_; ++j) {
        const double last = log_size(block, end_of(block, clocks), j);
        if (!(last < std::numeric_limits<double>::infinity())) return std::numeric_limits<double>::quiet_NaN();
        double& least = j >= order_ - 1 ? last_two : second_half;
        least = std::fmin(least, radius_by(last, j, sizes));
      }
    }
    // Last coefficients that vanish by a symmetry do not determine the radius.
    if (last_two > 3 * second_half) return second_half * share;
    return std::fmin(last_two * share, second_half * most);
  }
  double root_of_tolerance() const {
    if constexpr (std::is_same_v<Base, double>) {
      if (functions_are_portable()) return pow(static_cast<double>(options_.tolerance), 1.0 / order_);
    }
    return static_cast<double>(std::pow(options_.tolerance, 1.0L / order_));
  }
  /// The end of the entries of a block, without the time.
  std::size_t end_of(std::size_t block, std::size_t clocks) const {
    return block + tape_->inputs / 2 - (block == 0 ? clocks : 0);
  }
  /// rho_j from the logarithms of the coefficient and of the first three.
  static double radius_by(double last, int j, const std::array<double, 3>& sizes) {
    constexpr double none = -std::numeric_limits<double>::infinity();  // the logarithm of 0
    static const double smallest = binary_logarithm(std::numeric_limits<Base>::min());
    double rho = last == none ? std::numeric_limits<double>::infinity() : 0;
    bool first = true;
    for (int k = 0; k < std::min(3, j); ++k) {
      const double size = sizes[static_cast<std::size_t>(k)];
      if (size == none) continue;
      const double by_k = exp2((size - std::fmax(last, smallest)) / (j - k));
      rho = first ? by_k : std::fmax(rho, by_k);
      first = false;
    }
    return rho;
  }
  /// log2 of the largest |x_k| of a block; -infinity for 0, infinity or NaN if a coefficient is not finite.
  double log_size(std::size_t block, std::size_t end, int k) const {
    Base most(0);
    for (std::size_t i = block; i < end; ++i) {
      const Base x = abs(value_of(scratch_.series.of(static_cast<int>(i))[k]));
      if (most == most && !(x <= most)) most = x;
    }
    return binary_logarithm(most);
  }

  /// Whether no term of the second half of the series at s is larger than the largest of the first three, in each
  /// block.
  bool converges_at(const Base& s, std::size_t clocks) const {
    const int half = order_ / 2 + 1;
    for (const std::size_t block : {std::size_t{0}, tape_->inputs / 2}) {
      Base first(0);
      Base last(0);
      for (std::size_t i = block; i < end_of(block, clocks); ++i) {
        const Real* const x = scratch_.series.of(static_cast<int>(i));
        Base power(1);
        for (int k = 0; k <= order_; ++k) {
          if (k > 0) power = power * s;
          if (k >= 3 && k < half) continue;
          const Base term = abs(value_of(x[k])) * power;
          Base& most = k < std::min(3, half) ? first : last;
          if (!(term <= most)) most = term;
        }
      }
      if (!(last <= first)) return false;
    }
    return true;
  }
  std::string divergence_reason(double part, const Substeps& substeps) const {
    return "the Taylor series does not converge over a sub-step of " + shortest(part) + " after " +
           shortest(substeps.done()) + " of the step; the motion may be near a singularity of H";
  }

  std::string reason(double part, double allowed, const Substeps& substeps) const {
    if (allowed != allowed) {
      return "the Taylor series has no finite coefficients after " + shortest(substeps.done()) +
             " of the step; the motion may be at a singularity of H";
    }
    if (part == 0) {
      return "taylor would need a sub-step of " + shortest(allowed) + " after " + shortest(substeps.done()) +
             " of the step, which is too short to change the state; the motion may be near a collision or another "
             "singularity";
    }
    return "taylor took " + std::to_string(options_.max_substeps) + " sub-steps, the maximum, for " +
           shortest(substeps.done()) + " of the step; a shorter step or a larger tolerance helps";
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
