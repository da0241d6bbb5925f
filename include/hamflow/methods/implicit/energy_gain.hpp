// What one more Gauss point sees of the energy that a step gains: how quadrature = "auto" judges.
#pragma once

#include "hamflow/core/derivatives.hpp"
#include "hamflow/methods/implicit/equations.hpp"

namespace hamflow::detail {

/// The rounding of a sum of work, that of its terms and that of the coordinates at which forces are evaluated, which
/// adds up as independent roundings do.
template <class Real>
struct RoundingOfWork {
  Real works{0};
  Real bends{0};
  /// @param bend (V'' d) q: the change of a force along the step times the coordinate
  void add(const Real& work, const Real& bend) {
    works += work * work;
    bends += bend * bend;
  }
  Real of_terms(int terms) const {
    constexpr auto epsilon = Epsilon<Real>{};
    return epsilon * Real(Real(terms) * sqrt(works) + Real(4) * sqrt(bends));
  }
};

/// What points see of the energy that a step gains, and what rounding makes of it.
template <class Real>
struct Gain {
  Real gain{0};
  Real size{0};   // of its terms
  Real noise{0};  // that rounding explains
};

/// Whether a rule of points overlooks energy that a step gains: one more point sees more than rounding explains, and
/// two more see the same. Where the estimate of rounding is too small, they see different noise. What the rule itself
/// sees of the energy is no fault of its points: it is the rounding of the solution, which in a stiff step is far more
/// than that of the work, and which every rule sees alike.
/// @param two_more(): the gain as two more points see it   @param has_two whether there are so many
/// @param own(): the gain as the rule itself sees it
template <class Real, class TwoMore, class Own>
bool overlooks_a_gain(const Gain<Real>& one, bool has_two, const TwoMore& two_more, const Own& own) {
  if (abs(one.gain) <= one.noise) return false;
  const Real of_solution = own();
  const bool rounds = abs(of_solution) <= one.size / (1 << 20);  // more is no rounding, of whatever step
  const Real overlooked = abs(rounds ? Real(one.gain - of_solution) : one.gain);
  if (overlooked <= one.noise) return false;
  if (overlooked > Real(4096) * one.noise || !has_two) return true;
  return abs(two_more() - one.gain) <= overlooked / 2;
}

template <class Real, class TwoMore>
bool overlooks_a_gain(const Gain<Real>& one, bool has_two, const TwoMore& two_more) {
  return overlooks_a_gain(one, has_two, two_more, [] { return Real(0); });
}

/// What H rounds by near a state: it has terms that cancel, of which those of the virial tell.
template <class P, class Real, std::size_t N>
Real size_of_terms(const P& problem, const Vector<Real, N>& q, const Vector<Real, N>& p) {
  Vector<Real, N> dq = zeros_like(q);
  Vector<Real, N> dp = zeros_like(p);
  gradient(problem, q, p, dq, dp);
  Real size = abs(energy(problem, q, p));
  for (std::size_t i = 0; i < q.size(); ++i) size += abs(q[i] * dq[i]) + abs(p[i] * dp[i]);
  return size;
}

/// Whether H has changed by 256 roundings of its terms along a step that no rule of points sees any gain in. Either
/// both rules are far from converged, so that what they see differs as noise does, or H is not smooth: where it has a
/// kink (abs(x)) beyond the outermost points, two rules agree about what neither has seen.
/// @param own(): the gain as the rule in use sees it, which is no more than the rounding of the solution
template <class P, class Real, std::size_t N, class Own>
bool overlooks_a_change(const P& problem, const Vector<Real, N>& q0, const Vector<Real, N>& p0,
                        const Increment<Real, N>& taken, const Own& own) {
  constexpr auto epsilon = Epsilon<Real>{};
  Vector<Real, N> q1 = q0;
  Vector<Real, N> p1 = p0;
  for (std::size_t i = 0; i < q1.size(); ++i) {
    q1[i] += taken.q[i];
    p1[i] += taken.p[i];
  }
  const Real before = energy(problem, q0, p0);
  const Real change = energy(problem, q1, p1) - before;
  constexpr int most_roundings = 256;
  if (abs(change) <= epsilon * Real(most_roundings * abs(before))) return false;  // most steps need to know no more
  const Real size = size_of_terms(problem, q0, p0);
  const Real explained = epsilon * Real(most_roundings * (size + size_of_terms(problem, q1, p1)));
  if (!(abs(change) > explained)) return false;
  return abs(change) > size / (1 << 20) || abs(change - own()) > explained;
}

}  // namespace hamflow::detail
