// The functions of a typed Hamiltonian behind virtual calls (detail/run/any_problem.hpp). Its capabilities are known
// when its text is parsed, not at compile time.
#pragma once

#include "hamflow/detail/formula/bound_model.hpp"
#include "hamflow/detail/run/any_problem.hpp"

namespace hamflow {

/// Whether the coordinates of a typed Hamiltonian have a centre from which distances are taken.
enum class TypedCentre { none, origin, of_radius };  // of_radius: the first coordinate is the distance

/// The functions for states of type S and parameters of type R.
template <class R, class S>
class FormulaFunctions final : public Functions<S> {
 public:
  using typename Functions<S>::V;
  using typename Functions<S>::M;
  explicit FormulaFunctions(std::shared_ptr<const formula::BoundModel<R>> model, TypedCentre centre = TypedCentre::none)
      : model_(std::move(model)), centre_(centre) {}

  S energy(const V& q, const V& p) const override { return model_->template energy<S>(q, p); }
  S kinetic(const V& p) const override { return model_->template kinetic<S>(p); }
  S potential(const V& q) const override { return model_->template potential<S>(q); }
  bool has_parts() const override { return model_->model().structure().separable; }
  void inverse_mass_times(const V& f, V& out) const override {
    velocity(f, out);
    if (has_clock()) out[model_->model().size()] = S(R(0));
  }
  bool has_clock() const override { return model_->model().structure().time; }
  void velocity(const V& p, V& v) const override { model_->template velocity<S>(p, v); }
  void force(const V& q, V& f) const override { model_->template force<S>(q, f); }
  bool has_scaled_velocity() const override { return model_->has_scaled(); }
  bool has_scaled_force() const override { return model_->has_scaled(); }
  void scaled_velocity(const S& factor, const V& p, V& v) const override {
    model_->template scaled_velocity<S>(factor, p, v);
  }
  void scaled_force(const S& factor, const V& q, V& f) const override {
    model_->template scaled_force<S>(factor, q, f);
  }
  /// With constraints, returns the field of the constrained motion, dH/dq + g'^T lambda(q, p) and dH/dp, which is not a
  /// gradient.
  void gradient(const V& q, const V& p, V& dq, V& dp) const override {
    model_->template gradient<S>(q, p, dq, dp);
    if (residual_groups() > 0) add_constraint_forces(q, dq, dp);
  }
  void hessian(const V& q, const V& p, M& qq, M& qp, M& pp) const override {
    model_->template hessian<S>(q, p, qq, qp, pp);
  }
  void force_and_hessian(const V& q, V& f, M& h) const override { model_->template force_and_hessian<S>(q, f, h); }
  V invariants(const V& q, const V& p, const S& t) const override {
    const V own = model_->template invariants<S>(q, p, t);
    if (residual_groups() == 0) return own;
    V v = zeros_like(p);
    velocity(p, v);
    V all(own.size() + 2 * count());
    std::size_t i = 0;
    for (const V& part : {own, constraints(q), products(constraint_gradients(q), v)}) {
      for (const S& x : part) all[i++] = x;
    }
    return all;
  }
  std::vector<std::size_t> invariant_sizes() const override {
    std::vector<std::size_t> all(model_->model().invariants().size(), 1);
    all.insert(all.end(), residual_groups(), count());
    return all;
  }
  std::size_t residual_groups() const override { return count() > 0 ? 2 : 0; }
  V constraints(const V& q) const override { return model_->template constraints<S>(q); }
  Gradients<S, dynamic> constraint_gradients(const V& q) const override {
    return model_->template constraint_gradients<S>(q);
  }
  std::string label() const override { return model_->model().label(); }
  std::shared_ptr<const Functions<S>> reduced(const S&) const override { absent(); }
  S cyclic_rate(const V&, const S&) const override { absent(); }
  void velocity_of(const V&, const V&, V&) const override { absent(); }
  void momentum_of(const V&, const V&, V&) const override { absent(); }
  V rotation() const override { absent(); }
  S distance_rate(const V& q, const V& v) const override {
    if (centre_ == TypedCentre::none) absent();
    if (centre_ == TypedCentre::of_radius) return v[0] / q[0];
    S along = q[0] * v[0];
    S square = q[0] * q[0];
    for (std::size_t i = 1; i < q.size(); ++i) {
      along += q[i] * v[i];
      square += q[i] * q[i];
    }
    return along / square;
  }
  std::size_t radial_space() const override { absent(); }
  std::vector<RadialTerm<base_scalar<S>>> radial_terms() const override { absent(); }
  RadialLaw<S> radial_law(const S&) const override { absent(); }

 private:
  std::size_t count() const { return model_->model().structure().constraints; }
  /// Adds the forces of the constraints, which follow from d^2 g/dt^2 = 0 without second derivatives of H.
  /// [Sonnleitner2010, p. 22]
  /// @param dq dV/dq; the forces of the constraints are added to it   @param v the velocity
  void add_constraint_forces(const V& q, V& dq, const V& v) const {
    const Gradients<S, dynamic> rows = constraint_gradients(q);
    Gradients<S, dynamic> with_mass;
    for (const V& row : rows) {
      with_mass.push_back(zeros_like(q));
      inverse_mass_times(row, with_mass.back());
    }
    V right = model_->template constraint_curvatures<S>(q, v);
    for (std::size_t k = 0; k < right.size(); ++k) right[k] = right[k] - dot(with_mass[k], dq);
    const V lambda = multipliers(rows, with_mass, right);
    for (std::size_t k = 0; k < lambda.size(); ++k) {
      for (std::size_t i = 0; i < dq.size(); ++i) dq[i] = dq[i] + rows[k][i] * lambda[k];
    }
  }
  [[noreturn]] static void absent() { throw std::logic_error("hamflow: a typed problem does not have this function"); }

  std::shared_ptr<const formula::BoundModel<R>> model_;
  TypedCentre centre_;
};

/// The capabilities of a typed Hamiltonian.
inline Capability capabilities_of(const FormulaStructure& structure) {
  Capability all = Capability::smooth;
  if (structure.constraints > 0) return all | Capability::constrained;  // the field differs from that of T + V
  if (structure.separable) all = all | Capability::separable;
  // If t is one of the coordinates, T has a term linear in its momentum, so velocities are not M^-1 p.
  if (structure.quadratic_kinetic && !structure.time) all = all | Capability::quadratic_kinetic;
  return all;
}
/// @throws FormulaError if it does not have the capability `wanted`
inline void require_of_formula(const FormulaStructure& structure, Capability wanted) {
  if (includes(capabilities_of(structure), wanted)) return;
  throw FormulaError(FormulaKeys::hamiltonian,
                     std::string("found an H that ") +
                         (structure.separable && structure.quadratic_kinetic ? "depends on t"
                          : structure.separable ? "is not quadratic in p with constant coefficients"
                                                : "is not T(p) + V(q)") +
                         "; allowed " +
                         (structure.separable ? "p^T M^-1 p/2 + V(q), else separable_formula_problem"
                                              : "T(p) + V(q), else formula_problem"));
}

}  // namespace hamflow
