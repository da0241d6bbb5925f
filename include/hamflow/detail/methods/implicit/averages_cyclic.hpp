// Averages with a cyclic last coordinate: its momentum is constant, the other coordinates are solved for alone, and the
// last one follows by quadrature at their points, u^q_n,i = h sum_l W_il dH/dp_n.   [Gross1999, (2.98)-(2.106)]
#pragma once

#include "hamflow/detail/methods/implicit/averages_natural.hpp"

namespace hamflow {

/// The equations of the other coordinates, extended by the cyclic one.
template <class P, class R>
class CyclicAverages : public AverageEquations<P, R> {
  using Base = AverageEquations<P, R>;
  using Reduced = typename P::Reduced;
  using Rest = NaturalAverages<Reduced, R>;
  using Small = typename Rest::V;
  using ReducedIncrement = Increment<R, Reduced::dimension>;

 public:
  using typename Base::Memory;
  using typename Base::Real;
  using typename Base::V;
  using typename Base::Variables;
  static constexpr std::size_t n = P::dimension;
  using Point = typename Rest::Point;
  struct Setup : Rest::Setup {
    Setup(const P& problem, const AverageOptions& options) : Rest::Setup(problem.reduced(Real(0)), options) {}
  };

  CyclicAverages(const Setup& setup, const P& problem, const Real& h, const V& q0, const V& p0, Effort& effort)
      : Base(problem, h, setup.table()),
        momentum_(p0[p0.size() - 1]),
        reduced_(problem.reduced(momentum_)),
        q0_(head(q0)),
        p0_(head(p0)),
        rest_(setup, reduced_, h, q0_, p0_, effort) {}
  CyclicAverages(const CyclicAverages&) = delete;  // rest_ refers to the other members
  CyclicAverages& operator=(const CyclicAverages&) = delete;

  Variables last_state() const { return rest_.last_state(); }
  Variables predicted() const { return rest_.predicted(); }
  Variables started(const Memory& memory) const { return rest_.started(memory); }
  void evaluate(const Variables& x, Point& at) const { rest_.evaluate(x, at); }
  const auto& tangent(const Point& at) const { return rest_.tangent(at); }
  Real norm(const Variables& x, const Point& at) const { return rest_.norm(x, at); }
  Correction<Real> measure(const Variables& x, const Point& at, const Variables& correction) const {
    return rest_.measure(x, at, correction);
  }
  Real hidden_terms(const Variables& x, const Point& at, const Variables& correction) const {
    return rest_.hidden_terms(x, at, correction);
  }
  Increment<Real, n> taken(Variables& x, const Point& at) const {
    const ReducedIncrement of_rest = rest_.taken(x, at);
    return closed(of_rest, x);
  }
  Increment<Real, n> taken(Variables& x, const Point& at, const Variables& correction) const {
    const ReducedIncrement of_rest = rest_.taken(x, at, correction);
    return closed(of_rest, x);
  }
  Memory memory(const Variables& x, const Increment<Real, n>&) const { return x; }
  Vector<Real, dynamic> unknowns(const Variables& x, const Increment<Real, n>&) const {
    const Vector<Real, dynamic> of_rest = rest_.unknowns(x, {});
    const Vector<Real, dynamic> angles = cyclic_averages(x);
    const std::size_t half = x.size();  // the averages of the other coordinates, in q and in p
    Vector<Real, dynamic> all(2 * (half + k_));
    for (std::size_t i = 0; i < half; ++i) {
      all[i] = of_rest[i];
      all[half + k_ + i] = of_rest[half + i];
    }
    for (std::size_t i = 0; i < k_; ++i) all[half + i] = angles[i];
    return all;
  }
  /// The energy gain of the step according to a finer quadrature.
  detail::Gain<Real> gain_of_energy(const Variables& x) const { return rest_.gain_of_energy(x); }
  Real own_gain(const Variables& x) const { return rest_.own_gain(x); }
  bool too_coarse(const Variables& x, const Increment<Real, n>&) const { return rest_.too_coarse(x, {}); }
  bool energy_error_acceptable(const Variables& x, const Increment<Real, n>&) const {
    return rest_.energy_error_acceptable(x, {});
  }

 private:
  using Base::h_;
  using Base::k_;
  using Base::problem_;
  using Base::s_;
  using Base::table_;

  static Small head(const V& x) {
    Small y = zeros<Real, Reduced::dimension>(x.size() - 1);
    for (std::size_t i = 0; i + 1 < x.size(); ++i) y[i] = x[i];
    return y;
  }
  Vector<Real, dynamic> cyclic_averages(const Variables& x) const {
    const Variables u = rest_.displacements(x);
    Vector<Real, dynamic> sums(k_);
    rest_.at_points(table_, u, Rest::With::points,
                    [&](std::size_t first, std::size_t count, const typename Rest::Block& block) {
                      Small q = zeros_like(q0_);
                      for (std::size_t l = 0; l < count; ++l) {
                        detail::take_point(&block.q[0], l, q);
                        const Real rate = problem_.cyclic_rate(q, momentum_);
                        for (std::size_t i = 0; i < k_; ++i) sums[i] += h_ * table_.weight[(first + l) * k_ + i] * rate;
                      }
                    });
    return sums;
  }
  Increment<Real, n> closed(const ReducedIncrement& of_rest, const Variables& x) const {
    Increment<Real, n> u{zeros<Real, n>(q0_.size() + 1), zeros<Real, n>(q0_.size() + 1)};
    for (std::size_t i = 0; i < q0_.size(); ++i) {
      u.q[i] = of_rest.q[i];
      u.p[i] = of_rest.p[i];
    }
    const Vector<Real, dynamic> angles = cyclic_averages(x);
    for (std::size_t j = 0; j < angles.size(); ++j) u.q[q0_.size()] += table_.increment[j] * angles[j];
    return u;
  }

  Real momentum_;
  Reduced reduced_;
  Small q0_;
  Small p0_;
  Rest rest_;
};

}  // namespace hamflow
