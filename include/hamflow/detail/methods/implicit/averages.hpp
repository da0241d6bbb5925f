// Shared by the solvers for averages (average_table.hpp): options, coefficients, and the equation that all of them
// solve, which the verification differentiates.
#pragma once

#include <string>

#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/error.hpp"
#include "hamflow/detail/methods/cg_options.hpp"
#include "hamflow/detail/methods/gauss_options.hpp"
#include "hamflow/detail/methods/implicit/average_table.hpp"
#include "hamflow/detail/methods/implicit/equations.hpp"
#include "hamflow/detail/methods/implicit/segment.hpp"

namespace hamflow {

/// Elements of any degree, or Gauss collocation in stages.
struct AverageOptions {
  CgOptions element{};  // for stages: the common options; degree and quadrature are the number of stages
  bool in_stages = false;

  AverageOptions(const CgOptions& options) : element(options) {}  // NOLINT: implicit conversion is intended
  AverageOptions(const GaussOptions& o)                           // NOLINT
      : element{.degree = o.stages,
                .quadrature = o.stages,
                .tolerance = o.tolerance,
                .seed_criterion = o.seed_criterion,
                .max_iterations = o.max_iterations,
                .halve = o.halve,
                .diagnostics = o.diagnostics,
                .iteration = o.iteration},
        in_stages(true) {}
  MethodInfo info() const {
    if (!in_stages) return describe(element);
    return describe(GaussOptions{.stages = element.degree,
                                 .halve = element.halve,
                                 .diagnostics = element.diagnostics,
                                 .iteration = element.iteration});
  }
};

/// Options and coefficients, which "auto" refines during a run.
template <class Real>
class AverageSetup {
 public:
  static constexpr const char* residual_name = "residual";
  explicit AverageSetup(const AverageOptions& options) : options_(options) {  // NOLINT: restart() sets the rest
    restart();
  }
  /// Resets to the points of a new run.
  void restart() { use(options_.element.quadrature > 0 ? options_.element.quadrature : options_.element.degree); }

  MethodInfo info() const { return options_.info(); }
  NewtonOptions newton() const {
    const CgOptions& o = options_.element;
    return {o.tolerance, o.seed_criterion, o.max_iterations, o.halve, o.diagnostics, o.iteration};
  }
  const AverageTable<Real>& table() const { return *table_; }
  std::string detail() const {
    return std::to_string(table().points) + (options_.in_stages ? " stage" : " Gauss point") +
           (table().points == 1 ? "" : "s");
  }

  /// Whether the map conserves the energy up to its quadrature; with as many points as averages it is symplectic
  /// instead.
  bool conserves() const { return finer_ != nullptr && table().points > table().averages; }
  bool automatic() const { return options_.element.quadrature == 0; }
  /// The table with one point more, for elements with fewer points than the maximum.
  const AverageTable<Real>& finer() const { return *finer_; }
  /// Returns the table with two more points. @pre such a rule exists
  const AverageTable<Real>& finest() const { return element_table<Real>(table().averages, table().points + 2); }
  /// Adds a point; returns false at the limit, since the test needs one point more.
  bool refine() {
    if (table().points >= most_gauss_points - 1) return false;
    use(table().points + 1);
    return true;
  }
  std::string no_finer_rule_message() const {
    return "the force varies so much along the step, or the step is so stiff, that " + detail() +
           " do not keep the energy error at rounding level; a fixed number as method.quadrature skips this test";
  }
  int current_rule() const { return table().points; }
  void return_to(int points) {
    if (points != table().points) use(points);
  }
  template <class Archive>
  void archive(Archive& ar) {
    int points = table().points;
    ar(points);
    if constexpr (Archive::reading) {
      if (points < table().averages || points > most_gauss_points) {
        throw Error("the saved bytes hold an impossible number of Gauss points");
      }
      if (points != table().points) use(points);
    }
  }

