// Energy-conserving Petrov-Galerkin finite elements in time, cg(1).   [Gross1999, (1.43), (1.44), (2.61)-(2.64)]
//     q1 - q0 = h M^-1 (p0 + p1)/2,      p1 - p0 = h F,     F = -int_0^1 V'(q0 + alpha d) dalpha,  d = q1 - q0,
// for H = p^T M^-1 p/2 + V(q). With exact quadrature V(q1) - V(q0) = -d.F and the first equation gives the same amount
// of kinetic energy: H is conserved, exactly for polynomials V of degree <= 2 s with s Gauss points, to the error of
// the quadrature else. Order 2, symmetric. s = 1 is the implicit midpoint rule (symplectic, not energy-conserving). p
// is eliminated: Newton runs in d alone, on r(d) = h M^-1 (p0 + h F/2) - d with the exact tangent
//     K = I + (h^2/2) M^-1 int alpha V''(q0 + alpha d) dalpha.
// p1 is p0 + h F, never 2 M d/h - p0, which would amplify rounding by 2 M/h. Increments are added with compensation.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/method_info.hpp"
#include "hamflow/core/outcome.hpp"
#include "hamflow/core/phase_point.hpp"
#include "hamflow/methods/cg_options.hpp"
#include "hamflow/numerics/dense.hpp"
#include "hamflow/numerics/gauss_legendre.hpp"

namespace hamflow {

/// One step of cg(1). What it remembers (the last mean forces, from which the first guess is extrapolated, and the
/// number of quadrature points in "auto") is part of a run's state.
template <class P, Arithmetic A>
class ContinuousGalerkin {
 public:
  static_assert(
      QuadraticKinetic<P>,
      "hamflow: cg with p eliminated needs a QuadraticKinetic problem: H = p^T M^-1 p/2 + V(q) with constant M, "
      "declared by quadratic_kinetic = true");
  static_assert(TwiceDifferentiable<P>, "hamflow: cg needs a TwiceDifferentiable problem: its Newton uses V''");
  static_assert(
      !A::exact_undo,
      "hamflow: the lattice needs an explicit splitting method: an implicit step is no bijection of the lattice");
  static constexpr std::size_t n = P::dimension;
  using Real = typename A::Real;
  using Base = Real;

  ContinuousGalerkin(const P& problem, const CgOptions& options)
      : options_(options),
        rule_(&gauss_rule<Real>(options.quadrature > 0 ? options.quadrature : 1)),
        mass_(inverse(inverse_mass_matrix(problem))) {}

  MethodInfo info() const { return describe(options_); }

  Outcome step(const P& problem, const Base& h, PhasePoint<A, n>& z) {
    const long long before = effort_.linear_solves;
    const Outcome outcome = attempt(problem, h, z, 0, nullptr);
    if (outcome != Outcome::done) return outcome;
    const long long solves = effort_.linear_solves - before;
    effort_.solves_min = effort_.steps == 0 || solves < effort_.solves_min ? solves : effort_.solves_min;
    effort_.solves_max = solves > effort_.solves_max ? solves : effort_.solves_max;
    ++effort_.steps;
    return outcome;
  }

  void invalidate() { remembered_ = 0; }
  Effort effort() const { return effort_; }
  int quadrature() const { return rule_->points; }

  /// Repeats the step that failed and tells how its residual went. Changes nothing.
  std::string failure(const P& problem, const Base& h, const PhasePoint<A, n>& z) const {
    ContinuousGalerkin again = *this;
    PhasePoint<A, n> copy = z;
    std::string history;
    again.options_.halve = false;
    (void)again.attempt(problem, h, copy, 0, &history);
    const std::string points = std::to_string(again.quadrature()) + " Gauss points";
    if (options_.quadrature == 0 && again.quadrature() == most_gauss_points - 1) {
      return "the force varies so much along the step that " + points + " do not keep the energy at rounding level";
    }
    return "Newton did not converge in " + std::to_string(options_.max_iterations) +
           (options_.max_iterations == 1 ? " iteration" : " iterations") + " with " + points +
           (options_.halve ? ", nor in ten halvings of the step" : "") +
           "; residual (2.63) per iteration of the whole step: " + history;
  }

