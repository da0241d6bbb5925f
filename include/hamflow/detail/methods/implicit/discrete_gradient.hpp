// A step with a discrete gradient DH of H: u = z1 - z0 is
//     u = h J DH(z0, z1),     DH . u = H(z1) - H(z0),     DH(z, z) = grad H(z),
// so that H(z1) - H(z0) = h DH . J DH = 0: any H is conserved.   [HLW2006, Sect. V.5; Gonzalez1996] Newton's method
// solves for u with the exact Jacobian 1 - h J dDH/du.
#pragma once

#include "hamflow/detail/methods/implicit/target.hpp"

namespace hamflow {

/// A discrete gradient at one u.
template <class Real>
struct LinearisedGradient {
  Vector<Real, dynamic> value{};  // DH, first by q, then by p
  Vector<Real, dynamic> noise{};  // its rounding in units of epsilon
  Matrix<Real, dynamic> by_u{};   // dDH_i/du_j, if requested
};

/// The claims of a discrete gradient, completed by the options.
inline MethodInfo described(MethodInfo claims, const NewtonOptions& options) {
  claims.halves_steps = options.halve;
  claims.diagnostics = options.diagnostics;
  return claims;
}

/// @tparam Rule a discrete gradient:
///     Rule(const P&)
///     at(problem, z0, u): DH for numbers of any type
///     linearise(problem, z0, u, wanted, out, effort): DH with its noise and, if wanted, dDH/du
///     static MethodInfo claims()
template <class P, class R, template <class, class> class Rule>
class DiscreteGradientStep : public TargetEquations<R> {
  using Base = TargetEquations<R>;

 public:
  using Problem = P;
  using Real = R;
  static constexpr std::size_t n = P::dimension;
  using V = Vector<Real, n>;
  using typename Base::Point;
  using typename Base::Variables;
  using Unknowns = Variables;
  using Memory = Variables;
  struct Setup {
    static constexpr const char* residual_name = "residual";
    NewtonOptions options;
    Rule<P, Real> rule;
    Setup(const P& problem, const NewtonOptions& chosen) : options(chosen), rule(problem) {}
    MethodInfo info() const { return described(Rule<P, Real>::claims(), options); }
    NewtonOptions newton() const { return options; }
    std::string detail() const { return "a discrete gradient"; }
    template <class Archive>
    void archive(Archive&) {}
  };

  DiscreteGradientStep(const Setup& setup, const P& problem, const Real& h, const V& q0, const V& p0, Effort& effort)
      : Base(h), setup_(setup), problem_(problem), q0_(q0), p0_(p0), effort_(effort) {}

  const V& positions() const { return q0_; }
  const V& momenta() const { return p0_; }
  DiscreteGradientStep from(const V& q0, const V& p0) const {
    return DiscreteGradientStep(setup_, problem_, h_, q0, p0, effort_);
  }
  Variables last_state() const { return Variables(2 * q0_.size()); }
  Variables predicted() const {
    V dq = zeros_like(q0_);
    V dp = zeros_like(q0_);
    gradient(problem_, q0_, p0_, dq, dp);
    ++effort_.gradient;
    Variables u = last_state();
    for (std::size_t i = 0; i < q0_.size(); ++i) {
      u[i] = h_ * dp[i];
      u[q0_.size() + i] = -h_ * dq[i];
    }
    if (has_clock(problem_)) u[u.size() - 1] = Real(0);
    return u;
  }
  Variables started(const Memory& extrapolated) const { return extrapolated; }

  void evaluate(const Variables& u, Point& at) const {
    const std::size_t size = q0_.size();
    LinearisedGradient<Real> dh;
    setup_.rule.linearise(problem_, stacked(q0_, p0_), u, at.linearised, dh, effort_);
    Base::clear(at, u.size());
    const Real kappa = detail::golden_ratio<Real>();
    for (std::size_t i = 0; i < u.size(); ++i) {
      const bool of_q = i < size;
      const std::size_t other = of_q ? size + i : i - size;  // J
      // No function depends on the momentum of the coordinate that holds the start time of a step of H(q, p, t). A
      // gradient along the whole increment would change that time.
      const bool is_unused = has_clock(problem_) && i + 1 == u.size();
      if (is_unused) {
        if (at.linearised) at.tangent[i][i] = Real(1);
        continue;
      }
      at.sum[i] = of_q ? kappa * dh.value[other] : -kappa * dh.value[other];
      at.noise[i] = abs(h_) * dh.noise[other];
      if (!at.linearised) continue;
      for (std::size_t j = 0; j < u.size(); ++j) {
        at.tangent[i][j] = (i == j ? Real(1) : Real(0)) - (of_q ? h_ : -h_) * dh.by_u[other][j];
      }
    }
    Base::close(u, at);
  }

  Increment<Real, n> taken(Variables& u, const Point& at) const {
    u = at.target;
    return increment(u);
  }
  Increment<Real, n> taken(Variables& u, const Point& at, const Variables& correction) const {
    Base::move_to_target(u, at, correction);
    return increment(u);
  }
  Memory memory(const Variables& u, const Increment<Real, n>&) const { return u; }
  Unknowns unknowns(const Variables& u, const Increment<Real, n>&) const { return u; }

  template <class S>
  Vector<S, dynamic> residual(const Vector<S, n>& q0, const Vector<S, n>& p0, const Vector<S, dynamic>& u) const {
    const std::size_t size = q0.size();
    const Vector<S, dynamic> dh = setup_.rule.at(problem_, stacked(q0, p0), u);
    Vector<S, dynamic> r = u;
    for (std::size_t i = 0; i < size; ++i) {
      r[i] = h_ * dh[size + i] - u[i];
      r[size + i] = -h_ * dh[i] - u[size + i];
    }
    return r;
  }
  template <class S>
  static Increment<S, n> increment(const Vector<S, dynamic>& u) {
    return detail::halves<n>(u);
  }

 private:
  using Base::h_;
  template <class S>
  static Vector<S, dynamic> stacked(const Vector<S, n>& q, const Vector<S, n>& p) {
    Vector<S, dynamic> z(2 * q.size());
    for (std::size_t i = 0; i < q.size(); ++i) {
      z[i] = q[i];
      z[q.size() + i] = p[i];
    }
    return z;
  }

  const Setup& setup_;
  const P& problem_;
  const V& q0_;
  const V& p0_;
  Effort& effort_;
};

}  // namespace hamflow
