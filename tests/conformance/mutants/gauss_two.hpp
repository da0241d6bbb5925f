// Gauss collocation of two stages: the second user of the equations of a step, written as any new implicit method would
// be. Order 4, symplectic, symmetric.   [HLW, II.1.3]
//     L_i = h b_i f(Y_i),   Y_i = z0 + sum_j (a_ij/b_j) L_j,   z1 = z0 + sum_i L_i,   f = J grad H.
// The unknowns are the increments L_i, 2 x 2 n of them; nothing is eliminated.
#pragma once

#include "hamflow/core/derivatives.hpp"
#include "hamflow/detail/methods/implicit/implicit_method.hpp"

namespace hamflow::mutants {

struct GaussOptions {
  NewtonOptions newton{};
  double shift = 0;  // a fault: a_11 = 1/4 + shift, no more symplectic
};

template <class P, class R>
class GaussTwo {
 public:
  using Problem = P;
  using Real = R;
  static constexpr std::size_t n = P::dimension;
  static constexpr std::size_t stages = 2;
  using V = Vector<Real, n>;
  using Variables = Vector<Real, stages * 2 * n>;
  using Unknowns = Variables;
  using Memory = Variables;
  struct Setup {
    static constexpr const char* residual_name = "residual";
    GaussOptions options;
    Matrix<Real, stages> mu;  // a_ij/b_j
    Setup(const P&, const GaussOptions& chosen) : options(chosen) {
      const Real half = Real(1) / 2;
      const Real root = 1 / sqrt(Real(3));
      mu = {{{half + 2 * static_cast<Real>(options.shift), half - root}, {half + root, half}}};
    }
    MethodInfo info() const {
      return {.name = "gauss(2)",
              .summary = "Gauss collocation",
              .reference = "HLW, II.1.3",
              .order = 4,
              .explicit_step = false,
              .symplectic = true,
              .weakly_reversible = true,
              .symmetric = true,
              .reversible = true,
              .energy_conserving = Conservation::no};
    }
    NewtonOptions newton() const { return options.newton; }
    std::string detail() const { return "2 stages"; }
    template <class Archive>
    void archive(Archive&) {}
  };
  struct Point {
    Variables residual{};
    Variables target{};
    Variables noise{};
    Matrix<Real, stages * 2 * n> tangent{};
  };

  GaussTwo(const Setup& setup, const P& problem, const Real& h, const V& q0, const V& p0, Effort& effort)
      : setup_(setup), problem_(problem), h_(h), q0_(q0), p0_(p0), effort_(effort) {}

  Variables last_state() const { return {}; }
  Variables predicted() const {
    Variables all{};
    for (std::size_t i = 0; i < stages; ++i) put_field(q0_, p0_, i, all);
    ++effort_.gradient;
    return all;
  }
  Variables started(const Memory& memory) const { return memory; }

  void evaluate(const Variables& x, Point& at) const {
    at.tangent = {};
    for (std::size_t k = 0; k < x.size(); ++k) at.tangent[k][k] = Real(1);
    for (std::size_t i = 0; i < stages; ++i) {
      const Increment<Real, n> y = stage(q0_, p0_, x, i);
      put_field(y.q, y.p, i, at.target);
      Matrix<Real, n> qq{}, qp{}, pp{};
      hessian(problem_, y.q, y.p, qq, qp, pp);
      const Real weight = h_ / 2;
      for (std::size_t a = 0; a < n; ++a) {
        Real of_q(0), of_p(0);
        for (std::size_t b = 0; b < n; ++b) {
          of_q += abs(qp[b][a] * y.q[b]) + abs(pp[a][b] * y.p[b]);
          of_p += abs(qq[a][b] * y.q[b]) + abs(qp[a][b] * y.p[b]);
          for (std::size_t j = 0; j < stages; ++j) {
            const Real factor = weight * setup_.mu[i][j];
            at.tangent[row(i, a)][row(j, b)] -= factor * qp[b][a];
            at.tangent[row(i, a)][row(j, n + b)] -= factor * pp[a][b];
            at.tangent[row(i, n + a)][row(j, b)] += factor * qq[a][b];
            at.tangent[row(i, n + a)][row(j, n + b)] += factor * qp[a][b];
          }
        }
        at.noise[row(i, a)] = abs(weight) * of_q;
        at.noise[row(i, n + a)] = abs(weight) * of_p;
      }
    }
    for (std::size_t k = 0; k < x.size(); ++k) at.residual[k] = at.target[k] - x[k];
    effort_.gradient += static_cast<long long>(stages);
    effort_.hessian += static_cast<long long>(stages);
  }
  const auto& tangent(const Point& at) const { return at.tangent; }
  Real norm(const Variables&, const Point& at) const {
    Real sum(0);
    for (const Real& r : at.residual) sum += r * r;
    return sqrt(sum);
  }
  /// In units of the noise, coordinate by coordinate.
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
  Vector<S, stages * 2 * n> residual(const Vector<S, n>& q0, const Vector<S, n>& p0,
                                     const Vector<S, stages * 2 * n>& x) const {
    Vector<S, stages * 2 * n> r{};
    for (std::size_t i = 0; i < stages; ++i) {
      const Increment<S, n> y = stage(q0, p0, x, i);
      put_field(y.q, y.p, i, r);
    }
    for (std::size_t k = 0; k < x.size(); ++k) r[k] = r[k] - x[k];
    return r;
  }
  template <class S>
  static Increment<S, n> increment(const Vector<S, stages * 2 * n>& x) {
    Increment<S, n> u{};
    for (std::size_t a = 0; a < n; ++a) {
      u.q[a] = x[row(0, a)] + x[row(1, a)];
      u.p[a] = x[row(0, n + a)] + x[row(1, n + a)];
    }
    return u;
  }

 private:
  static constexpr std::size_t row(std::size_t i, std::size_t a) { return 2 * n * i + a; }
  template <class S>
  Increment<S, n> stage(const Vector<S, n>& q0, const Vector<S, n>& p0, const Vector<S, stages * 2 * n>& x,
                        std::size_t i) const {
    Increment<S, n> y{q0, p0};
    for (std::size_t j = 0; j < stages; ++j) {
      for (std::size_t a = 0; a < n; ++a) {
        y.q[a] += setup_.mu[i][j] * x[row(j, a)];
        y.p[a] += setup_.mu[i][j] * x[row(j, n + a)];
      }
    }
    return y;
  }
  /// h b_i f(q, p) as stage i of `all`.
  template <class S, std::size_t M>
  void put_field(const Vector<S, n>& q, const Vector<S, n>& p, std::size_t i, Vector<S, M>& all) const {
    Vector<S, n> dq{}, dp{};
    gradient(problem_, q, p, dq, dp);
    for (std::size_t a = 0; a < n; ++a) {
      all[row(i, a)] = (h_ / 2) * dp[a];
      all[row(i, n + a)] = -(h_ / 2) * dq[a];
    }
  }

  const Setup& setup_;
  const P& problem_;
  const Real h_;
  const V& q0_;
  const V& p0_;
  Effort& effort_;
};

struct Gauss {
  template <class P>
  static constexpr bool accepts = Smooth<P>;
  static constexpr bool implicit = true;
  static constexpr bool bijective = false;
  GaussOptions options{};
  template <class P, class A>
  using Stepper = ImplicitMethod<P, A, GaussTwo<P, typename A::Real>>;
  template <class P, class A>
  Stepper<P, A> bind(const P& problem) const {
    return Stepper<P, A>(problem, options);
  }
};

}  // namespace hamflow::mutants
