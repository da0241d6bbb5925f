// One pair of bodies, or a body and the centre, in a step of eg(k): the force factor that conserves the energy.
// [GrossBetschSteinmann2005] With u(t) = |r|^2 along the trial polynomial, its value and rate at k Gauss points u_l,
// u'_l, the pair's force is -2 (phi'_l + lambda u'_l) r_l. It does the work -[phi(u1) - phi(u0)] exactly if
//     lambda = (phi(u1) - phi(u0) - h sum_l b_l phi'_l u'_l)/(h sum_l b_l u'_l^2).
// u' has degree 2 k - 1, so that u1 - u0 = h sum b_l u'_l, and with the divided difference phi[u0, u1] and
// g_l = phi[u0, u1] - phi'_l, (x, y) = sum b_l x_l y_l,
//     lambda u' = u' (u', g)/(u', u'),
// the projection of g on u', without cancellation of energies; for k = 1 it is g itself.
//
// It has no limit at u' = 0, that is, at rest and on a circle: there it depends on the direction of u', and steps near
// such states have no solution. u' (u', g)/(u', u') + chi [g - u' (u', g)/(u', u')] does the same work for any chi. chi
// = 1 gives g itself, so that the factor is phi[u0, u1] and a circle remains a circle. With
//     rho = |u'|/(the change of u' if g is added to the factor),
// chi is 1 for rho < 2, 0 for rho > 8, and a polynomial with two continuous
// derivatives in between. g is replaced by its value for u' = 0, phi'[u0, u1] s_l, where s_l = u_l - u0 - h sum_j a_lj
// u'_j is the collocation error in u, of order k + 1 in h. For rho > 8 the step is exactly the definition: on an
// ellipse with e = 0.1 and 63 steps per period rho is at least 15 000, with e = 0.6 and 21 steps at least 12.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "hamflow/detail/core/radial_forces.hpp"
#include "hamflow/detail/methods/eg_options.hpp"
#include "hamflow/detail/numerics/tape_replay.hpp"

namespace hamflow {

/// The law at a number, or along a dual number; only the value of phi''.
template <class P, class S>
RadialLaw<S> law_at(const P& problem, const S& u) {
  if constexpr (IsDual<S>::value) {
    const auto law = problem.radial_law(u.value);
    return {detail::chain(u, law.value, law.first), detail::chain(u, law.first, law.second), S(law.second)};
  } else {
    return problem.radial_law(u);
  }
}

/// phi and phi' on tapes, for their divided differences: one tape for each branch of a law (such as a cut-off) that has
/// been reached.
template <class R>
class RecordedLaw {
 public:
  template <class P>
  explicit RecordedLaw(const P& problem) {
    tapes_[0] = recorded(problem, R(5) / R(7));
  }
  /// phi[a, b] and phi'[a, b]. If a branch lies between a and b, the plain difference of the values is used: its
  /// rounding, divided by b - a, does the work of a rounding of phi.
  template <class P, class S>
  std::pair<S, S> differences(const P& problem, const S& a, const S& b) const {
    std::pair<S, S> found;
    if (on_any(a, b, found)) return found;
    if (!on_any(a, a, found)) {
      // The least recently used tape is removed.
      std::move_backward(tapes_.begin(), tapes_.end() - 1, tapes_.end());
      tapes_[0] = recorded(problem, R(value_of(a)));
      if (on(*tapes_[0], a, b, found)) return found;
    }
    const RadialLaw<S> first = law_at(problem, a), second = law_at(problem, b);
    return {(second.value - first.value) / (b - a), (second.first - first.first) / (b - a)};
  }

 private:
  using Recorded = std::shared_ptr<const Tape<R>>;

  template <class P>
  static Recorded recorded(const P& problem, const R& u) {
    Recorder<R> recorder(Folding::exact);
    const auto law = problem.radial_law(recorder.input(u));
    return std::make_shared<const Tape<R>>(recorder.finish({law.value, law.first}));
  }
  template <class S>
  bool on_any(const S& a, const S& b, std::pair<S, S>& found) const {
    return std::any_of(tapes_.begin(), tapes_.end(),
                       [&](const Recorded& tape) { return tape && on(*tape, a, b, found); });
  }
  /// @return false if a or b lies on another side of a branch
  template <class S>
  static bool on(const Tape<R>& tape, const S& a, const S& b, std::pair<S, S>& found) {
    Vector<Slope<S>, dynamic> nodes(tape.nodes.size());
    nodes[0] = Slope<S>(a, b, S(R(1)));
    if (!replay(tape, nodes)) return false;
    const auto slope = [&](std::size_t k) { return nodes[static_cast<std::size_t>(tape.outputs[k])].slope; };
    found = {slope(0), slope(1)};
    return true;
  }

