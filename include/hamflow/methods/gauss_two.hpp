// Gauss collocation of two stages, for any H.   [HLW2006, Sect. II.1.3]
//     L_i = h b_i f(Y_i),   Y_i = z0 + sum_j (a_ij/b_j) L_j,   z1 = z0 + sum_i L_i,   f = J grad H.
// Order 4, symplectic, symmetric; linear and quadratic invariants are conserved. The unknowns are the increments
// L_1, L_2 of the stages, so that z1 - z0 is their sum; nothing is eliminated.
#pragma once

#include "hamflow/core/capability.hpp"
#include "hamflow/core/derivatives.hpp"
#include "hamflow/methods/implicit/implicit_method.hpp"

namespace hamflow {

inline MethodInfo describe_gauss_two(const NewtonOptions& options) {
  return {.name = "gauss2",
          .summary = "Gauss collocation of two stages",
          .reference = "HLW2006, Sect. II.1.3",
          .order = 4,
          .explicit_step = false,
          .symplectic = true,
          .weakly_reversible = true,
          .symmetric = true,
          .reversible = true,
          .halves_steps = options.halve,
          .diagnostics = options.diagnostics};
}

/// The equations of one step, see equations.hpp.
template <class P, class R>
class GaussTwoEquations {
 public:
  using Problem = P;
  using Real = R;
  static constexpr std::size_t n = P::dimension;
  static constexpr std::size_t stages = 2;
  static constexpr std::size_t m = n == dynamic ? dynamic : stages * 2 * n;
  using V = Vector<Real, n>;
  using Variables = Vector<Real, m>;  // L_1 in q, in p, L_2 in q, in p
  using Unknowns = Variables;
  using Memory = Variables;
  struct Setup {
    static constexpr const char* residual_name = "residual";
    NewtonOptions options;
    Matrix<Real, stages> mu;  // a_ij/b_j
    Setup(const P&, const NewtonOptions& chosen) : options(chosen) {
      const Real half = Real(1) / 2;
      const Real root = 1 / sqrt(Real(3));
      mu = {{{half, half - root}, {half + root, half}}};
    }
    MethodInfo info() const { return describe_gauss_two(options); }
    NewtonOptions newton() const { return options; }
    std::string detail() const { return "2 stages"; }
    template <class Archive>
    void archive(Archive&) {}
  };
  struct Point {
    Variables residual{};
    Variables target{};  // what the increments should be, h b_i f(Y_i)
    Variables noise{};   // what the target rounds by, in units of epsilon
    Matrix<Real, m> tangent{};
  };

  GaussTwoEquations(const Setup& setup, const P& problem, const Real& h, const V& q0, const V& p0, Effort& effort)
      : setup_(setup), problem_(problem), h_(h), q0_(q0), p0_(p0), effort_(effort) {}

  Variables last_state() const { return zeros<Real, m>(2 * stages * q0_.size()); }
  Variables predicted() const {
    Variables all = last_state();
    for (std::size_t i = 0; i < stages; ++i) put_field(q0_, p0_, i, all);
    effort_.gradient += static_cast<long long>(stages);
    return all;
  }
  Variables started(const Memory& memory) const { return memory; }

  void evaluate(const Variables& x, Point& at) const {
    at.target = last_state();
    at.noise = at.target;
    at.residual = at.target;
    at.tangent = zero_matrix(x);
    for (std::size_t i = 0; i < stages; ++i) add_stage(i, x, at);
    for (std::size_t k = 0; k < x.size(); ++k) {
      at.residual[k] = at.target[k] - x[k];
      at.tangent[k][k] += Real(1);
    }
    effort_.gradient += static_cast<long long>(stages);
    effort_.hessian += static_cast<long long>(stages);
  }
  const Matrix<Real, m>& tangent(const Point& at) const { return at.tangent; }
  Real norm(const Variables&, const Point& at) const {
    Real sum(0);
    for (const Real& r : at.residual) sum += r * r;
    return sqrt(sum);
  }
  /// The largest correction in units of its noise: q and p have units of their own.
  Correction<Real> measure(const Variables& x, const Point& at, const Variables& correction) const {
    constexpr auto epsilon = Epsilon<Real>{};
    Real distance(0);
    for (std::size_t k = 0; k < x.size(); ++k) {
      const Real size = abs(correction[k]);
      Real unit = epsilon * Real(at.noise[k] + abs(at.target[k]) + abs(x[k]));
      if (!(unit > epsilon * Real(epsilon * size))) unit = epsilon * size;  // at 0 so far, without noise of its own
      distance = larger(distance, Real(size / larger(unit, std::numeric_limits<Real>::min())));
    }
    return {distance, Real(1)};
  }

