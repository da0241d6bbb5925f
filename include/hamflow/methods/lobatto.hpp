// The Lobatto pair IIIA-IIIB for any H(q, p): order 2 s - 2, symplectic, symmetric.   [HLW2006, Sect. II.2.2, IV.2]
//     K_i = h b_i H_p(Q_i, P_i),   L_i = -h b_i H_q(Q_i, P_i),   z1 = z0 + sum_i (K_i, L_i),
//     Q_i = q0 + sum_j (1/2 + nu_ij) K_j,   P_i = p0 + sum_j (1/2 - nu_ji) L_j.
// One matrix nu serves both (detail/numerics/lobatto.hpp), so that the map is symplectic whatever the rounding of nu.
// Q_1 = q0, Q_s = q1; with two stages the method is Verlet (kick first) for H = T(p) + V(q). Newton's method solves for
// all K_i and L_i with the exact Jacobian.
#pragma once

#include "hamflow/core/derivatives.hpp"
#include "hamflow/detail/methods/implicit/implicit_method.hpp"
#include "hamflow/detail/methods/implicit/large_systems.hpp"
#include "hamflow/detail/methods/implicit/target.hpp"
#include "hamflow/detail/methods/lobatto_options.hpp"
#include "hamflow/detail/numerics/lobatto.hpp"

namespace hamflow {

template <class P, class R>
class LobattoStages : public TargetEquations<R> {
  using Base = TargetEquations<R>;

 public:
  using Problem = P;
  using Real = R;
  static constexpr std::size_t n = P::dimension;
  using V = Vector<Real, n>;
  using typename Base::Point;
  using typename Base::Variables;  // (K_i, L_i), stage after stage
  using Unknowns = Variables;
  using Memory = Variables;
  struct Setup {
    static constexpr const char* residual_name = "residual";
    LobattoOptions options;
    const LobattoPair<Real>* pair;
    Setup(const P&, const LobattoOptions& chosen) : options(chosen), pair(&lobatto_pair<Real>(chosen.stages)) {}
    MethodInfo info() const { return describe(options); }
    NewtonOptions newton() const { return options.newton(); }
    std::string detail() const { return std::to_string(options.stages) + " stages"; }
    template <class Archive>
    void archive(Archive&) {}
    /// E(U).
    template <std::size_t N, class S>
    Increment<S, N> increment(const Vector<S, dynamic>& u) const {
      const std::size_t size = u.size() / (2 * pair->b.size());
      Increment<S, N> sum{zeros<S, N>(size), zeros<S, N>(size)};
      for (std::size_t i = 0; i < pair->b.size(); ++i) {
        for (std::size_t a = 0; a < size; ++a) {
          sum.q[a] = sum.q[a] + u[2 * size * i + a];
          sum.p[a] = sum.p[a] + u[2 * size * i + size + a];
        }
      }
      return sum;
    }
  };

  LobattoStages(const Setup& setup, const P& problem, const Real& h, const V& q0, const V& p0, Effort& effort)
      : Base(h), setup_(setup), pair_(*setup.pair), problem_(problem), q0_(q0), p0_(p0), effort_(effort) {}

  const V& positions() const { return q0_; }
  const V& momenta() const { return p0_; }
  LobattoStages from(const V& q0, const V& p0) const { return LobattoStages(setup_, problem_, h_, q0, p0, effort_); }
  Variables last_state() const { return Variables(2 * q0_.size() * pair_.b.size()); }
  Variables predicted() const {
    const std::size_t size = q0_.size();
    V dq = zeros_like(q0_);
    V dp = zeros_like(q0_);
    gradient(problem_, q0_, p0_, dq, dp);
    ++effort_.gradient;
    Variables x = last_state();
    for (std::size_t i = 0; i < pair_.b.size(); ++i) {
      for (std::size_t a = 0; a < size; ++a) {
        x[2 * size * i + a] = (h_ * pair_.b[i]) * dp[a];
        x[2 * size * i + size + a] = -(h_ * pair_.b[i]) * dq[a];
      }
    }
    return x;
  }
  Variables started(const Memory& extrapolated) const { return extrapolated; }

  void evaluate(const Variables& x, Point& at) const {
    const std::size_t size = q0_.size();
    const std::size_t s = pair_.b.size();
    Base::clear(at, x.size());
    V dq = zeros_like(q0_);
    V dp = zeros_like(q0_);
    Matrix<Real, n> qq = zero_matrix(q0_);
    Matrix<Real, n> qp = qq;
    Matrix<Real, n> pp = qq;
    for (std::size_t i = 0; i < s; ++i) {
      const Increment<Real, n> y = stage(q0_, p0_, x, i);
      const Increment<Real, n> reach = terms_of_stage(x, i);
      gradient(problem_, y.q, y.p, dq, dp);
      if (at.linearised) hessian(problem_, y.q, y.p, qq, qp, pp);
      const Real part = detail::golden_ratio<Real>() * pair_.b[i];
      const Real weight = h_ * pair_.b[i];
      for (std::size_t a = 0; a < size; ++a) {
        const std::size_t k = 2 * size * i + a;
        const std::size_t l = k + size;
        at.sum[k] = part * dp[a];
        at.sum[l] = -part * dq[a];
        Real of_k = abs(dp[a]);
        Real of_l = abs(dq[a]);
        for (std::size_t b = 0; at.linearised && b < size; ++b) {
          of_k += abs(qp[b][a]) * reach.q[b] + abs(pp[a][b]) * reach.p[b];
          of_l += abs(qq[a][b]) * reach.q[b] + abs(qp[a][b]) * reach.p[b];
          for (std::size_t j = 0; j < s; ++j) {
            const std::size_t by_k = 2 * size * j + b;
            const std::size_t by_l = by_k + size;
            const Real of_q = weight * (Real(0.5) + pair_.nu[i * s + j]);
            const Real of_p = weight * (Real(0.5) - pair_.nu[j * s + i]);
            at.tangent[k][by_k] = -of_q * qp[b][a];
            at.tangent[k][by_l] = -of_p * pp[a][b];
            at.tangent[l][by_k] = of_q * qq[a][b];
            at.tangent[l][by_l] = of_p * qp[a][b];
          }
        }
        at.noise[k] = abs(weight) * of_k;
        at.noise[l] = abs(weight) * of_l;
      }
    }
    for (std::size_t k = 0; at.linearised && k < x.size(); ++k) at.tangent[k][k] += Real(1);
    effort_.gradient += static_cast<long long>(s);
    if (at.linearised) effort_.hessian += static_cast<long long>(s);
    Base::close(x, at);
  }

