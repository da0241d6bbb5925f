// What the elements in time share: options, quadrature rule, counters, and what is told about a step on request.
#pragma once

#include <string>

#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/method_info.hpp"
#include "hamflow/core/outcome.hpp"
#include "hamflow/methods/cg_options.hpp"
#include "hamflow/numerics/dense.hpp"
#include "hamflow/numerics/gauss_legendre.hpp"

namespace hamflow {

/// The unknowns of one step, q1 - q0 and p1 - p0.
template <class Real, std::size_t N>
struct Increment {
  Vector<Real, N> q{};
  Vector<Real, N> p{};
};

template <class Real>
struct ElementContext {
  CgOptions options;
  const GaussRule<Real>* rule;
  Effort effort{};
  StepDiagnostics diagnostics{};
};

/// The unit of rounding: a constant of the hardware's types, for others asked for where it stands.
template <class Real>
struct Epsilon {
  friend constexpr Real operator*(Epsilon, const Real& x) { return std::numeric_limits<Real>::epsilon() * x; }
};

/// Extrapolates a smooth sequence from its last three members: the first guess of a step. Part of a run's state.
template <class V>
class Extrapolation {
 public:
  bool empty() const { return remembered_ == 0; }
  void forget() { remembered_ = 0; }
  void remember(const V& x) {
    last_[2] = last_[1];
    last_[1] = last_[0];
    last_[0] = x;
    if (remembered_ < 3) ++remembered_;
  }
  void predict(V& x) const {
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] = remembered_ == 1   ? last_[0][i]
             : remembered_ == 2 ? 2 * last_[0][i] - last_[1][i]
                                : 3 * (last_[0][i] - last_[1][i]) + last_[2][i];
    }
  }
  template <class Archive>
  void archive(Archive& ar) {
    ar(last_, remembered_);
  }

 private:
  V last_[3]{};
  int remembered_ = 0;
};

namespace detail {

/// x0 + d/2. The points of the segment are middle + offset d with offsets symmetric to the last bit: were they
/// x0 + c d, the rounding of c would tilt every step the same way, by about epsilon d.V''d, and the energy would drift.
template <class Real, class S, std::size_t N>
Vector<S, N> midpoint(const Vector<S, N>& x0, const Vector<S, N>& d) {
  Vector<S, N> middle = zeros_like(x0);
  for (std::size_t i = 0; i < middle.size(); ++i) middle[i] = x0[i] + Real(0.5) * d[i];
  return middle;
}

template <class Real, class S, std::size_t N>
Vector<S, N> on_segment(const Vector<S, N>& middle, const Real& offset, const Vector<S, N>& d) {
  Vector<S, N> x = zeros_like(middle);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = middle[i] + offset * d[i];
  return x;
}

/// Out of line: strings in the middle of an iteration cost it its registers.
template <class Real>
[[gnu::noinline]] void note_residual(const Real& norm, int k, std::string& history) {
  history = (k > 0 ? history + ", " : "") + shortest(static_cast<double>(norm));
}

template <class Real, std::size_t N>
[[gnu::noinline]] void note_tangent(const Matrix<Real, N>& tangent, StepDiagnostics& out) {
  out.condition_tangent = static_cast<double>(condition_number(tangent));
  out.determinant_tangent = static_cast<double>(determinant(tangent));
}

}  // namespace detail

/// cond_inf(M^-1(q)), with M^-1 = d^2 H/dp^2.
template <class P, class Real, std::size_t N>
double inverse_mass_condition(const P& problem, const Vector<Real, N>& q, const Vector<Real, N>& p) {
  Matrix<Real, N> qq = zero_matrix(q);
  Matrix<Real, N> qp = qq;
  Matrix<Real, N> pp = qq;
  hessian(problem, q, p, qq, qp, pp);
  return static_cast<double>(condition_number(pp));
}

/// Whether Newton has come to where the rounding of the residual hides what is left. A correction below the noise is
/// noise itself. With a rate theta of decrease, quadratic convergence predicts theta^2 |correction| for the next one.
/// What is left undone has the same sign at the same phase of every orbit and adds up linearly, rounding only as a
/// square root: it has to lie so far below the noise that 10^6 steps (a walk of 10^3 noises) do not show it, hence
/// 1/1024. Where the noise is larger than its estimate, corrections stop to shrink: two in a row that do not, at a
/// hundred-millionth of the unknowns, are noise too.
/// @param size, before |correction| of this iteration and the one before, in the units of noise
/// @param stalls corrections in a row that did not shrink; counted here
template <class Real>
constexpr bool newton_at_rounding(const Real& size, const Real& before, bool first, const Real& noise, int& stalls) {
  const Real rate = !first && before > Real(0) ? size / before : Real(1);
  stalls = !first && rate > Real(0.9) ? stalls + 1 : 0;
  return size <= noise || (!first && rate * rate * size <= noise / 1024) || (rate > Real(0.5) && size <= 64 * noise) ||
         (stalls >= 2 && size <= Real(1 << 26) * noise);
}

}  // namespace hamflow
