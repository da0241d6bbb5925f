// Chain of n masses between fixed ends, H = sum p_i^2/2 + sum V(q_{i+1} - q_i), V(r) = r^2/2 + alpha r^3/3 + beta
// r^4/4, q_0 = q_{n+1} = 0.   [FermiEtAl1955; HLW2006, Sect. I.5.1] For alpha = 0 V is even, for
// alpha = beta = 0 the chain is linear with frequencies 2 sin(k pi/(2 n + 2)).
#pragma once

#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/problem_info.hpp"

namespace hamflow {

template <class R = double>
class Fput {
 public:
  using Real = R;
  static constexpr std::size_t dimension = dynamic;
  static constexpr bool quadratic_kinetic = true;

  Fput(std::size_t n, R alpha, R beta) : n_(n), alpha_(alpha), beta_(beta) {}
  Fput(const Parameters<R>& given, std::size_t size) : Fput(size, given["alpha"], given["beta"]) {}

  static ProblemInfo info() {
    return {
        .name = "fput",
        .formula = "H = sum p_i^2/2 + sum (r_i^2/2 + alpha r_i^3/3 + beta r_i^4/4), r_i = q_{i+1} - q_i, fixed ends",
        .reference = "FermiEtAl1955",
        .coordinates = {"q1", "...", "qn"},
        .parameters = {{.name = "n", .meaning = "number of moving masses", .range = Range::count, .required = true},
                       {"alpha", "0", "coefficient of the cubic term of a link"},
                       {"beta", "0", "coefficient of the quartic term of a link"}},
        .region = {.parameters = {{"n", "4"}, {"alpha", "0.25"}, {"beta", "0.5"}},
                   .centre = {0.3, 0.4, -0.2, 0.2, 0.1, -0.2, 0.2, 0.1},
                   .spread = 0.05,
                   .step = 0.05}};
  }
  static std::string refused_size(const Parameters<R>& given, std::size_t size) {
    const double n = static_cast<double>(given["n"]);
    return static_cast<double>(size) == n ? std::string() : shortest(n) + " numbers, one for each mass";
  }

  std::size_t size() const { return n_; }

  template <class S>
  S kinetic(const Vector<S, dynamic>& p) const {
    S sum(0);
    for (const S& x : p) sum += x * x;
    return sum / R(2);
  }
  template <class S>
  S potential(const Vector<S, dynamic>& q) const {
    S sum(0);
    for (std::size_t i = 0; i <= n_; ++i) {
      const S r = link(q, i);
      // Named, because compilers evaluate factors in any order, and slopes of a recording depend on it.
      const S stiffness = R(1) / R(2) + r * (alpha_ / R(3) + r * (beta_ / R(4)));
      sum += r * r * stiffness;
    }
    return sum;
  }
  template <class S>
  void velocity(const Vector<S, dynamic>& p, Vector<S, dynamic>& v) const {
    v = p;
  }
  template <class S>
  void force(const Vector<S, dynamic>& q, Vector<S, dynamic>& f) const {
    S left = tension(link(q, 0));
    for (std::size_t i = 0; i < n_; ++i) {
      const S right = tension(link(q, i + 1));
      f[i] = right - left;
      left = right;
    }
  }
  template <class S>
  void force_and_hessian(const Vector<S, dynamic>& q, Vector<S, dynamic>& f, Matrix<S, dynamic>& hessian) const {
    force(q, f);
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t j = 0; j < n_; ++j) hessian[i][j] = S(0);
    }
    for (std::size_t i = 0; i <= n_; ++i) {
      const S r = link(q, i);
      const S stiffness = R(1) + r * (R(2) * alpha_ + r * (R(3) * beta_));
      if (i > 0) hessian[i - 1][i - 1] += stiffness;
      if (i < n_) hessian[i][i] += stiffness;
      if (i > 0 && i < n_) {
        hessian[i - 1][i] -= stiffness;
        hessian[i][i - 1] -= stiffness;
      }
    }
  }

 private:
  /// r_i = q_{i+1} - q_i with q_0 = q_{n+1} = 0.
  template <class S>
  S link(const Vector<S, dynamic>& q, std::size_t i) const {
    return (i < n_ ? q[i] : S(0)) - (i > 0 ? q[i - 1] : S(0));
  }
  /// V'(r).
  template <class S>
  S tension(const S& r) const {
    return r * (R(1) + r * (alpha_ + r * beta_));
  }

  std::size_t n_;
  R alpha_;
  R beta_;
};

}  // namespace hamflow