  /// The equations of the step for any number type: r = 0 and p1 - p0. The verification differentiates them.
  template <class S>
  void equations(const P& problem, const Base& h, const Vector<S, n>& q0, const Vector<S, n>& p0, const Vector<S, n>& d,
                 Vector<S, n>& r, Vector<S, n>& p_increment) const {
    Vector<S, n> mean{};
    const Vector<S, n> middle_point = midpoint(q0, d);
    for (std::size_t l = 0; l < rule_->c.size(); ++l) {
      Vector<S, n> q{};
      Vector<S, n> f{};
      for (std::size_t i = 0; i < n; ++i) q[i] = middle_point[i] + rule_->offset[l] * d[i];
      force(problem, q, f);
      for (std::size_t i = 0; i < n; ++i) mean[i] += rule_->b[l] * f[i];
    }
    Vector<S, n> middle{};
    Vector<S, n> v{};
    for (std::size_t i = 0; i < n; ++i) {
      middle[i] = p0[i] + (h / 2) * mean[i];
      p_increment[i] = h * mean[i];
    }
    velocity(problem, middle, v);
    for (std::size_t i = 0; i < n; ++i) r[i] = h * v[i] - d[i];
  }

 private:
  static constexpr Real epsilon = std::numeric_limits<Real>::epsilon();
  static constexpr int deepest_halving = 10;

  /// The step, or, when it does not converge and halving is allowed, two steps of half its length.
  Outcome attempt(const P& problem, const Real& h, PhasePoint<A, n>& z, int depth, std::string* history) {
    const Vector<Real, n> q0 = z.positions();
    const Vector<Real, n> p0 = z.momenta();
    Vector<Real, n> impulse = guess(problem, h, q0);
    Vector<Real, n> d = displacement(problem, h, p0, impulse);
    Outcome outcome = converge(problem, h, q0, p0, d, impulse, history);
    if (options_.quadrature == 0) {
      const GaussRule<Real>* const before = rule_;
      while (outcome == Outcome::done && quadrature_too_coarse(problem, h, q0, d, impulse)) {
        if (rule_->points ==
            most_gauss_points - 1) {  // one more is needed to judge: the step is too long for the force
          outcome = Outcome::not_converged;
          break;
        }
        rule_ = &gauss_rule<Real>(rule_->points + 1);
        outcome = converge(problem, h, q0, p0, d, impulse, history);
      }
      if (outcome != Outcome::done && history == nullptr) rule_ = before;  // the points of a step that was not taken
    }
    if (outcome == Outcome::done) {
      z.move(Real(1), d);
      z.push(Real(1), impulse);
      remember(impulse);
      return outcome;
    }
    if (!options_.halve || depth == deepest_halving) return outcome;
    const PhasePoint<A, n> start = z;
    invalidate();
    for (int half = 0; half < 2; ++half) {
      outcome = attempt(problem, h / 2, z, depth + 1, history);
      if (outcome != Outcome::done) {
        z = start;
        return outcome;
      }
    }
    if (depth == 0) ++effort_.halved;
    invalidate();  // the remembered impulses belong to another step length
    return outcome;
  }

  /// Newton from d. On success impulse is h F at the solution.
  Outcome converge(const P& problem, const Real& h, const Vector<Real, n>& q0, const Vector<Real, n>& p0,
                   Vector<Real, n>& d, Vector<Real, n>& impulse, std::string* history) {
    Real previous(0);          // |correction| of the iteration before
    bool at_rounding = false;  // no further correction can be told from rounding
    // |h M^-1 p0|: what the target rounds by, however far p0 and the impulse cancel at a turning point.
    const Real flight = max_norm(displacement(problem, h, p0, Vector<Real, n>{}));
    for (int k = 0;; ++k) {
      Matrix<Real, n> stiffness{};
      integrate(problem, h, q0, d, impulse, stiffness);
      const Vector<Real, n> target = displacement(problem, h, p0, impulse);
      Vector<Real, n> r{};
      for (std::size_t i = 0; i < n; ++i) r[i] = target[i] - d[i];
      if (options_.tolerance || history != nullptr) {
        const Real norm = seed_residual(h, q0, d, r);
        if (history != nullptr) note(norm, k, *history);
        if (options_.tolerance) {
          if (norm < static_cast<Real>(*options_.tolerance)) return Outcome::done;
          if (at_rounding && !options_.seed_criterion) {
            ++effort_.stagnated;
            return Outcome::done;
          }
        }
      }
      if (k == options_.max_iterations) return Outcome::not_converged;

      const Vector<Real, n> correction = solve(tangent(problem, h, stiffness), r);
      ++effort_.linear_solves;
      for (std::size_t i = 0; i < n; ++i) {
        d[i] += correction[i];
        Real change(0);
        for (std::size_t j = 0; j < n; ++j) change += stiffness[i][j] * correction[j];
        impulse[i] -= h * change;  // h F at the new d, to second order
      }
      // The residual cannot be computed better than this; a correction of that size is noise. With a rate theta of
      // decrease, quadratic convergence predicts theta^2 |correction| for the next one. What is left undone has the
      // same sign at the same phase of every orbit and adds up linearly, rounding only as a square root: it has to lie
      // so far below the noise that 10^6 steps (a walk of 10^3 noises) do not show it, hence 1/1024.
      const Real size = max_norm(correction);
      const Real noise = epsilon * (larger(flight, max_norm(target)) + max_norm(d));
      if (!(size <= std::numeric_limits<Real>::max())) return Outcome::not_converged;  // not finite
      const Real rate = k > 0 && previous > Real(0) ? size / previous : Real(1);
      at_rounding =
          size <= noise || (k > 0 && rate * rate * size <= noise / 1024) || (rate > Real(0.5) && size <= 64 * noise);
      if (at_rounding && !options_.tolerance) {
        // d + correction has just been rounded, mostly to the target of the *old* impulse: an error with the sign of
        // the correction, hence a drift (4e-20 a step at H = -0.25, measured). The new impulse gives d afresh.
        d = displacement(problem, h, p0, impulse);
        return Outcome::done;
      }
      previous = size;
    }
  }

