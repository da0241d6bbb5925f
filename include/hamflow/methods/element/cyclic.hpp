// cg(1) where the last coordinate is cyclic: its momentum l is constant, Newton runs in the other coordinates, and the
// last one follows by quadrature on the converged segment.   [Gross1999, (2.98)-(2.106)]
//     q_n(1) - q_n(0) = h sum_l b_l dH/dp_n(q(alpha_l), l).
// With polar coordinates that is the seed's scalar Newton in r, and the angular momentum is conserved by construction.
#pragma once

#include "hamflow/methods/element/natural.hpp"

namespace hamflow {

template <class P, class Real>
class CyclicElement {
 public:
  static constexpr std::size_t n = P::dimension;
  using V = Vector<Real, n>;
  using Reduced = typename P::Reduced;
  using W = Vector<Real, Reduced::dimension>;
  using Context = ElementContext<Real>;

  explicit CyclicElement(const P& problem) : rest_(problem.reduced(Real(0))) {}

  void guess(Context& context, const P& problem, const Real& h, const V& q0, const V& p0, Increment<Real, n>& u) {
    Increment<Real, Reduced::dimension> of_rest;
    rest_.guess(context, problem.reduced(momentum_of(p0)), h, head(q0), head(p0), of_rest);
    u.q = zeros_like(q0);
    u.p = zeros_like(q0);
    put(of_rest, u);
  }
  void remember(const Increment<Real, n>& u) { rest_.remember({head(u.q), head(u.p)}); }
  void forget() { rest_.forget(); }
  template <class Archive>
  void archive(Archive& ar) {
    ar(rest_);
  }

  Outcome converge(Context& context, const P& problem, const Real& h, const V& q0, const V& p0, Increment<Real, n>& u,
                   std::string* history) {
    const Real momentum = momentum_of(p0);
    const W start = head(q0);
    Increment<Real, Reduced::dimension> of_rest{head(u.q), head(u.p)};
    const Outcome outcome = rest_.converge(context, problem.reduced(momentum), h, start, head(p0), of_rest, history);
    put(of_rest, u);
    const W middle = detail::midpoint<Real>(start, of_rest.q);
    Real change(0);
    for (std::size_t l = 0; l < context.rule->c.size(); ++l) {
      const W q = detail::on_segment(middle, context.rule->offset[l], of_rest.q);
      change += h * context.rule->b[l] * problem.cyclic_rate(q, momentum);
    }
    u.q[q0.size() - 1] = change;
    u.p[q0.size() - 1] = Real(0);
    return outcome;
  }

  bool too_coarse(Context& context, const P& problem, const Real& h, const V& q0, const V& p0,
                  const Increment<Real, n>& u) {
    return rest_.too_coarse(context, problem.reduced(momentum_of(p0)), h, head(q0), head(p0), {head(u.q), head(u.p)});
  }

 private:
  static const Real& momentum_of(const V& p) { return p[p.size() - 1]; }
  static W head(const V& x) {
    W y = zeros<Real, Reduced::dimension>(x.size() - 1);
    for (std::size_t i = 0; i + 1 < x.size(); ++i) y[i] = x[i];
    return y;
  }
  static void put(const Increment<Real, Reduced::dimension>& part, Increment<Real, n>& u) {
    for (std::size_t i = 0; i + 1 < u.q.size(); ++i) {
      u.q[i] = part.q[i];
      u.p[i] = part.p[i];
    }
  }

  NaturalElement<Reduced, Real> rest_;
};

}  // namespace hamflow
