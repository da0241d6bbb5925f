// Energy and momentum together: eg(k), k = 1, 2, 3, for T = sum |p_i|^2/(2 m_i) and V a sum of phi(r^2) over pairs of
// bodies or about a centre.   [GrossBetschSteinmann2005]
//     P_l = p0 + sum_j mu_lj L_j,   Q_l = q0 + sum_j mu_lj K_j,   K_l = h b_l M^-1 P_l,   L_l = h b_l F_l,
//     z1 = z0 + sum_l (K_l, L_l),   mu_lj = a_lj/b_j of Gauss collocation,
// with forces along the lines between the bodies, so that linear and angular momentum are conserved, as quadratic
// invariants are by collocation. One factor for each pair and step (radial_pair.hpp) makes the work equal to the change
// of the potential, so that the energy is conserved. Order 2 k, symmetric, not symplectic. k = 1 is the scheme of
// [LaBuddeGreenspan1976]. Newton's method solves for L with the exact Jacobian.
#pragma once

#include <memory>
#include <vector>

#include "hamflow/detail/core/capability.hpp"
#include "hamflow/detail/methods/implicit/implicit_method.hpp"
#include "hamflow/detail/methods/implicit/large_systems.hpp"
#include "hamflow/detail/methods/implicit/radial_pair.hpp"
#include "hamflow/detail/methods/implicit/target.hpp"

namespace hamflow {

template <class P, class R>
class RadialCollocation : public TargetEquations<R> {
  using Base = TargetEquations<R>;

 public:
  using Problem = P;
  using Real = R;
  static constexpr std::size_t n = P::dimension;
  using V = Vector<Real, n>;
  using typename Base::Point;
  using typename Base::Variables;  // L, stage after stage
  using Unknowns = Variables;      // (K_l, L_l), stage after stage
  using Memory = Variables;
  struct Setup {
    static constexpr const char* residual_name = "residual";
    EgOptions options;
    GaussStages<Real> stages;
    std::size_t space;
    std::shared_ptr<const std::vector<RadialTerm<Real>>>
        terms;  // a block of steps copies its method without allocation
    RecordedLaw<Real> law;
    V inverse_mass;
    Setup(const P& problem, const EgOptions& chosen)
        : options(chosen),
          stages(chosen.degree),
          space(problem.radial_space()),
          terms(std::make_shared<const std::vector<RadialTerm<Real>>>(problem.radial_terms())),
          law(problem),
          inverse_mass(zeros<Real, n>(degrees_of_freedom(problem))) {
      V ones = inverse_mass;
      for (Real& each : ones) each = Real(1);
      velocity(problem, ones, inverse_mass);  // M is diagonal
    }
    MethodInfo info() const { return describe(options); }
    NewtonOptions newton() const { return options.newton(); }
    std::string detail() const {
      return std::to_string(options.degree) + (options.degree == 1 ? " Gauss point" : " Gauss points");
    }
    template <class Archive>
    void archive(Archive&) {}
    /// E(U).
    template <std::size_t N, class S>
    Increment<S, N> increment(const Vector<S, dynamic>& u) const {
      const std::size_t size = u.size() / (2 * stages.count);
      Increment<S, N> sum{zeros<S, N>(size), zeros<S, N>(size)};
      for (std::size_t l = 0; l < stages.count; ++l) {
        for (std::size_t i = 0; i < size; ++i) {
          sum.q[i] = sum.q[i] + u[2 * size * l + i];
          sum.p[i] = sum.p[i] + u[2 * size * l + size + i];
        }
      }
      return sum;
    }
  };

  RadialCollocation(const Setup& setup, const P& problem, const Real& h, const V& q0, const V& p0, Effort& effort)
      : Base(h), setup_(setup), problem_(problem), q0_(q0), p0_(p0), effort_(effort), k_(setup.stages.count) {}

  Variables last_state() const { return Variables(k_ * q0_.size()); }
  Variables predicted() const {
    V f = zeros_like(q0_);
    force(problem_, q0_, f);
    ++effort_.force;
    Variables x = last_state();
    for (std::size_t l = 0; l < k_; ++l) {
      for (std::size_t i = 0; i < f.size(); ++i) x[l * f.size() + i] = (h_ * setup_.stages.b[l]) * f[i];
    }
    return x;
  }
  Variables started(const Memory& extrapolated) const { return extrapolated; }