  /// Out of line: strings in the middle of the iteration cost it its registers.
  [[gnu::noinline]] static void note(const Real& norm, int k, std::string& history) {
    history = (k > 0 ? history + ", " : "") + shortest(static_cast<double>(norm));
  }

  /// q0 + d/2. The points of the segment are middle + offset d with offsets symmetric to the last bit: were they
  /// q0 + c d, the rounding of c would tilt every step the same way, by about epsilon d.V''d, and the energy would
  /// drift.
  template <class S>
  static Vector<S, n> midpoint(const Vector<S, n>& q0, const Vector<S, n>& d) {
    Vector<S, n> middle{};
    for (std::size_t i = 0; i < n; ++i) middle[i] = q0[i] + Real(0.5) * d[i];
    return middle;
  }

  /// impulse = -h int V'(q0 + alpha d), stiffness = int alpha V''(q0 + alpha d). The points of a block come first, side
  /// by side, so that the compiler can evaluate several at once in vector registers; then the sums, point after point.
  /// h is multiplied into the weights, so that the increment of p is a plain sum of the points' contributions.
  [[gnu::always_inline]] void integrate(const P& problem, const Real& h, const Vector<Real, n>& q0,
                                        const Vector<Real, n>& d, Vector<Real, n>& impulse,
                                        Matrix<Real, n>& stiffness) {
    constexpr std::size_t block = 32;  // more than a step commonly has; shorter ones get unrolled to no good
    const auto s = static_cast<std::size_t>(rule_->points);
    Real forces[n][block];
    Real hessians[n][n][block];
    Vector<Real, n> sum{};
    const Vector<Real, n> middle = midpoint(q0, d);
    constexpr Real half = Real(1) / Real(2);
    for (std::size_t first = 0; first < s; first += block) {
      const Real* offset = rule_->offset.data() + first;
      const Real* b = rule_->b.data() + first;
      const std::size_t count = s - first < block ? s - first : block;
      for (std::size_t l = 0; l < count; ++l) {
        Vector<Real, n> q{};
        Vector<Real, n> f{};
        Matrix<Real, n> hessian{};
        for (std::size_t i = 0; i < n; ++i) q[i] = middle[i] + offset[l] * d[i];
        force_and_hessian(problem, q, f, hessian);
        const Real force_weight = h * b[l];
        const Real weight = b[l] * (half + offset[l]);
        for (std::size_t i = 0; i < n; ++i) {
          forces[i][l] = force_weight * f[i];
          for (std::size_t j = 0; j < n; ++j) hessians[i][j][l] = weight * hessian[i][j];
        }
      }
      for (std::size_t l = 0; l < count; ++l) {
        for (std::size_t i = 0; i < n; ++i) {
          sum[i] += forces[i][l];
          for (std::size_t j = 0; j < n; ++j) stiffness[i][j] += hessians[i][j][l];
        }
      }
    }
    impulse = sum;
    effort_.force += rule_->points;
    effort_.hessian += rule_->points;
  }

  Matrix<Real, n> tangent(const P& problem, const Real& h, const Matrix<Real, n>& stiffness) const {
    Matrix<Real, n> k{};
    const Real factor = h * h / 2;
    for (std::size_t j = 0; j < n; ++j) {
      Vector<Real, n> column{};
      velocity(problem, stiffness[j], column);  // M^-1 applied to column j; stiffness is symmetric
      for (std::size_t i = 0; i < n; ++i) k[i][j] = factor * column[i];
      k[j][j] += Real(1);
    }
    return k;
  }