  Increment<Real, n> taken(Variables& x, const Point& at) const {
    x = at.target;
    return sum_of(x);
  }
  Increment<Real, n> taken(Variables& x, const Point& at, const Variables& correction) const {
    Base::move_to_target(x, at, correction);
    return sum_of(x);
  }
  Memory memory(const Variables& x, const Increment<Real, n>&) const { return x; }
  Unknowns unknowns(const Variables& x, const Increment<Real, n>&) const { return x; }

  template <class S>
  Vector<S, dynamic> residual(const Vector<S, n>& q0, const Vector<S, n>& p0, const Vector<S, dynamic>& x) const {
    const std::size_t size = q0.size();
    Vector<S, dynamic> r = x;
    Vector<S, n> dq = zeros_like(q0);
    Vector<S, n> dp = zeros_like(q0);
    for (std::size_t i = 0; i < pair_.b.size(); ++i) {
      const Increment<S, n> y = stage(q0, p0, x, i);
      gradient(problem_, y.q, y.p, dq, dp);
      const Real weight = h_ * pair_.b[i];
      for (std::size_t a = 0; a < size; ++a) {
        const std::size_t k = 2 * size * i + a;
        r[k] = weight * dp[a] - x[k];
        r[k + size] = -weight * dq[a] - x[k + size];
      }
    }
    return r;
  }

 private:
  using Base::h_;

  /// Q_i and P_i, summed from the middle of the step.
  template <class S>
  Increment<S, n> stage(const Vector<S, n>& q0, const Vector<S, n>& p0, const Vector<S, dynamic>& x,
                        std::size_t i) const {
    const std::size_t size = q0.size();
    const std::size_t s = pair_.b.size();
    Increment<S, n> y{q0, p0};
    for (std::size_t a = 0; a < size; ++a) {
      S half_q(Real(0));
      S half_p(Real(0));
      S inner_q(Real(0));
      S inner_p(Real(0));
      for (std::size_t j = 0; j < s; ++j) {
        const S& k = x[2 * size * j + a];
        const S& l = x[2 * size * j + size + a];
        half_q = half_q + k;
        half_p = half_p + l;
        inner_q = inner_q + pair_.nu[i * s + j] * k;
        inner_p = inner_p - pair_.nu[j * s + i] * l;
      }
      y.q[a] = (q0[a] + Real(0.5) * half_q) + inner_q;
      y.p[a] = (p0[a] + Real(0.5) * half_p) + inner_p;
    }
    return y;
  }
  /// The sizes of the terms of Q_i and P_i.
  Increment<Real, n> terms_of_stage(const Variables& x, std::size_t i) const {
    const std::size_t size = q0_.size();
    const std::size_t s = pair_.b.size();
    Increment<Real, n> reach{q0_, p0_};
    for (std::size_t a = 0; a < size; ++a) {
      reach.q[a] = abs(q0_[a]);
      reach.p[a] = abs(p0_[a]);
      for (std::size_t j = 0; j < s; ++j) {
        reach.q[a] += (Real(0.5) + abs(pair_.nu[i * s + j])) * abs(x[2 * size * j + a]);
        reach.p[a] += (Real(0.5) + abs(pair_.nu[j * s + i])) * abs(x[2 * size * j + size + a]);
      }
    }
    return reach;
  }
  Increment<Real, n> sum_of(const Variables& x) const { return setup_.template increment<n>(x); }

  const Setup& setup_;
  const LobattoPair<Real>& pair_;
  const P& problem_;
  const V& q0_;
  const V& p0_;
  Effort& effort_;
};

/// The recipe of lobatto-3a-3b: simulate(problem, Lobatto{{.stages = 3}}, q, p, h).
struct Lobatto {
  static constexpr bool implicit = true;
  static constexpr bool bijective = false;
  template <class P>
  static constexpr bool accepts = Smooth<P>;
  LobattoOptions options{};
  template <class P, class A>
  using Stepper = ImplicitMethod<P, A, LobattoStages<P, typename A::Real>>;
  template <class P, class A>
  Stepper<P, A> bind(const P& problem) const {
    return Stepper<P, A>(
        problem, for_unknowns(2 * degrees_of_freedom(problem) * static_cast<std::size_t>(options.stages), options));
  }
};

}  // namespace hamflow
