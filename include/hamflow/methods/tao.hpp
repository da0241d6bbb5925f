// Explicit symplectic steps for any differentiable H, in a phase space of twice the dimensions.   [Tao2016] A second
// copy (x, y) of the state follows the first one, (q, p), coupled to it by springs of frequency omega:
//     H(q, y) + H(x, p) + omega (|q - x|^2 + |p - y|^2)/2
// Each of the three parts has an exact flow:
//     A:  p <- p - h H_q(q, y),  x <- x + h H_p(q, y)
//     B:  q <- q + h H_p(x, p),  y <- y - h H_q(x, p)
//     C:  (q - x, p - y) rotates by the angle 2 omega h; q + x and p + y do not change.
// tao2 is A(h/2) B(h/2) C(h) B(h/2) A(h/2), tao4 its triple jump. It is symplectic, symmetric and reversible as a map
// of (q, x, p, y), but not as a map of (q, p), which is why the copy is part of the state of a run. The copy starts as
// x = q, y = p. The method nearly conserves the energy of the coupled copies, and H(q, p) as long as they stay
// together, which requires an omega much larger than the frequencies of the motion. Errors grow with omega h^r, so
// omega h must be small.
#pragma once

#include <string>

#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/math.hpp"
#include "hamflow/core/method_info.hpp"
#include "hamflow/core/number.hpp"
#include "hamflow/core/outcome.hpp"
#include "hamflow/core/phase_point.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/detail/core/step_clock.hpp"

namespace hamflow {

struct TaoOptions {
  double omega = 20;  // frequency of the springs, 1/time
};

/// @param order 2 or 4
inline MethodInfo describe_tao(int order, const TaoOptions& options) {
  const bool usual = options.omega == TaoOptions().omega;
  return {.name = "tao" + std::to_string(order) + (usual ? "" : "(omega=" + shortest(options.omega) + ")"),
          .summary = order == 2 ? "explicit, two coupled copies of the state in a doubled phase space"
                                : "explicit, triple jump of tao2 in a doubled phase space",
          .reference = "Tao2016",
          .order = order,
          .symplectic = true,
          .weakly_reversible = true,
          .symmetric = true,
          .reversible = true,
          .carries_copy = true};
}

/// @tparam order 2 or 4
template <class P, Arithmetic A, int order>
class TaoStep {
 public:
  static_assert(Differentiable<P>, "hamflow: tao2 and tao4 need a Differentiable problem");
  static_assert(!A::exact_undo, "hamflow: the lattice needs an explicit splitting method: tao rotates coordinates");
  static constexpr std::size_t n = P::dimension;
  using Real = typename A::Real;
  using Base = base_scalar<Real>;
  using State = PhasePoint<A, n>;

  explicit TaoStep(const TaoOptions& options) : options_(options), omega_(options.omega) {
    if constexpr (order == 4) {
      jump_ = evaluate_number<Base>("1/(2 - 2^(1/3))");  // the triple jump of Suzuki and Yoshida for a step of order 2
    }
  }

  MethodInfo info() const { return describe_tao(order, options_); }

  Outcome step(const P& problem, const Base& h, State& z) {
    if (!begun_) {
      copy_ = z;
      begun_ = true;
    }
    if constexpr (order == 2) {
      leap(problem, h, z);
    } else {
      leap(problem, jump_ * h, z);
      leap(problem, (1 - 2 * jump_) * h, z);
      leap(problem, jump_ * h, z);
    }
    return Outcome::done;
  }