  /// h M^-1 (p0 + impulse/2).
  static Vector<Real, n> displacement(const P& problem, const Real& h, const Vector<Real, n>& p0,
                                      const Vector<Real, n>& impulse) {
    Vector<Real, n> middle{};
    Vector<Real, n> v{};
    for (std::size_t i = 0; i < n; ++i) middle[i] = p0[i] + Real(0.5) * impulse[i];
    velocity(problem, middle, v);
    for (std::size_t i = 0; i < n; ++i) v[i] = h * v[i];
    return v;
  }

  /// The 2-norm of the seed's residual (2.63), (2/h) M (d - h M^-1 (p0 + h F/2)). The seed's programs iterate in q1 and
  /// form d = q1 - q0 anew, which is what limits their residual to about (2/h) M |q| epsilon; so does its criterion
  /// here.
  Real seed_residual(const Real& h, const Vector<Real, n>& q0, const Vector<Real, n>& d, Vector<Real, n> r) const {
    if (options_.seed_criterion) {
      for (std::size_t i = 0; i < n; ++i) r[i] += d[i] - ((q0[i] + d[i]) - q0[i]);
    }
    const Vector<Real, n> scaled = apply(mass_, r);
    Real sum(0);
    for (std::size_t i = 0; i < n; ++i) sum += scaled[i] * scaled[i];
    return abs(Real(2) / h) * sqrt(sum);
  }

  /// Whether one more point changes the work done by the mean force, which is the energy error of the step, by more
  /// than rounding can: two sums of at most s + 1 terms round by less than s + 4 units of |F| <= |F(middle)| + |V''|
  /// |d|, the forces by what rounded coordinates make of them, |V''| |q| epsilon, three times that where terms cancel
  /// as in a Lennard-Jones well. A bias of that size adds up to some tens of roundings of H over a part of an orbit,
  /// however small h is; one in units of H would add up to 1/h of them.
  bool quadrature_too_coarse(const P& problem, const Real& h, const Vector<Real, n>& q0, const Vector<Real, n>& d,
                             const Vector<Real, n>& impulse) {
    const GaussRule<Real>& finer = gauss_rule<Real>(rule_->points + 1);
    const Vector<Real, n> middle = midpoint(q0, d);
    Vector<Real, n> f{};
    Matrix<Real, n> hessian{};
    force_and_hessian(problem, middle, f, hessian);
    Real rounding(0);
    for (std::size_t i = 0; i < n; ++i) {
      Real units = Real(finer.points + 4) * abs(f[i]);
      for (std::size_t j = 0; j < n; ++j) {
        units += abs(hessian[i][j]) * (3 * abs(middle[j]) + Real(finer.points + 4) * abs(d[j]));
      }
      rounding += epsilon * abs(d[i]) * units;
    }
    Real difference(0);
    for (std::size_t l = 0; l < finer.c.size(); ++l) {
      Vector<Real, n> q{};
      for (std::size_t i = 0; i < n; ++i) q[i] = middle[i] + finer.offset[l] * d[i];
      force(problem, q, f);
      for (std::size_t i = 0; i < n; ++i) difference += finer.b[l] * d[i] * (f[i] - impulse[i] / h);
    }
    effort_.force += finer.points + 1;
    ++effort_.hessian;
    return abs(difference) > rounding;
  }

  /// The impulse of this step, extrapolated from the last three; at the start, that of the force at q0.
  Vector<Real, n> guess(const P& problem, const Real& h, const Vector<Real, n>& q0) {
    Vector<Real, n> f{};
    if (remembered_ == 0) {
      force(problem, q0, f);
      for (std::size_t i = 0; i < n; ++i) f[i] = h * f[i];
      ++effort_.force;
    } else {
      for (std::size_t i = 0; i < n; ++i) {
        f[i] = remembered_ == 1   ? last_[0][i]
               : remembered_ == 2 ? 2 * last_[0][i] - last_[1][i]
                                  : 3 * (last_[0][i] - last_[1][i]) + last_[2][i];
      }
    }
    return f;
  }
  void remember(const Vector<Real, n>& impulse) {
    last_[2] = last_[1];
    last_[1] = last_[0];
    last_[0] = impulse;
    if (remembered_ < 3) ++remembered_;
  }

  CgOptions options_;
  const GaussRule<Real>* rule_;
  Matrix<Real, n> mass_;
  Vector<Real, n> last_[3]{};
  int remembered_ = 0;
  Effort effort_;
};

/// The recipe of cg: Cg{CgOptions{.quadrature = 5}}.
struct Cg {
  static constexpr bool implicit = true;
  static constexpr bool bijective = false;
  CgOptions options{};
  template <class P, class A>
  using Stepper = ContinuousGalerkin<P, A>;
  template <class P, class A>
  Stepper<P, A> bind(const P& problem) const {
    return Stepper<P, A>(problem, options);
  }
};

}  // namespace hamflow