  void evaluate(const Variables& x, Point& at) const {
    const Variables velocities = velocities_of(p0_, x);
    const Variables moved = displacements(velocities);
    const Variables positions = positions_of(q0_, moved);
    const Reach reach{terms_of(q0_, moved), scaled(terms_of(p0_, x))};
    Base::clear(at, x.size());
    for (const RadialTerm<Real>& term : *setup_.terms) {
      const RadialPair<Real> pair = pair_of(term, q0_, positions, velocities, &reach);
      add_force(term, pair, reach, at);
      if (at.linearised) add_tangent(term, pair, at.tangent);
    }
    for (std::size_t i = 0; at.linearised && i < x.size(); ++i) at.tangent[i][i] += Real(1);
    effort_.force += static_cast<long long>(k_);
    if (at.linearised) effort_.hessian += static_cast<long long>(k_);
    Base::close(x, at);
  }

  Increment<Real, n> taken(Variables& x, const Point& at) const {
    x = at.target;
    return increment_of(x);
  }
  Increment<Real, n> taken(Variables& x, const Point& at, const Variables& correction) const {
    Base::move_to_target(x, at, correction);
    return increment_of(x);
  }
  Memory memory(const Variables& x, const Increment<Real, n>&) const { return x; }
  Unknowns unknowns(const Variables& x, const Increment<Real, n>&) const {
    const std::size_t size = q0_.size();
    const Variables moved = displacements(velocities_of(p0_, x));
    Unknowns all(2 * x.size());
    for (std::size_t l = 0; l < k_; ++l) {
      for (std::size_t i = 0; i < size; ++i) {
        all[2 * size * l + i] = moved[l * size + i];
        all[2 * size * l + size + i] = x[l * size + i];
      }
    }
    return all;
  }

  template <class S>
  Vector<S, dynamic> residual(const Vector<S, n>& q0, const Vector<S, n>& p0, const Vector<S, dynamic>& u) const {
    const std::size_t size = q0.size();
    Vector<S, dynamic> moved(k_ * size);
    Vector<S, dynamic> pushed(k_ * size);
    for (std::size_t l = 0; l < k_; ++l) {
      for (std::size_t i = 0; i < size; ++i) {
        moved[l * size + i] = u[2 * size * l + i];
        pushed[l * size + i] = u[2 * size * l + size + i];
      }
    }
    const Vector<S, dynamic> velocities = velocities_of(p0, pushed);
    const Vector<S, dynamic> positions = positions_of(q0, moved);
    Vector<S, dynamic> r = u;
    for (std::size_t l = 0; l < k_; ++l) {
      for (std::size_t i = 0; i < size; ++i) {
        r[2 * size * l + i] = (h_ * setup_.stages.b[l]) * velocities[l * size + i] - moved[l * size + i];
        r[2 * size * l + size + i] = -pushed[l * size + i];
      }
    }
    for (const RadialTerm<Real>& term : *setup_.terms) {
      const RadialPair<S> pair = pair_of(term, q0, positions, velocities);
      for (std::size_t l = 0; l < k_; ++l) {
        const S factor = (Real(-2) * h_ * setup_.stages.b[l] * term.strength) * pair.factor[l];
        for (std::size_t d = 0; d < setup_.space; ++d) {
          const S push = factor * pair.r[l][d];
          S& on_a = r[2 * size * l + size + term.a + d];
          on_a = on_a + push;
          if (term.b == term.centre) continue;
          S& on_b = r[2 * size * l + size + term.b + d];
          on_b = on_b - push;
        }
      }
    }
    return r;
  }

 private:
  using Base::h_;
  using D = Dual<Real, 3>;  // a derivative for each direction of space
  /// The sizes of the terms of positions and velocities, that is, their rounding in units of epsilon.
  struct Reach {
    Variables positions, velocities;
  };

