// RATTLE, the step of Verlet on the manifold g(q) = 0 of a constrained motion: order 2, symmetric, symplectic on the
// tangent bundle of the manifold; and rattle4, its triple jump, of order 4.   [HLW2006, Sect. VII.1.4; Yoshida1990]
//     simulate(problem, Rattle{}, q, p, h);            problem: Constrained, T quadratic with constant M
//     simulate(problem, Rattle{{.order = 4}}, q, p, h);
// Newton's method iterates to the rounding of g, so that |g| and |g' M^-1 p| stay at rounding level in runs of any
// length.
#pragma once

#include "hamflow/detail/core/capability.hpp"
#include "hamflow/detail/core/pool.hpp"
#include "hamflow/detail/methods/implicit/implicit_method.hpp"
#include "hamflow/detail/methods/implicit/rattle_equations.hpp"

namespace hamflow {

struct RattleOptions {
  int order = 2;  // or 4
  NewtonOptions newton{};
};

inline MethodInfo describe(const RattleOptions& options) {
  const bool simple = options.order == 2;
  return {.name = simple ? "rattle" : "rattle4",
          .summary = simple ? "Verlet's step on a manifold, by multipliers" : "triple jump of rattle",
          .reference = simple ? "Andersen1983; HLW2006, Sect. VII.1.4" : "HLW2006, Sect. VII.1.4; Yoshida1990",
          .order = options.order,
          .explicit_step = false,
          .symplectic = true,
          .weakly_reversible = true,
          .symmetric = true,
          .reversible = true,
          .halves_steps = options.newton.halve,
          .diagnostics = options.newton.diagnostics};
}

/// One step: one part or, for order 4, three parts.
template <class P, Arithmetic A>
class RattleStep {
 public:
  static constexpr std::size_t n = P::dimension;
  using Real = typename A::Real;
  using Base = Real;
  using Part = ImplicitMethod<P, A, RattleEquations<P, Real>>;
  using Unknowns = typename Part::Unknowns;  // of all parts, one after the other
  using State = PhasePoint<A, n>;

  RattleStep(const P& problem, const RattleOptions& options) : options_(options) {
    const Real jump = evaluate_number<Real>("1/(2 - 2^(1/3))");
    lengths_ = options.order == 2 ? Parts<Real>{Real(1)} : Parts<Real>{jump, 1 - 2 * jump, jump};
    parts_.assign(lengths_.size(), Part(problem, options.newton));
  }

  MethodInfo info() const { return describe(options_); }
  Outcome step(const P& problem, const Base& h, State& z) { return counted(problem, h, z, nullptr); }
  Outcome step(const P& problem, const Base& h, State& z, Unknowns& unknowns) {
    return counted(problem, h, z, &unknowns);
  }
  void invalidate() {
    for (Part& part : parts_) part.invalidate();
  }
  /// Counts corrections of whole steps.
  Effort effort() const {
    Effort all = whole_;
    for (const Part& part : parts_) {
      const Effort own = part.effort();
      all.force += own.force;
      all.linear_solves += own.linear_solves;
      all.stagnated += own.stagnated;
      all.halved += own.halved;
    }
    return all;
  }
  template <class Archive>
  void archive(Archive& ar) {
    ar(whole_);
    for (Part& part : parts_) ar(part);
  }
  /// The diagnostics of the last part.
  StepDiagnostics diagnostics(const P& problem, const State& z) const { return parts_.back().diagnostics(problem, z); }
  std::string failure(const P& problem, const Base& h, const State& z) const {
    RattleStep again = *this;
    State copy = z;
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      const Base length = lengths_[k] * h;
      if (again.parts_[k].step(problem, length, copy) != Outcome::done) {
        return again.parts_[k].failure(problem, length, copy);
      }
    }
    return {};
  }

  template <class S, class U>
  U residual(const P& problem, const Base& h, Vector<S, n> q, Vector<S, n> p, const U& unknowns) const {
    U all = unknowns;
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      const U own = of_part(unknowns, k);
      const U r = parts_[k].template residual<S>(problem, Base(lengths_[k] * h), q, p, own);
      for (std::size_t i = 0; i < r.size(); ++i) all[k * r.size() + i] = r[i];
      const auto z = parts_[k].increment(own);
      for (std::size_t i = 0; i < q.size(); ++i) {
        q[i] = q[i] + z.q[i];
        p[i] = p[i] + z.p[i];
      }
    }
    return all;
  }
  template <class U>
  auto increment(const U& unknowns) const {
    auto sum = parts_[0].increment(of_part(unknowns, 0));
    for (std::size_t k = 1; k < parts_.size(); ++k) {
      const auto z = parts_[k].increment(of_part(unknowns, k));
      for (std::size_t i = 0; i < z.q.size(); ++i) {
        sum.q[i] = sum.q[i] + z.q[i];
        sum.p[i] = sum.p[i] + z.p[i];
      }
    }
    return sum;
  }

 private:
  Outcome counted(const P& problem, const Base& h, State& z, Unknowns* unknowns) {
    const State start = z;
    const long long before = effort().linear_solves;
    std::vector<Unknowns> all(unknowns == nullptr ? 0 : parts_.size());  // a step of a run does not allocate
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      const Base length = lengths_[k] * h;
      const Outcome outcome =
          unknowns == nullptr ? parts_[k].step(problem, length, z) : parts_[k].step(problem, length, z, all[k]);
      if (outcome == Outcome::done) continue;
      z = start;
      return outcome;
    }
    const long long solves = effort().linear_solves - before;
    whole_.solves_min = whole_.steps == 0 || solves < whole_.solves_min ? solves : whole_.solves_min;
    whole_.solves_max = solves > whole_.solves_max ? solves : whole_.solves_max;
    ++whole_.steps;
    if (unknowns == nullptr) return Outcome::done;
    *unknowns = Unknowns(parts_.size() * all[0].size());
    for (std::size_t k = 0; k < all.size(); ++k) {
      for (std::size_t i = 0; i < all[k].size(); ++i) (*unknowns)[k * all[k].size() + i] = all[k][i];
    }
    return Outcome::done;
  }
  template <class U>
  U of_part(const U& unknowns, std::size_t k) const {
    U own(unknowns.size() / parts_.size());
    for (std::size_t i = 0; i < own.size(); ++i) own[i] = unknowns[k * own.size() + i];
    return own;
  }

  /// Every block of steps works on a copy of the method, so copies must be cheap.
  template <class T>
  using Parts = std::vector<T, PoolAllocator<T>>;
  RattleOptions options_;
  Parts<Real> lengths_;  // lengths of the parts, in units of the step
  Parts<Part> parts_;
  Effort whole_{};
};

/// The recipe of both.
struct Rattle {
  static constexpr bool implicit = true;
  static constexpr bool bijective = false;
  static constexpr Capability capability_sets[] = {Capability::constrained | Capability::separable |
                                                   Capability::quadratic_kinetic};
  template <class P>
  static constexpr bool accepts = Constrained<P>&& QuadraticKinetic<P>;
  RattleOptions options{};
  template <class P, class A>
  using Stepper = RattleStep<P, A>;
  template <class P, class A>
  Stepper<P, A> bind(const P& problem) const {
    return Stepper<P, A>(problem, options);
  }
};

}  // namespace hamflow
