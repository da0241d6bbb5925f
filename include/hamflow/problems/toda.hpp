// Toda lattice of n masses on a ring, H = sum p_i^2/2 + sum exp(q_i - q_{i+1}), q_{n+1} = q_1: integrable, with n
// integrals, the first of which is the total momentum.   [HLW2006, Sect. X.1.5]
#pragma once

#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/problem_info.hpp"

namespace hamflow {

template <class R = double>
class Toda {
 public:
  using Real = R;
  static constexpr std::size_t dimension = dynamic;
  static constexpr bool quadratic_kinetic = true;

  explicit Toda(std::size_t n) : n_(n) {}
  Toda(const Parameters<R>& /*none*/, std::size_t size) : Toda(size) {}

  static ProblemInfo info() {
    return {.name = "toda",
            .formula = "H = sum p_i^2/2 + sum exp(q_i - q_{i+1}), q_{n+1} = q_1",
            .reference = "HLW2006, Sect. X.1.5",
            .coordinates = {"q1", "...", "qn"},
            .invariants = {{"momentum", "sum p_i", Components::one, Terms::momenta}},
            .region = {.centre = {0.3, -0.2, 0.5, 0.4, -0.3, 0.2}, .spread = 0.05, .step = 0.05}};
  }
  static std::string refused_size(const Parameters<R>&, std::size_t size) {
    return size >= 2 ? std::string() : "2 numbers or more, one for each mass";
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
    for (std::size_t i = 0; i < n_; ++i) sum += exp(q[i] - q[next(i)]);
    return sum;
  }
  template <class S>
  void velocity(const Vector<S, dynamic>& p, Vector<S, dynamic>& v) const {
    v = p;
  }
  template <class S>
  void force(const Vector<S, dynamic>& q, Vector<S, dynamic>& f) const {
    S before = exp(q[n_ - 1] - q[0]);
    for (std::size_t i = 0; i < n_; ++i) {
      const S after = exp(q[i] - q[next(i)]);
      f[i] = before - after;
      before = after;
    }
  }
  template <class S>
  void potential_hessian(const Vector<S, dynamic>& q, Matrix<S, dynamic>& hessian) const {
    hessian = zero_matrix(q);
    for (std::size_t i = 0; i < n_; ++i) {
      const std::size_t j = next(i);
      const S link = exp(q[i] - q[j]);
      hessian[i][i] += link;
      hessian[j][j] += link;
      hessian[i][j] -= link;
      hessian[j][i] -= link;
    }
  }
  template <class S>
  Vector<S, 1> invariants(const Vector<S, dynamic>&, const Vector<S, dynamic>& p, const S& /*t*/) const {
    S sum(0);
    for (const S& x : p) sum += x;
    return {sum};
  }

 private:
  std::size_t next(std::size_t i) const { return i + 1 < n_ ? i + 1 : 0; }
  std::size_t n_;
};

}  // namespace hamflow