  /// y0 + sum_j mu_lj rows_j, computed as (y0 + y1)/2 + sum_j N_lj rows_j, which is symmetric in the two ends.
  template <class S, std::size_t N>
  Vector<S, dynamic> stage_values(const Vector<S, N>& y0, const Vector<S, dynamic>& rows) const {
    const std::size_t size = y0.size();
    Vector<S, dynamic> all(rows.size());
    for (std::size_t i = 0; i < size; ++i) {
      S sum(Real(0));
      for (std::size_t j = 0; j < k_; ++j) sum = sum + rows[j * size + i];
      for (std::size_t l = 0; l < k_; ++l) {
        S inner(Real(0));
        for (std::size_t j = 0; j < k_; ++j) inner = inner + setup_.stages.inner[l][j] * rows[j * size + i];
        all[l * size + i] = (y0[i] + Real(0.5) * sum) + inner;
      }
    }
    return all;
  }
  Variables terms_of(const V& y0, const Variables& rows) const {
    const std::size_t size = y0.size();
    Variables all(rows.size());
    for (std::size_t l = 0; l < k_; ++l) {
      for (std::size_t i = 0; i < size; ++i) {
        all[l * size + i] = abs(y0[i]);
        for (std::size_t j = 0; j < k_; ++j) {
          all[l * size + i] += (Real(0.5) + abs(setup_.stages.inner[l][j])) * abs(rows[j * size + i]);
        }
      }
    }
    return all;
  }
  /// M^-1 times each stage.
  template <class S>
  Vector<S, dynamic> scaled(Vector<S, dynamic> v) const {
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = setup_.inverse_mass[i % q0_.size()] * v[i];
    return v;
  }
  template <class S>
  Vector<S, dynamic> velocities_of(const Vector<S, n>& p0, const Vector<S, dynamic>& pushed) const {
    return scaled(stage_values(p0, pushed));
  }
  template <class S>
  Vector<S, dynamic> positions_of(const Vector<S, n>& q0, const Vector<S, dynamic>& moved) const {
    return stage_values(q0, moved);
  }
  Variables displacements(const Variables& velocities) const {
    Variables moved = velocities;
    for (std::size_t i = 0; i < moved.size(); ++i) {
      moved[i] = (h_ * setup_.stages.b[i / q0_.size()]) * velocities[i];
    }
    return moved;
  }
  Increment<Real, n> increment_of(const Variables& x) const {
    const std::size_t size = q0_.size();
    const Variables v = velocities_of(p0_, x);
    Increment<Real, n> taken{zeros_like(q0_), zeros_like(q0_)};
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t l = 0; l < k_; ++l) {
        taken.q[i] += setup_.stages.b[l] * v[l * size + i];
        taken.p[i] += x[l * size + i];
      }
      taken.q[i] = h_ * taken.q[i];
    }
    return taken;
  }

  /// @param reach for the noise of the pair; may be null
  template <class S>
  RadialPair<S> pair_of(const RadialTerm<Real>& term, const Vector<S, n>& q0, const Vector<S, dynamic>& positions,
                        const Vector<S, dynamic>& velocities, const Reach* reach = nullptr) const {
    const std::size_t size = q0.size();
    const bool of_two = term.b != term.centre;
    RadialPair<S> pair;
    for (std::size_t d = 0; d < setup_.space; ++d) {
      pair.start[d] = of_two ? S(q0[term.a + d] - q0[term.b + d]) : q0[term.a + d];
      for (std::size_t l = 0; l < k_; ++l) {
        const std::size_t a = l * size + term.a + d;
        const std::size_t b = l * size + term.b + d;
        pair.r[l][d] = of_two ? S(positions[a] - positions[b]) : positions[a];
        pair.w[l][d] = of_two ? S(velocities[a] - velocities[b]) : velocities[a];
        if (reach == nullptr) continue;
        const auto both = [&](const Variables& y) { return of_two ? Real(y[a] + y[b]) : y[a]; };
        pair.reach[l] += Real(2) * (both(reach->positions) * abs(value_of(pair.w[l][d])) +
                                    abs(value_of(pair.r[l][d])) * both(reach->velocities));
      }
    }
    pair.complete(problem_, setup_.law, setup_.stages, h_, setup_.space, strength_of(term));
    return pair;
  }

  void add_force(const RadialTerm<Real>& term, const RadialPair<Real>& pair, const Reach& reach, Point& at) const {
    const std::size_t size = q0_.size();
    const Real two = Real(2) * term.strength;
    for (std::size_t l = 0; l < k_; ++l) {
      const Real weight = detail::golden_ratio<Real>() * setup_.stages.b[l];
      const Real bend = abs(two) * (abs(pair.law[l].first) + Real(2) * abs(pair.law[l].second) * pair.u[l]);
      for (std::size_t d = 0; d < setup_.space; ++d) {
        const Real push = two * pair.factor[l] * pair.r[l][d];
        const std::size_t a = l * size + term.a + d;
        const std::size_t b = term.b == term.centre ? a : l * size + term.b + d;
        const Real of_factor = abs(two * pair.r[l][d]) * pair.noise;
        const Real noise =
            abs(h_ * setup_.stages.b[l]) * (abs(push) + bend * (reach.positions[a] + reach.positions[b]) + of_factor);
        at.sum[a] -= weight * push;
        at.noise[a] += noise;
        if (a == b) continue;
        at.sum[b] += weight * push;
        at.noise[b] += noise;
      }
    }
  }

  /// dL_m changes the difference of velocities at point l by mu_lm delta, and that of positions by nu_lm delta, where
  /// delta is M^-1 dL_m of one body minus that of the other.
  void add_tangent(const RadialTerm<Real>& term, const RadialPair<Real>& pair, Matrix<Real, dynamic>& tangent) const {
    const GaussStages<Real>& s = setup_.stages;
    const std::size_t size = q0_.size();
    const auto mu = [&](std::size_t l, std::size_t j) { return Real(Real(0.5) + s.inner[l][j]); };
    for (std::size_t m = 0; m < k_; ++m) {
      Real nu[RadialPair<Real>::most]{};
      for (std::size_t l = 0; l < k_; ++l) {
        for (std::size_t j = 0; j < k_; ++j) nu[l] += h_ * mu(l, j) * s.b[j] * mu(j, m);
      }
      const RadialPair<D> moved = along(term, pair, m, nu);
      for (std::size_t l = 0; l < k_; ++l) {
        for (std::size_t i = 0; i < setup_.space; ++i) {
          const D push = moved.factor[l] * moved.r[l][i];
          for (std::size_t d = 0; d < setup_.space; ++d) {
            const Real change = Real(2) * term.strength * h_ * s.b[l] * push.slope[d];
            couple(term, l * size + i, m * size + d, change, tangent);
          }
        }
      }
    }
  }
  /// The pair as dual numbers along every delta = e_d of stage m.
  RadialPair<D> along(const RadialTerm<Real>& term, const RadialPair<Real>& pair, std::size_t m, const Real* nu) const {
    RadialPair<D> moved;
    for (std::size_t i = 0; i < setup_.space; ++i) {
      moved.start[i] = D(pair.start[i]);
      for (std::size_t l = 0; l < k_; ++l) {
        moved.r[l][i] = D(pair.r[l][i]);
        moved.w[l][i] = D(pair.w[l][i]);
      }
    }
    for (std::size_t l = 0; l < k_; ++l) {
      for (std::size_t d = 0; d < setup_.space; ++d) {
        moved.r[l][d].slope[d] = nu[l];
        moved.w[l][d].slope[d] = Real(0.5) + setup_.stages.inner[l][m];
      }
    }
    moved.complete(problem_, setup_.law, setup_.stages, h_, setup_.space, strength_of(term));
    return moved;
  }
  /// The strength divided by the reduced mass.
  Real strength_of(const RadialTerm<Real>& term) const {
    return term.strength *
           (setup_.inverse_mass[term.a] + (term.b == term.centre ? Real(0) : setup_.inverse_mass[term.b]));
  }
  void couple(const RadialTerm<Real>& term, std::size_t row, std::size_t column, const Real& change,
              Matrix<Real, dynamic>& tangent) const {
    const std::size_t d = column % q0_.size();
    const Real by_a = change * setup_.inverse_mass[term.a + d];
    tangent[row + term.a][column + term.a] += by_a;
    if (term.b == term.centre) return;
    const Real by_b = change * setup_.inverse_mass[term.b + d];
    tangent[row + term.b][column + term.a] -= by_a;
    tangent[row + term.a][column + term.b] -= by_b;
    tangent[row + term.b][column + term.b] += by_b;
  }

  const Setup& setup_;
  const P& problem_;
  const V& q0_;
  const V& p0_;
  Effort& effort_;
  const std::size_t k_;
};

/// The recipe of eg(k): simulate(problem, Eg{{.degree = 2}}, q, p, h).
struct Eg {
  static constexpr bool implicit = true;
  static constexpr bool bijective = false;
  static constexpr Capability capability_sets[] = {Capability::separable | Capability::quadratic_kinetic |
                                                   Capability::radial};
  template <class P>
  static constexpr bool accepts = RadialForces<P>;
  EgOptions options{};
  template <class P, class A>
  using Stepper = ImplicitMethod<P, A, RadialCollocation<P, typename A::Real>>;
  template <class P, class A>
  Stepper<P, A> bind(const P& problem) const {
    return Stepper<P, A>(problem,
                         for_unknowns(degrees_of_freedom(problem) * static_cast<std::size_t>(options.degree), options));
  }
};

}  // namespace hamflow