  /// E(U).
  template <std::size_t N, class S>
  Increment<S, N> increment(const Vector<S, dynamic>& u) const {
    const std::size_t n = u.size() / (2 * static_cast<std::size_t>(table().averages));
    Increment<S, N> sum{zeros<S, N>(n), zeros<S, N>(n)};
    for (std::size_t j = 0; j < table().increment.size(); ++j) {
      for (std::size_t a = 0; a < n; ++a) {
        sum.q[a] += table().increment[j] * u[a * table().increment.size() + j];
        sum.p[a] += table().increment[j] * u[(n + a) * table().increment.size() + j];
      }
    }
    return sum;
  }

 protected:
  const AverageTable<Real>* table_ = nullptr;

 private:
  void use(int points) {
    const int averages = options_.element.degree;
    table_ = options_.in_stages ? &stage_table<Real>(averages) : &element_table<Real>(averages, points);
    finer_ = options_.in_stages || points == most_gauss_points ? nullptr : &element_table<Real>(averages, points + 1);
  }

  AverageOptions options_;
  const AverageTable<Real>* finer_ = nullptr;
};

/// The initial guess: averages of the polynomial that extrapolates the last step. Part of the state of a run.
template <class V>
class Continued {
 public:
  bool empty() const { return last_.size() == 0; }
  void forget() { last_ = V{}; }
  void remember(const V& averages) { last_ = averages; }
  const V& predicted() const { return last_; }
  template <class Archive>
  void archive(Archive& ar) {
    ar(last_);
  }

 private:
  V last_{};
};

/// r_i = h sum_l W_il f(y_l) - u_i for any H. The k averages of a coordinate are contiguous: those of q_a begin at a k,
/// those of p_a at (n + a) k.
template <class P, class R>
class AverageEquations {
 public:
  using Problem = P;
  using Real = R;
  static constexpr std::size_t n = P::dimension;
  using V = Vector<Real, n>;
  using Unknowns = Vector<Real, dynamic>;
  using Variables = Vector<Real, dynamic>;
  using Memory = Variables;
  using Guesses = Continued<Memory>;

  template <class S>
  Vector<S, dynamic> residual(const Vector<S, n>& q0, const Vector<S, n>& p0, const Vector<S, dynamic>& u) const {
    const std::size_t size = q0.size();
    const std::size_t k = k_;
    const std::size_t s = s_;
    Vector<S, n> middle_q = q0;
    Vector<S, n> middle_p = p0;
    for (std::size_t j = 0; j < k; ++j) {
      const Real half = table_.increment[j] / Real(2);
      for (std::size_t a = 0; a < size; ++a) {
        middle_q[a] += half * u[a * k + j];
        middle_p[a] += half * u[(size + a) * k + j];
      }
    }
    Vector<S, dynamic> r = u;
    for (std::size_t i = 0; i < r.size(); ++i) r[i] = -u[i];
    Vector<S, n> dq = zeros_like(q0);
    Vector<S, n> dp = zeros_like(q0);
    for (std::size_t l = 0; l < s; ++l) {
      Vector<S, n> q = middle_q;
      Vector<S, n> p = middle_p;
      for (std::size_t j = 0; j < k; ++j) {
        for (std::size_t a = 0; a < size; ++a) {
          q[a] += table_.inner[j * s + l] * u[a * k + j];
          p[a] += table_.inner[j * s + l] * u[(size + a) * k + j];
        }
      }
      gradient(problem_, q, p, dq, dp);
      for (std::size_t i = 0; i < k; ++i) {
        const Real weight = h_ * table_.weight[l * k + i];
        for (std::size_t a = 0; a < size; ++a) {
          r[a * k + i] += weight * dp[a];
          r[(size + a) * k + i] -= weight * dq[a];
        }
      }
    }
    return r;
  }

 protected:
  AverageEquations(const P& problem, const Real& h, const AverageTable<Real>& table)
      : problem_(problem),
        h_(h),
        unit_(h / detail::golden_ratio<Real>()),
        table_(table),
        s_(static_cast<std::size_t>(table.points)),
        k_(static_cast<std::size_t>(table.averages)) {}

  const P& problem_;
  const Real h_;
  const Real unit_;  // h/kappa, see detail::golden_ratio
  const AverageTable<Real>& table_;
  const std::size_t s_;
  const std::size_t k_;
};

}  // namespace hamflow
