// A small cg(1,5) of its own, sound or with one fault.   [Gross1999, (2.61)-(2.64)]
#pragma once

#include <limits>

#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/method_info.hpp"
#include "hamflow/core/outcome.hpp"
#include "hamflow/core/phase_point.hpp"
#include "hamflow/detail/methods/implicit/segment.hpp"

namespace hamflow::mutants {

struct ElementFaults {
  std::string name = "cg(1,5), sound";
  int quadrature = 5;
  bool momentum_from_positions = false;  // p1 = (2/h) M (q1 - q0) - p0
  double tangent_factor = 0.5;           // K = I + factor h^2 M^-1 int alpha V''
  int iterations = 50;                   // then the step is taken whatever the residual is
  double weight_error = 0;               // relative, of the first quadrature weight alone
  Conservation claim = Conservation::up_to_quadrature;
};

template <class P, Arithmetic A>
class Element {
 public:
  static constexpr std::size_t n = P::dimension;
  using Real = typename A::Real;
  using Base = Real;
  using Q = Vector<Real, n>;
  using Unknowns = Vector<Real, 2 * n>;  // z1 - z0
  Element(const P& problem, ElementFaults faults)
      : faults_(std::move(faults)),
        rule_(gauss_rule<Real>(faults_.quadrature)),
        mass_(inverse(inverse_mass_matrix(problem))) {
    rule_.b[0] *= Real(1) + static_cast<Real>(faults_.weight_error);
  }

  MethodInfo info() const {
    MethodInfo claims = describe(CgOptions{.quadrature = faults_.quadrature});
    claims.name = faults_.name;
    claims.energy_conserving = faults_.claim;
    return claims;
  }

  Outcome step(const P& problem, const Real& h, PhasePoint<A, n>& z) {
    Unknowns unused;
    return step(problem, h, z, unused);
  }
  Outcome step(const P& problem, const Real& h, PhasePoint<A, n>& z, Unknowns& unknowns) {
    const Q q0 = z.positions();
    const Q p0 = z.momenta();
    Q d{};
    Q mean{};
    velocity(problem, p0, d);
    for (Real& x : d) x *= h;
    Real previous = std::numeric_limits<Real>::max();
    long long solves = 0;
    for (int k = 0; k < faults_.iterations; ++k) {
      Matrix<Real, n> stiffness{};
      integrate(problem, q0, d, mean, stiffness);
      const Q target = displacement(problem, h, p0, mean);
      Q r{};
      Matrix<Real, n> tangent{};
      for (std::size_t j = 0; j < n; ++j) {
        r[j] = target[j] - d[j];
        Q column{};
        velocity(problem, stiffness[j], column);
        for (std::size_t i = 0; i < n; ++i) {
          tangent[i][j] = static_cast<Real>(faults_.tangent_factor) * h * h * column[i] + (i == j ? Real(1) : Real(0));
        }
      }
      const Q correction = solve(tangent, r);
      ++solves;
      for (std::size_t i = 0; i < n; ++i) d[i] += correction[i];
      const Real size = max_norm(correction);
      const bool rounding = size <= 64 * std::numeric_limits<Real>::epsilon() * max_norm(d);
      if (rounding && size >= previous / 2) break;
      previous = size;
    }
    Matrix<Real, n> unused{};
    integrate(problem, q0, d, mean, unused);
    count(solves);
    z.move(Real(1), d);
    if (faults_.momentum_from_positions) {
      const Q q1 = z.positions();
      for (std::size_t i = 0; i < n; ++i) d[i] = q1[i] - q0[i];
      Q change = apply(mass_, d);
      for (std::size_t i = 0; i < n; ++i) change[i] = Real(2) / h * change[i] - Real(2) * p0[i];
      z.push(Real(1), change);
    } else {
      z.push(h, mean);
    }
    const Q q1 = z.positions();
    const Q p1 = z.momenta();
    for (std::size_t i = 0; i < n; ++i) {
      unknowns[i] = q1[i] - q0[i];
      unknowns[n + i] = p1[i] - p0[i];
    }
    return Outcome::done;
  }

  template <class S>
  Vector<S, 2 * n> residual(const P& problem, const Real& h, const Vector<S, n>& q0, const Vector<S, n>& p0,
                            const Vector<S, 2 * n>& unknowns) const {
    const Increment<S, n> u = increment(unknowns);
    Increment<S, n> r;
    Vector<S, n> mean{};
    for (std::size_t l = 0; l < rule_.b.size(); ++l) {
      Vector<S, n> q{};
      Vector<S, n> f{};
      for (std::size_t i = 0; i < n; ++i) q[i] = q0[i] + rule_.c[l] * u.q[i];
      force(problem, q, f);
      for (std::size_t i = 0; i < n; ++i) mean[i] += rule_.b[l] * f[i];
    }
    Vector<S, n> middle{};
    Vector<S, n> v{};
    for (std::size_t i = 0; i < n; ++i) middle[i] = p0[i] + (h / 2) * mean[i];
    velocity(problem, middle, v);
    for (std::size_t i = 0; i < n; ++i) {
      r.q[i] = h * v[i] - u.q[i];
      r.p[i] = h * mean[i] - u.p[i];
    }
    return detail::stacked(r.q, r.p);
  }
  template <class S>
  static Increment<S, n> increment(const Vector<S, 2 * n>& unknowns) {
    return detail::halves<n>(unknowns);
  }

  void invalidate() {}
  Effort effort() const { return effort_; }

 private:
  void integrate(const P& problem, const Q& q0, const Q& d, Q& mean, Matrix<Real, n>& stiffness) {
    mean = {};
    for (std::size_t l = 0; l < rule_.b.size(); ++l) {
      Q q{};
      Q f{};
      Matrix<Real, n> hessian{};
      for (std::size_t i = 0; i < n; ++i) q[i] = q0[i] + d[i] / 2 + rule_.offset[l] * d[i];
      force_and_hessian(problem, q, f, hessian);
      for (std::size_t i = 0; i < n; ++i) {
        mean[i] += rule_.b[l] * f[i];
        for (std::size_t j = 0; j < n; ++j) stiffness[i][j] += rule_.b[l] * rule_.c[l] * hessian[i][j];
      }
    }
    effort_.force += rule_.points;
    effort_.hessian += rule_.points;
  }
  static Q displacement(const P& problem, const Real& h, const Q& p0, const Q& mean) {
    Q middle{};
    Q v{};
    for (std::size_t i = 0; i < n; ++i) middle[i] = p0[i] + (h / 2) * mean[i];
    velocity(problem, middle, v);
    for (Real& x : v) x *= h;
    return v;
  }
  void count(long long solves) {
    effort_.linear_solves += solves;
    effort_.solves_max = larger(effort_.solves_max, solves);
    ++effort_.steps;
  }

  ElementFaults faults_;
  GaussRule<Real> rule_;
  Matrix<Real, n> mass_;
  Effort effort_;
};

struct ElementBy {
  template <class P>
  static constexpr bool accepts = QuadraticKinetic<P>;
  static constexpr bool implicit = true;
  static constexpr bool bijective = false;
  ElementFaults faults;
  template <class P, class A>
  using Stepper = Element<P, A>;
  template <class P, class A>
  Stepper<P, A> bind(const P& problem) const {
    return Stepper<P, A>(problem, faults);
  }
};

}  // namespace hamflow::mutants
