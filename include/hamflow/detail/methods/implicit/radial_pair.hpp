// One pair of bodies, or a body and the centre, on a step of eg(k): the force factor that keeps the energy.
// [GrossBetschSteinmann2005]   With u(t) = |r|^2 along the trial polynomial, its value and rate at k Gauss points u_l,
// u'_l, the pair's force is -2 (phi'_l + lambda u'_l) r_l. It does the work -[phi(u1) - phi(u0)] just for
//     lambda = (phi(u1) - phi(u0) - h sum_l b_l phi'_l u'_l)/(h sum_l b_l u'_l^2).
// u' has degree 2 k - 1, so that u1 - u0 = h sum b_l u'_l, and with the divided difference phi[u0, u1] and
// g_l = phi[u0, u1] - phi'_l, (x, y) = sum b_l x_l y_l,
//     lambda u' = u' (u', g)/(u', u'),
// the projection of g on u', without the cancellation of energies; for k = 1 it is g itself.
//
// It has no limit at u' = 0, at rest and on a circle: there it depends on the direction of u', and steps close to it
// have no solution. Any u' (u', g)/(u', u') + chi [g - u' (u', g)/(u', u')] does the same work: chi = 1 takes g itself,
// by which the factor is phi[u0, u1], and a circle stays one. So with
//     rho = |u'|/(what u' changes by when g is added to the factor),
// chi is 1 below 2, 0 above 8, and goes from one to the other as a polynomial with two continuous derivatives. For g
// stands what is left of it where u' = 0, phi'[u0, u1] s_l: s_l = u_l - u0 - h sum_j a_lj u'_j is the error of
// collocation in u, of order k + 1 in h. Where rho > 8 the step is the definition and nothing else: on an ellipse of
// e = 0.1 with 63 steps to a period rho is 15 000 at its least, of e = 0.6 with 21 steps 12.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "hamflow/detail/core/radial_forces.hpp"
#include "hamflow/detail/methods/eg_options.hpp"
#include "hamflow/detail/numerics/tape_replay.hpp"

namespace hamflow {

/// The law at a number, or along a dual number; of phi'' the value alone.
template <class P, class S>
RadialLaw<S> law_at(const P& problem, const S& u) {
  if constexpr (IsDual<S>::value) {
    const auto law = problem.radial_law(u.value);
    return {detail::chain(u, law.value, law.first), detail::chain(u, law.first, law.second), S(law.second)};
  } else {
    return problem.radial_law(u);
  }
}

/// phi and phi' on tapes, for their divided differences: one for each side of the branches of a law, such as those of a
/// cut-off, that has been met.
template <class R>
class RecordedLaw {
 public:
  template <class P>
  explicit RecordedLaw(const P& problem) {
    tapes_[0] = recorded(problem, R(5) / R(7));
  }
  /// phi[a, b] and phi'[a, b]. Where a branch lies between a and b the difference of the values is taken as it is: its
  /// rounding, over b - a, does the work of a rounding of phi.
  template <class P, class S>
  std::pair<S, S> differences(const P& problem, const S& a, const S& b) const {
    std::pair<S, S> found;
    if (on_any(a, b, found)) return found;
    if (!on_any(a, a, found)) {
      // What was met longest ago makes room.
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
  /// @return false where a or b lies on another side of a branch
  template <class S>
  static bool on(const Tape<R>& tape, const S& a, const S& b, std::pair<S, S>& found) {
    Vector<Slope<S>, dynamic> nodes(tape.nodes.size());
    nodes[0] = Slope<S>(a, b, S(R(1)));
    if (!replay(tape, nodes)) return false;
    const auto slope = [&](std::size_t k) { return nodes[static_cast<std::size_t>(tape.outputs[k])].slope; };
    found = {slope(0), slope(1)};
    return true;
  }

  mutable std::array<Recorded, 4> tapes_;  // follow from the law: no part of a run's memory
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

/// At the points of a step.
template <class S>
struct RadialPair {
  static constexpr std::size_t most = largest_eg_degree;
  S start[3]{};    // x_a - x_b at the beginning of the step
  S r[most][3]{};  // differences of positions, at the points
  S w[most][3]{};  // and of velocities
  S u[most]{};
  S rate[most]{};  // u'
  RadialLaw<S> law[most]{};
  S factor[most]{};              // phi'_l + lambda u'_l
  base_scalar<S> reach[most]{};  // what u'_l rounds by, in units of epsilon
  base_scalar<S> noise{};        // and then lambda u'_l

  /// From start, r, w and reach. @param strength of the pair over its reduced mass
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
  /// @param mean, slope_difference phi[u0, u1] and phi'[u0, u1]   @param response what a factor of 1 changes u' by,
  /// over u
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
      if (!(value_of(square) > R(4) * value_of(unit))) return;  // the mean
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