  /// Drops the derivatives at (q, y); the copy is kept.
  void invalidate() { kept_ = false; }
  /// Reverses the momenta of the copy, too, so that it reverses with the run.
  void negate_momenta() {
    if (begun_) copy_.negate_momenta();
  }
  /// A bounce reflects both copies.
  void negate_momentum(std::size_t i) {
    if (begun_) copy_.p[i] = A::Axis::negated(copy_.p[i]);
    kept_ = false;
  }
  void push_momentum(std::size_t i, const Real& change) {
    if (begun_) copy_.arithmetic.momentum.add(copy_.p[i], change);
    kept_ = false;
  }
  /// Sets the time in both copies (detail/core/step_clock.hpp).
  void set_clock(const State& z) {
    for (std::size_t i = 1; begun_ && i <= clock_coordinates; ++i) copy_.q[z.q.size() - i] = z.q[z.q.size() - i];
  }
  /// The second copy, x and y. It exists from the first step on.
  const State& copy() const { return copy_; }
  void begin_with(const State& copy) {
    copy_ = copy;
    begun_ = true;
    kept_ = false;
  }
  Effort effort() const { return Separable<P> ? Effort{.force = evaluations_} : Effort{.gradient = evaluations_}; }
  template <class Archive>
  void archive(Archive& ar) {
    ar(evaluations_, begun_, kept_, copy_, by_q_, by_p_);
  }

 private:
  void leap(const P& problem, const Base& h, State& z) {
    const Base half = h / 2;
    flow_a(problem, half, z);
    flow_b(problem, half, z);
    turn(problem, h, z);
    flow_b(problem, half, z);
    flow_a(problem, half, z);
  }
  /// Flow A. It changes neither q nor y, so that the next one reuses its derivatives.
  void flow_a(const P& problem, const Base& h, State& z) {
    if (!kept_) evaluate(problem, z.positions(), copy_.momenta());
    kept_ = true;
    z.push(-h, by_q_);
    copy_.move(h, by_p_);
  }
  void flow_b(const P& problem, const Base& h, State& z) {
    evaluate(problem, copy_.positions(), z.momenta());
    kept_ = false;
    z.move(h, by_p_);
    copy_.push(-h, by_q_);
  }
  /// Flow C, by increments with cos - 1 = -2 sin^2 of the half angle, so that each copy is rounded once. The time is
  /// the same in both copies and has no spring.
  void turn(const P& problem, const Base& h, State& z) {
    const Base angle = omega_ * h;  // half of the angle of rotation
    const Base sine = sin(angle);
    const Base less = sine * sine;                // (1 - cos 2 angle)/2
    const Base across = sine * Base(cos(angle));  // sin(2 angle)/2
    const Vector<Real, n> q = z.positions();
    const Vector<Real, n> p = z.momenta();
    Vector<Real, n> by_q = copy_.positions();
    Vector<Real, n> by_p = copy_.momenta();
    for (std::size_t i = 0; i < q.size(); ++i) {
      const Real apart_q = q[i] - by_q[i];
      const Real apart_p = p[i] - by_p[i];
      by_q[i] = across * apart_p - less * apart_q;
      by_p[i] = -(across * apart_q) - less * apart_p;
    }
    for (std::size_t i = 1; i <= clocks_of(problem); ++i) {
      by_q[q.size() - i] = Real(0);
      by_p[q.size() - i] = Real(0);
    }
    z.move(by_q);
    z.push(by_p);
    copy_.move(Base(-1), by_q);
    copy_.push(Base(-1), by_p);
  }
  void evaluate(const P& problem, const Vector<Real, n>& q, const Vector<Real, n>& p) {
    by_q_ = zeros_like(q);
    by_p_ = zeros_like(q);
    gradient(problem, q, p, by_q_, by_p_);
    ++evaluations_;
  }

  TaoOptions options_;
  Base omega_;
  Base jump_{};
  bool begun_ = false;
  bool kept_ = false;  // by_q_, by_p_ are the derivatives at (q, y)
  State copy_{};
  Vector<Real, n> by_q_{};
  Vector<Real, n> by_p_{};
  long long evaluations_ = 0;
};

/// The recipes of tao2 and tao4.
template <int order>
struct Tao {
  static constexpr bool implicit = false;
  static constexpr bool bijective = false;
  static constexpr bool recorded = true;
  template <class P>
  static constexpr bool accepts = Differentiable<P>;
  TaoOptions options{};
  template <class P, class A>
  using Stepper = TaoStep<P, A, order>;
  template <class P, class A>
  Stepper<P, A> bind(const P&) const {
    return Stepper<P, A>(options);
  }
};

}  // namespace hamflow