  Increment<Real, n> taken(Variables& x, const Point& at) const {
    x = at.target;
    return increment(x);
  }
  /// The target at x + correction to second order: correction - tangent correction is what it changes by.
  Increment<Real, n> taken(Variables& x, const Point& at, const Variables& correction) const {
    x = at.target;
    for (std::size_t k = 0; k < x.size(); ++k) {
      Real change = correction[k];
      for (std::size_t j = 0; j < x.size(); ++j) change -= at.tangent[k][j] * correction[j];
      x[k] += change;
    }
    return increment(x);
  }
  Memory memory(const Variables& x, const Increment<Real, n>&) const { return x; }
  Unknowns unknowns(const Variables& x, const Increment<Real, n>&) const { return x; }

  template <class S>
  Vector<S, m> residual(const Vector<S, n>& q0, const Vector<S, n>& p0, const Vector<S, m>& x) const {
    Vector<S, m> r = zeros_like(x);
    for (std::size_t i = 0; i < stages; ++i) {
      const Increment<S, n> y = stage(q0, p0, x, i);
      put_field(y.q, y.p, i, r);
    }
    for (std::size_t k = 0; k < x.size(); ++k) r[k] = r[k] - x[k];
    return r;
  }
  template <class S>
  static Increment<S, n> increment(const Vector<S, m>& x) {
    const std::size_t size = x.size() / (2 * stages);
    Increment<S, n> u{zeros<S, n>(size), zeros<S, n>(size)};
    for (std::size_t a = 0; a < size; ++a) {
      u.q[a] = x[a] + x[2 * size + a];
      u.p[a] = x[size + a] + x[3 * size + a];
    }
    return u;
  }

 private:
  template <class S>
  Increment<S, n> stage(const Vector<S, n>& q0, const Vector<S, n>& p0, const Vector<S, m>& x, std::size_t i) const {
    const std::size_t size = q0.size();
    Increment<S, n> y{q0, p0};
    for (std::size_t j = 0; j < stages; ++j) {
      for (std::size_t a = 0; a < size; ++a) {
        y.q[a] += setup_.mu[i][j] * x[2 * size * j + a];
        y.p[a] += setup_.mu[i][j] * x[2 * size * j + size + a];
      }
    }
    return y;
  }
  /// h b_i f(q, p) as stage i of `all`.
  template <class S>
  void put_field(const Vector<S, n>& q, const Vector<S, n>& p, std::size_t i, Vector<S, m>& all) const {
    const std::size_t size = q.size();
    Vector<S, n> dq = zeros_like(q);
    Vector<S, n> dp = zeros_like(q);
    gradient(problem_, q, p, dq, dp);
    for (std::size_t a = 0; a < size; ++a) {
      all[2 * size * i + a] = (h_ / 2) * dp[a];
      all[2 * size * i + size + a] = -(h_ / 2) * dq[a];
    }
  }
  /// The rows of stage i: its target, its noise, and the derivative of -target.
  void add_stage(std::size_t i, const Variables& x, Point& at) const {
    const std::size_t size = q0_.size();
    const Increment<Real, n> y = stage(q0_, p0_, x, i);
    put_field(y.q, y.p, i, at.target);
    Matrix<Real, n> qq = zero_matrix(q0_);
    Matrix<Real, n> qp = qq;
    Matrix<Real, n> pp = qq;
    hessian(problem_, y.q, y.p, qq, qp, pp);
    const Real weight = h_ / 2;
    for (std::size_t a = 0; a < size; ++a) {
      const std::size_t of_q = 2 * size * i + a;
      const std::size_t of_p = of_q + size;
      for (std::size_t b = 0; b < size; ++b) {
        at.noise[of_q] += abs(weight) * (abs(qp[b][a] * y.q[b]) + abs(pp[a][b] * y.p[b]));
        at.noise[of_p] += abs(weight) * (abs(qq[a][b] * y.q[b]) + abs(qp[a][b] * y.p[b]));
        for (std::size_t j = 0; j < stages; ++j) {
          const Real factor = weight * setup_.mu[i][j];
          const std::size_t by_q = 2 * size * j + b;
          const std::size_t by_p = by_q + size;
          at.tangent[of_q][by_q] -= factor * qp[b][a];
          at.tangent[of_q][by_p] -= factor * pp[a][b];
          at.tangent[of_p][by_q] += factor * qq[a][b];
          at.tangent[of_p][by_p] += factor * qp[a][b];
        }
      }
    }
  }

  const Setup& setup_;
  const P& problem_;
  const Real h_;
  const V& q0_;
  const V& p0_;
  Effort& effort_;
};

/// The recipe: GaussTwo{NewtonOptions{.tolerance = 1e-12}}.
struct GaussTwo {
  static constexpr bool implicit = true;
  static constexpr bool bijective = false;
  static constexpr Capability faces[] = {Capability::smooth};
  template <class P>
  static constexpr bool accepts = Smooth<P>;
  NewtonOptions options{};
  template <class P, class A>
  using Stepper = ImplicitMethod<P, A, GaussTwoEquations<P, typename A::Real>>;
  template <class P, class A>
  Stepper<P, A> bind(const P& problem) const {
    return Stepper<P, A>(problem, options);
  }
};

}  // namespace hamflow
