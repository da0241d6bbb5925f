// One pair of bodies, or a body and the centre, on a step of eg(k): the force factor that keeps the energy.
// [GrossBetschSteinmann2005]   With u(t) = |r|^2 along the trial polynomial, its value and rate at k Gauss points u_l,
// u'_l, the pair's force is -2 (phi'_l + lambda u'_l) r_l. It does the work -[phi(u1) - phi(u0)] just for
//     lambda = (phi(u1) - phi(u0) - h sum_l b_l phi'_l u'_l)/(h sum_l b_l u'_l^2).
// u' has degree 2 k - 1, so that u1 - u0 = h sum b_l u'_l, and with the divided difference phi[u0, u1]
//     lambda u'_l = u'_l sum_m b_m u'_m (phi[u0, u1] - phi'_m)/sum_m b_m u'_m^2,
// without the cancellation of energies. Of one point it is phi[u0, u1] - phi'_1: no quotient is left. Of more, where the sum in the numerator is rounding itself (on a circle, at rest) the pair
// does the right work already, and lambda is 0.
#pragma once

#include <memory>

#include "hamflow/core/radial_forces.hpp"
#include "hamflow/methods/eg_options.hpp"
#include "hamflow/numerics/tape_replay.hpp"

namespace hamflow {

/// phi and phi' on a tape, for their divided differences.
template <class R>
class RecordedLaw {
 public:
  template <class P>
  explicit RecordedLaw(const P& problem) {
    Recorder<R> recorder(Folding::exact);
    const RadialLaw<Trace<R>> law = problem.radial_law(recorder.input(R(5) / R(7)));
    tape_ = std::make_shared<const Tape<R>>(recorder.finish({law.value, law.first}));
  }
  /// phi[a, b] and phi'[a, b] (b - a). @param way b - a
  template <class S>
  std::pair<S, S> differences(const S& a, const S& b, const S& way) const {
    Vector<Slope<S>, dynamic> nodes(tape_->nodes.size());
    nodes[0] = Slope<S>(a, b, S(R(1)));
    (void)replay(*tape_, nodes);  // laws have no branches
    const auto output = [&](std::size_t k) { return nodes[static_cast<std::size_t>(tape_->outputs[k])].slope; };
    return {output(0), output(1) * way};
  }

 private:
  std::shared_ptr<const Tape<R>> tape_;
};

/// Weights of k Gauss points, and N = A B^-1 - 1/2, antisymmetric.   [HLW2006, Sect. II.1.3]
template <class R>
struct GaussStages {
  std::size_t count;
  R b[largest_eg_degree]{};
  R inner[largest_eg_degree][largest_eg_degree]{};

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
  S r[most][3]{};      // differences of positions
  S w[most][3]{};      // and of velocities
  S rate[most]{};      // u'
  S u[most]{};
  RadialLaw<S> law[most]{};
  S change[most]{};    // phi'(u1) - phi'_l
  S lambda{};
  S weight{};          // sum_l b_l u'_l^2; not used for one point
  S mean_slope{};      // of one point: d phi[u0, u1]/du1
  // What rounding makes of u'_l, and then of lambda u'_l, in units of epsilon. Close to a circle u' is small beside
  // phi[u0, u1] - phi', and what lambda u' rounds by may be far more than what phi' rounds by.
  base_scalar<S> reach[most]{};
  base_scalar<S> factor_noise[most]{};

  S factors[most]{};   // phi'_l + lambda u'_l

  /// From r, w and reach.
  /// @param start x_a - x_b at the beginning of the step
  template <class P, class R>
  void complete(const P& problem, const RecordedLaw<R>& recorded, const GaussStages<R>& stages, const R& h,
                std::size_t space, const S (&start)[3]) {
    const std::size_t k = stages.count;
    S end[3]{};
    S u0(R(0));
    S u1(R(0));
    for (std::size_t d = 0; d < space; ++d) {
      end[d] = start[d];
      for (std::size_t l = 0; l < k; ++l) end[d] = end[d] + (h * stages.b[l]) * w[l][d];
      u0 = u0 + start[d] * start[d];
      u1 = u1 + end[d] * end[d];
    }
    S way(R(0));
    for (std::size_t l = 0; l < k; ++l) {
      u[l] = rate[l] = S(R(0));
      for (std::size_t d = 0; d < space; ++d) {
        u[l] = u[l] + r[l][d] * r[l][d];
        rate[l] = rate[l] + R(2) * (r[l][d] * w[l][d]);
      }
      law[l] = problem.radial_law(u[l]);
      way = way + (h * stages.b[l]) * rate[l];
    }
    const S mean = recorded.differences(u0, u1, way).first;
    S excess(R(0));
    weight = S(R(0));
    for (std::size_t l = 0; l < k; ++l) {
      excess = excess + stages.b[l] * (rate[l] * (mean - law[l].first));
      weight = weight + stages.b[l] * (rate[l] * rate[l]);
      S ahead(R(0));  // u1 - u_l
      for (std::size_t d = 0; d < space; ++d) ahead = ahead + (end[d] - r[l][d]) * (end[d] + r[l][d]);
      change[l] = recorded.differences(u[l], u1, ahead).second;
    }
    if (k == 1) {
      factors[0] = mean;
      complete_single(problem, u0, way, mean);
      return;
    }
    for (std::size_t l = 0; l < k; ++l) factors[l] = law[l].first;
    R noise(0);  // of excess and of weight, in units of epsilon
    R loose(0);
    for (std::size_t l = 0; l < k; ++l) {
      const R v = abs(value_of(rate[l]));
      noise += stages.b[l] * (abs(value_of(S(mean - law[l].first))) * reach[l] + v * abs(value_of(law[l].first)));
      loose += R(2) * stages.b[l] * v * reach[l];
    }
    lambda = S(R(0));
    if (!(abs(value_of(excess)) > R(4) * std::numeric_limits<R>::epsilon() * noise)) return;
    if (!(value_of(weight) > R(0))) return;
    lambda = excess / weight;
    for (std::size_t l = 0; l < k; ++l) {
      factors[l] = law[l].first + lambda * rate[l];
      const R of_lambda = abs(value_of(lambda));
      factor_noise[l] =
          abs(value_of(rate[l])) * (noise + of_lambda * loose) / value_of(weight) + of_lambda * reach[l];
    }
  }

 private:
  /// d phi[u0, u1]/du1 = (phi'(u1) - phi[u0, u1])/(u1 - u0): where that cancels by its Taylor polynomial, to second order.
  template <class P>
  void complete_single(const P& problem, const S& u0, const S& way, const S& mean) {
    using R = base_scalar<S>;
    const R size = abs(value_of(way));
    const bool close = size * size * size <= std::numeric_limits<R>::epsilon() * value_of(S(u0 * u0 * u0));
    mean_slope = close ? S(problem.radial_law(S(u0 + way * (R(2) / R(3)))).second / R(2))
                       : S((law[0].first + change[0] - mean) / way);
  }
};

}  // namespace hamflow
