// Functions of a problem behind virtual calls that forward to another problem, except those that a derived class
// overrides: walls (src/walls/walled_functions.hpp), sums over pairs (src/gas/bulk_gas.cpp).
#pragma once

#include <memory>

#include "hamflow/detail/run/any_problem.hpp"

namespace hamflow {

/// Functions at several points call the derived class point by point.
template <class S>
class ForwardingFunctions : public Functions<S> {
 public:
  using typename Functions<S>::V;
  using typename Functions<S>::M;
  using Pointer = std::shared_ptr<const Functions<S>>;
  explicit ForwardingFunctions(Pointer exact) : exact_(std::move(exact)) {}

  S energy(const V& q, const V& p) const override { return exact_->energy(q, p); }
  S kinetic(const V& p) const override { return exact_->kinetic(p); }
  S potential(const V& q) const override { return exact_->potential(q); }
  bool has_parts() const override { return exact_->has_parts(); }
  void velocity(const V& p, V& v) const override { exact_->velocity(p, v); }
  void force(const V& q, V& f) const override { exact_->force(q, f); }
  void inverse_mass_times(const V& f, V& out) const override { exact_->inverse_mass_times(f, out); }
  bool has_clock() const override { return exact_->has_clock(); }
  bool has_scaled_velocity() const override { return exact_->has_scaled_velocity(); }
  bool has_scaled_force() const override { return exact_->has_scaled_force(); }
  void scaled_velocity(const S& factor, const V& p, V& v) const override { exact_->scaled_velocity(factor, p, v); }
  void scaled_force(const S& factor, const V& q, V& f) const override { exact_->scaled_force(factor, q, f); }
  void gradient(const V& q, const V& p, V& dq, V& dp) const override { exact_->gradient(q, p, dq, dp); }
  void hessian(const V& q, const V& p, M& qq, M& qp, M& pp) const override { exact_->hessian(q, p, qq, qp, pp); }
  void force_and_hessian(const V& q, V& f, M& h) const override { exact_->force_and_hessian(q, f, h); }
  V invariants(const V& q, const V& p, const S& t) const override { return exact_->invariants(q, p, t); }
  std::vector<std::size_t> invariant_sizes() const override { return exact_->invariant_sizes(); }
  std::string label() const override { return exact_->label(); }
  std::size_t residual_groups() const override { return exact_->residual_groups(); }
  V constraints(const V& q) const override { return exact_->constraints(q); }
  Gradients<S, dynamic> constraint_gradients(const V& q) const override { return exact_->constraint_gradients(q); }
  Pointer reduced(const S& momentum) const override { return exact_->reduced(momentum); }
  S cyclic_rate(const V& q, const S& momentum) const override { return exact_->cyclic_rate(q, momentum); }
  void velocity_of(const V& q, const V& p, V& v) const override { exact_->velocity_of(q, p, v); }
  void momentum_of(const V& q, const V& v, V& p) const override { exact_->momentum_of(q, v, p); }
  V rotation() const override { return exact_->rotation(); }
  S distance_rate(const V& q, const V& v) const override { return exact_->distance_rate(q, v); }
  std::size_t radial_space() const override { return exact_->radial_space(); }
  std::vector<RadialTerm<base_scalar<S>>> radial_terms() const override { return exact_->radial_terms(); }
  RadialLaw<S> radial_law(const S& u) const override { return exact_->radial_law(u); }
  PointMasses<base_scalar<S>> point_masses() const override { return exact_->point_masses(); }

 protected:
  Pointer exact_;
};

}  // namespace hamflow
