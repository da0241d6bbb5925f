// Explicit Runge-Kutta methods for z' = J grad H(z), any differentiable H.   [HLW2006, Sect. II.1.1] They are not
// geometric integrators and their energy drifts. They serve as references for comparisons.
#pragma once

#include <array>
#include <string_view>

#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/method_info.hpp"
#include "hamflow/core/outcome.hpp"
#include "hamflow/core/phase_point.hpp"

namespace hamflow {

/// A rational coefficient, exact in every arithmetic.
struct Ratio {
  int numerator = 0;
  int denominator = 1;
  constexpr bool is_zero() const { return numerator == 0; }
  template <class R>
  constexpr R as() const {
    return R(numerator) / R(denominator);
  }
};

/// A tableau whose matrix a is strictly lower triangular.
template <std::size_t S>
struct ButcherTableau {
  static constexpr std::size_t stages = S;
  std::string_view name;
  int order;
  std::string_view reference;
  std::array<std::array<Ratio, S>, S> a{};
  std::array<Ratio, S> b{};

  /// Whether no stage depends on a later one.
  constexpr bool is_explicit() const {
    for (std::size_t i = 0; i < S; ++i) {
      for (std::size_t j = i; j < S; ++j) {
        if (!a[i][j].is_zero()) return false;
      }
    }
    return true;
  }
  /// Whether the conditions of the first two orders hold, as far as the tableau claims them: sum b_i = 1 and
  /// sum b_i c_i = 1/2, c_i = sum a_ij.   [HLW2006, Sect. II.1.1]
  constexpr bool is_consistent() const {
    double weights = 0;
    double moments = 0;
    for (std::size_t i = 0; i < S; ++i) {
      double c = 0;
      for (std::size_t j = 0; j < i; ++j) c += a[i][j].template as<double>();
      weights += b[i].template as<double>();
      moments += b[i].template as<double>() * c;
    }
    const auto is = [](double sum, double wanted) { return sum > wanted - 1e-12 && sum < wanted + 1e-12; };
    return is(weights, 1) && (order < 2 || is(moments, 0.5));
  }
};

template <std::size_t S>
MethodInfo describe(const ButcherTableau<S>& tableau) {
  return {.name = std::string(tableau.name),
          .summary = "explicit Runge-Kutta, " + std::to_string(S) + (S > 1 ? " stages" : " stage"),
          .reference = std::string(tableau.reference),
          .order = tableau.order,
          .weakly_reversible = true,
          .forces_per_step = static_cast<int>(S)};
}

/// One step of the explicit Runge-Kutta method of a tableau.
template <class P, Arithmetic A, const auto& Tableau>
class RungeKutta {
 public:
  static_assert(Differentiable<P>,
                "hamflow: a Runge-Kutta method needs a Differentiable problem; one of dynamic size "
                "must define velocity and force, or gradient");
  static_assert(Tableau.is_explicit(),
                "hamflow: the matrix of an explicit Runge-Kutta tableau must be strictly lower triangular");
  static_assert(Tableau.is_consistent(),
                "hamflow: the weights of a Runge-Kutta tableau must sum to 1 and, for order 2 and more, weights times "
                "nodes to 1/2");
  static constexpr std::size_t n = P::dimension;
  static constexpr std::size_t stages = std::remove_cvref_t<decltype(Tableau)>::stages;
  using Real = typename A::Real;
  using Base = base_scalar<Real>;

  MethodInfo info() const { return describe(Tableau); }

  /// Always inlined into the loop over steps; otherwise the state would go through memory between two steps.
  [[gnu::always_inline]] Outcome step(const P& problem, const Base& h, PhasePoint<A, n>& z) {
    const Vector<Real, n> q0 = z.positions();
    const Vector<Real, n> p0 = z.momenta();
    std::array<Vector<Real, n>, stages> dq{};  // q' and p' of the stages
    std::array<Vector<Real, n>, stages> dp{};
    if constexpr (n == dynamic) {
      dq.fill(zeros_like(q0));
      dp.fill(zeros_like(q0));
    }
    for_each_stage([&]<std::size_t i>() __attribute__((always_inline)) {
      Vector<Real, n> q = q0;
      Vector<Real, n> p = p0;
      for_each_stage([&]<std::size_t j>() __attribute__((always_inline)) {
        if constexpr (j < i && !Tableau.a[i][j].is_zero()) {
          const Base factor = h * Tableau.a[i][j].template as<Base>();
          for (std::size_t k = 0; k < q.size(); ++k) {
            q[k] += factor * dq[j][k];
            p[k] += factor * dp[j][k];
          }
        }
      });
      ++evaluations_;
      motion(problem, q, p, dq[i], dp[i]);
    });
    Vector<Real, n> sum_q = zeros_like(q0);
    Vector<Real, n> sum_p = zeros_like(q0);
    for_each_stage([&]<std::size_t i>() __attribute__((always_inline)) {
      if constexpr (i + 1 < stages && !Tableau.b[i].is_zero()) {
        const Base weight = h * Tableau.b[i].template as<Base>();
        for (std::size_t k = 0; k < sum_q.size(); ++k) {
          sum_q[k] += weight * dq[i][k];
          sum_p[k] += weight * dp[i][k];
        }
      }
    });
    if constexpr (stages > 1) {
      z.move(sum_q);
      z.push(sum_p);
    }
    // The last stage is added separately, because the next step waits only for it.
    const Base weight = h * Tableau.b[stages - 1].template as<Base>();
    z.move(weight, dq[stages - 1]);
    z.push(weight, dp[stages - 1]);
    return Outcome::done;
  }

  static constexpr bool memory_depends_on_positions_only = true;
  void invalidate() {}
  Effort effort() const { return Separable<P> ? Effort{.force = evaluations_} : Effort{.gradient = evaluations_}; }
  template <class Archive>
  void archive(Archive& ar) {
    ar(evaluations_);
  }

 private:
  template <class F>
  [[gnu::always_inline]] static void for_each_stage(F&& f) {
    [&]<std::size_t... i>(std::index_sequence<i...>) __attribute__((always_inline)) {
      (f.template operator()<i>(), ...);
    }
    (std::make_index_sequence<stages>{});
  }

  long long evaluations_ = 0;
};

/// A Runge-Kutta method chosen by type.
template <const auto& Tableau>
struct RungeKuttaBy {
  template <class P>
  static constexpr bool accepts = Differentiable<P>;
  static constexpr bool implicit = false;
  static constexpr bool bijective = false;
  static constexpr bool typed = true;
  static constexpr bool recorded = true;
  template <class P, class A>
  using Stepper = RungeKutta<P, A, Tableau>;
  template <class P, class A>
  Stepper<P, A> bind(const P&) const {
    return {};
  }
};

}  // namespace hamflow