  mutable std::array<Recorded, 4> tapes_;  // they follow from the law and are not part of the state of a run
};

/// Weights of k Gauss points, and N = A B^-1 - 1/2, antisymmetric.   [HLW2006, Sect. II.1.3]
template <class R>
struct GaussStages {
  std::size_t count;
  R b[largest_eg_degree]{};
  R inner[largest_eg_degree][largest_eg_degree]{};
  R a(std::size_t l, std::size_t j) const { return (R(0.5) + inner[l][j]) * b[j]; }

  explicit GaussStages(int degree) : count(static_cast<std::size_t>(degree)) {
    if (degree == 1) {
      b[0] = R(1);
    } else if (degree == 2) {
      b[0] = b[1] = R(0.5);
      couple(0, 1, R(-1) / sqrt(R(3)));
    } else {
      b[0] = b[2] = R(5) / R(18);
      b[1] = R(4) / R(9);
      const R root = sqrt(R(15));
      couple(0, 1, R(-3) * root / R(20));
      couple(0, 2, R(-3) * root / R(25));
      couple(1, 2, R(-3) * root / R(20));
    }
  }

 private:
  void couple(std::size_t i, std::size_t j, const R& n) {
    inner[i][j] = n;
    inner[j][i] = -n;
  }
};

/// A pair at the points of a step.
template <class S>
struct RadialPair {
  static constexpr std::size_t most = largest_eg_degree;
  S start[3]{};    // x_a - x_b at the beginning of the step
  S r[most][3]{};  // differences of positions, at the points
  S w[most][3]{};  // differences of velocities
  S u[most]{};
  S rate[most]{};  // u'
  RadialLaw<S> law[most]{};
  S factor[most]{};              // phi'_l + lambda u'_l
  base_scalar<S> reach[most]{};  // rounding of u'_l in units of epsilon
  base_scalar<S> noise{};        // the resulting rounding of lambda u'_l

  /// Computes the factor from start, r, w and reach. @param strength of the pair divided by its reduced mass
  template <class P, class R>
  void complete(const P& problem, const RecordedLaw<R>& recorded, const GaussStages<R>& stages, const R& h,
                std::size_t space, const R& strength) {
    const std::size_t k = stages.count;
    S u0(R(0));
    S u1(R(0));
    for (std::size_t d = 0; d < space; ++d) {
      S end = start[d];
      for (std::size_t l = 0; l < k; ++l) end = end + (h * stages.b[l]) * w[l][d];
      u0 = u0 + start[d] * start[d];
      u1 = u1 + end * end;
    }
    for (std::size_t l = 0; l < k; ++l) {
      u[l] = rate[l] = S(R(0));
      for (std::size_t d = 0; d < space; ++d) {
        u[l] = u[l] + r[l][d] * r[l][d];
        rate[l] = rate[l] + R(2) * (r[l][d] * w[l][d]);
      }
      law[l] = law_at(problem, u[l]);
    }
    const auto [mean, slope_difference] = recorded.differences(problem, u0, u1);
    for (std::size_t l = 0; l < k; ++l) factor[l] = mean;
    if (k > 1) project(stages, h, u0, mean, slope_difference, R(R(4) * h * strength));
  }

 private:
  /// @param mean, slope_difference phi[u0, u1] and phi'[u0, u1] @param response the change of u' by a factor of 1,
  /// divided by u
  template <class R>
  void project(const GaussStages<R>& stages, const R& h, const S& u0, const S& mean, const S& slope_difference,
               const R& response) {
    const std::size_t k = stages.count;
    S gap[most];     // g
    S work(R(0));    // (u', g)
    S square(R(0));  // (u', u')
    S unit(R(0));    // (u', u')/rho^2
    R largest(0);
    R loose(0);
    for (std::size_t l = 0; l < k; ++l) {
      gap[l] = mean - law[l].first;
      S error = u[l] - u0;  // s_l
      for (std::size_t j = 0; j < k; ++j) error = error - (h * stages.a(l, j)) * rate[j];
      work = work + stages.b[l] * (rate[l] * gap[l]);
      square = square + stages.b[l] * (rate[l] * rate[l]);
      const S here = response * (u[l] * (slope_difference * error));
      unit = unit + stages.b[l] * (here * here);
      largest = larger(largest, R(abs(value_of(gap[l]))));
      loose = larger(loose, reach[l]);
    }
    S kept(R(1));  // 1 - chi
    if (!(value_of(square) > R(64) * value_of(unit))) {
      if (!(value_of(square) > R(4) * value_of(unit))) return;  // uses the mean
      const S x = (square - R(4) * unit) / (R(60) * unit);
      kept = x * x * x * (R(10) - x * (R(15) - R(6) * x));
    }
    noise = largest * loose / sqrt(value_of(square));
    const S along = kept * work / square;
    const S share = R(1) - kept;
    for (std::size_t l = 0; l < k; ++l) factor[l] = law[l].first + along * rate[l] + share * gap[l];
  }
};

}  // namespace hamflow
