// cg(1) with a cyclic last coordinate: its momentum l is constant, Newton's method solves for the other coordinates,
// and the last one follows by quadrature on the converged segment.   [Gross1999, (2.98)-(2.106)]
//     q_n(1) - q_n(0) = h sum_l b_l dH/dp_n(q(alpha_l), l).
// In polar coordinates this is the scalar Newton iteration in r of [Gross1999], and the angular momentum is conserved
// by construction.
#pragma once

#include "hamflow/detail/methods/implicit/natural.hpp"

namespace hamflow {

/// The equations of the other coordinates, extended by the cyclic one.
template <class P, class R>
class CyclicElement : public SegmentEquations<P, R> {
  using Base = SegmentEquations<P, R>;
  using Reduced = typename P::Reduced;
  using Rest = NaturalElement<Reduced, R>;

 public:
  using typename Base::Real;
  using typename Base::V;
  static constexpr std::size_t n = P::dimension;
  using Variables = typename Rest::Variables;
  using Memory = typename Rest::Memory;
  using Point = typename Rest::Point;
  struct Setup : Rest::Setup {
    Setup(const P& problem, const CgOptions& options) : Rest::Setup(problem.reduced(Real(0)), options) {}
  };

  CyclicElement(const Setup& setup, const P& problem, const Real& h, const V& q0, const V& p0, Effort& effort)
      : Base(problem, h, setup.rule()),
        momentum_(p0[p0.size() - 1]),
        reduced_(problem.reduced(momentum_)),
        q0_(head(q0)),
        p0_(head(p0)),
        rest_(setup, reduced_, h, q0_, p0_, effort) {}
  CyclicElement(const CyclicElement&) = delete;  // rest_ refers to the other members
  CyclicElement& operator=(const CyclicElement&) = delete;

  Variables last_state() const { return rest_.last_state(); }
  Variables predicted() const { return rest_.predicted(); }
  Variables started(const Memory& memory) const { return rest_.started(memory); }
  [[gnu::always_inline]] void evaluate(const Variables& x, Point& at) const { rest_.evaluate(x, at); }
  void remove_residual_rounding(const Variables& x, Point& at) const requires(Reduced::dimension > 2) {
    rest_.remove_residual_rounding(x, at);
  }
  [[gnu::always_inline]] auto tangent(const Point& at) const { return rest_.tangent(at); }
  Real norm(const Variables& x, const Point& at) const { return rest_.norm(x, at); }
  [[gnu::always_inline]] Correction<Real> measure(const Variables& x, const Point& at,
                                                  const Variables& correction) const {
    return rest_.measure(x, at, correction);
  }

  [[gnu::always_inline]] Real hidden_terms(const Variables& x, const Point& at, const Variables& correction) const {
    return rest_.hidden_terms(x, at, correction);
  }

  [[gnu::always_inline]] Increment<Real, n> taken(Variables& x, const Point& at) const {
    return closed(rest_.taken(x, at));
  }
  [[gnu::always_inline]] Increment<Real, n> taken(Variables& x, const Point& at, const Variables& correction) const {
    return closed(rest_.taken(x, at, correction));
  }
  Memory memory(const Variables&, const Increment<Real, n>& taken) const { return head(taken.p); }
  bool too_coarse(const Variables& x, const Increment<Real, n>& taken) const {
    return rest_.too_coarse(x, {head(taken.q), head(taken.p)});
  }
  bool energy_error_acceptable(const Variables& x, const Increment<Real, n>& taken) const {
    return rest_.energy_error_acceptable(x, {head(taken.q), head(taken.p)});
  }

 private:
  using Base::h_;
  using Base::problem_;
  using Base::rule_;

  static Variables head(const V& x) {
    Variables y = zeros<Real, Reduced::dimension>(x.size() - 1);
    for (std::size_t i = 0; i + 1 < x.size(); ++i) y[i] = x[i];
    return y;
  }
  Increment<Real, n> closed(const Increment<Real, Reduced::dimension>& of_rest) const {
    Increment<Real, n> u{zeros<Real, n>(q0_.size() + 1), zeros<Real, n>(q0_.size() + 1)};
    for (std::size_t i = 0; i < q0_.size(); ++i) {
      u.q[i] = of_rest.q[i];
      u.p[i] = of_rest.p[i];
    }
    const Variables middle = detail::midpoint<Real>(q0_, of_rest.q);
    Real change(0);
    for (std::size_t l = 0; l < rule_.c.size(); ++l) {
      const Variables q = detail::on_segment(middle, rule_.offset[l], of_rest.q);
      change += h_ * rule_.b[l] * problem_.cyclic_rate(q, momentum_);
    }
    u.q[q0_.size()] = change;
    return u;
  }

  Real momentum_;
  Reduced reduced_;
  Variables q0_;
  Variables p0_;
  Rest rest_;
};

}  // namespace hamflow
