// A problem behind virtual calls. Methods with more digits than double, and the step maps of the verification, are
// compiled once for each method and number type instead of once for each problem. An indirect call per force costs
// little compared with such arithmetic. Steps in double are recorded through it (recorded_step.hpp) and run without
// calls.
#pragma once

#include <memory>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "hamflow/core/derivatives.hpp"
#include "hamflow/detail/core/capability.hpp"
#include "hamflow/detail/core/pool.hpp"
#include "hamflow/detail/core/step_clock.hpp"
#include "hamflow/detail/core/tape.hpp"
#include "hamflow/detail/methods/implicit/points.hpp"
#include "hamflow/detail/run/probe.hpp"

namespace hamflow {

/// Number types that only record, or carry first derivatives. No Hessian is compiled for them.
template <class S>
inline constexpr bool first_derivatives_only = false;
template <class R>
inline constexpr bool first_derivatives_only<Trace<R>> = !std::is_same_v<R, double>;
/// Number types for which the functions receive the factors of kicks and drifts, as in typed code in double, to get the
/// same bits.
template <class S>
inline constexpr bool takes_factors = std::is_same_v<S, double> || std::is_same_v<S, Trace<double>>;

/// The functions of one Hamiltonian for states of type S. Functions outside its capabilities are never called.
template <class S>
class Functions {
 public:
  using V = Vector<S, dynamic>;
  using M = Matrix<S, dynamic>;
  virtual ~Functions() = default;
  // Memory comes from the pool, because the reduced problem of a cyclic problem is made in every step.
  static void* operator new(std::size_t bytes) { return Pool::take(bytes); }
  static void operator delete(void* memory, std::size_t bytes) { Pool::give(memory, bytes); }
  virtual S energy(const V& q, const V& p) const = 0;
  virtual S kinetic(const V& p) const = 0;
  virtual S potential(const V& q) const = 0;
  virtual bool has_parts() const = 0;  // H = T + V, by which kinetic and potential are there
  virtual void velocity(const V& p, V& v) const = 0;
  virtual void force(const V& q, V& f) const = 0;
  /// M^-1 f for T quadratic in p. It is the velocity, except that the entries of the time of H(q, p, t) are 0.
  virtual void inverse_mass_times(const V& f, V& out) const { velocity(f, out); }
  /// Whether the last coordinates hold the time (detail/core/step_clock.hpp).
  virtual bool has_clock() const { return false; }
  // Only some problems define scaled functions. If steps of any length are recorded, a factor is a number of the
  // recording.
  virtual bool has_scaled_velocity() const = 0;
  virtual bool has_scaled_force() const = 0;
  virtual void scaled_velocity(const S& factor, const V& p, V& v) const = 0;
  virtual void scaled_force(const S& factor, const V& q, V& f) const = 0;
  virtual void gradient(const V& q, const V& p, V& dq, V& dp) const = 0;
  virtual void hessian(const V& q, const V& p, M& qq, M& qp, M& pp) const = 0;
  virtual void force_and_hessian(const V& q, V& f, M& h) const = 0;
  // Evaluate at `count` points in one call, with the layout of detail/methods/implicit/points.hpp. The default
  // evaluates one point after the other.
  virtual void forces_at(std::size_t size, std::size_t count, const S* q, S* f) const {
    V x = V(size);
    V y = x;
    for (std::size_t l = 0; l < count; ++l) {
      detail::take_point(q, l, x);
      force(x, y);
      detail::put_point(y, l, f);
    }
  }
  virtual void forces_and_hessians_at(std::size_t size, std::size_t count, const S* q, S* f, S* h) const {
    V x = V(size);
    V y = x;
    M second(size);
    for (std::size_t l = 0; l < count; ++l) {
      detail::take_point(q, l, x);
      force_and_hessian(x, y, second);
      detail::put_point(y, l, f);
      detail::put_point(second, l, h);
    }
  }
  virtual void gradients_at(std::size_t size, std::size_t count, const S* q, const S* p, S* dq, S* dp) const {
    V x = V(size);
    V y = x;
    V by_x = x;
    V by_y = x;
    for (std::size_t l = 0; l < count; ++l) {
      detail::take_point(q, l, x);
      detail::take_point(p, l, y);
      gradient(x, y, by_x, by_y);
      detail::put_point(by_x, l, dq);
      detail::put_point(by_y, l, dp);
    }
  }
  virtual void hessians_at(std::size_t size, std::size_t count, const S* q, const S* p, S* qq, S* qp, S* pp) const {
    V x = V(size);
    V y = x;
    M by_xx(size);
    M by_xy(size);
    M by_yy(size);
    for (std::size_t l = 0; l < count; ++l) {
      detail::take_point(q, l, x);
      detail::take_point(p, l, y);
      hessian(x, y, by_xx, by_xy, by_yy);
      detail::put_point(by_xx, l, qq);
      detail::put_point(by_xy, l, qp);
      detail::put_point(by_yy, l, pp);
    }
  }
  virtual V invariants(const V& q, const V& p, const S& t) const = 0;
  virtual std::vector<std::size_t> invariant_sizes() const = 0;
  virtual std::string label() const = 0;  // of the problem and its choices, for saved states
  // Only with constraints. The last groups of invariants are then the residuals g and g' M^-1 p, which should be 0.
  virtual std::size_t residual_groups() const { return 0; }
  virtual V constraints(const V&) const { no_constraints(); }
  virtual Gradients<S, dynamic> constraint_gradients(const V&) const { no_constraints(); }
  // Only for cyclic problems.
  virtual std::shared_ptr<const Functions> reduced(const S& momentum) const = 0;
  virtual S cyclic_rate(const V& q, const S& momentum) const = 0;
  // Only for charges in a field.
  virtual void velocity_of(const V& q, const V& p, V& v) const = 0;
  virtual void momentum_of(const V& q, const V& v, V& p) const = 0;
  virtual V rotation() const = 0;
  // Only for problems with bodies or a centre.
  virtual S distance_rate(const V& q, const V& v) const = 0;
  // Only for forces between bodies or towards a centre.
  virtual std::size_t radial_space() const = 0;
  virtual std::vector<RadialTerm<base_scalar<S>>> radial_terms() const = 0;
  virtual RadialLaw<S> radial_law(const S& u) const = 0;
  // Of gravitating bodies.
  virtual PointMasses<base_scalar<S>> point_masses() const {
    throw std::logic_error("hamflow: the problem has no gravitating bodies");
  }

 private:
  [[noreturn]] static void no_constraints() { throw std::logic_error("hamflow: the problem has no constraints"); }
};

/// Shared through the base class; otherwise reference counting would be compiled for each problem.
template <class S>
std::shared_ptr<const Functions<S>> shared_functions(const Functions<S>* functions) {
  return {functions, std::default_delete<const Functions<S>>{}, PoolAllocator<S>{}};
}

/// The functions of a problem of some type.
template <class P, class S>
class FunctionsOf final : public Functions<S> {
  static_assert(alignof(P) <= __STDCPP_DEFAULT_NEW_ALIGNMENT__, "hamflow: the pool aligns no further");
  static constexpr std::size_t n = P::dimension;
  using X = Vector<S, n>;  // as the problem has it
  static constexpr bool cyclic = Cyclic<P>;
  static constexpr bool charge = ChargeInField<P>;
  static constexpr bool radial = RadialForces<P>;
  static constexpr bool has_hessian = !first_derivatives_only<S>;
  static constexpr bool in_double = std::is_same_v<S, double> && std::is_same_v<RealOf<P>, double>;
  static constexpr bool drifts_by = takes_factors<S> && Separable<P> && HasScaledVelocity<P, S, S>;
  static constexpr bool kicks_by = takes_factors<S> && Separable<P> && HasScaledForce<P, S, S>;

 public:
  using typename Functions<S>::V;
  using typename Functions<S>::M;
  explicit FunctionsOf(P problem) : problem_(std::move(problem)) {}

  S energy(const V& q, const V& p) const override { return hamflow::energy(problem_, in(q), in(p)); }
  S kinetic(const V& p) const override {
    if constexpr (Separable<P>) {
      return problem_.kinetic(in(p));
    } else {
      absent();
    }
  }
  S potential(const V& q) const override {
    if constexpr (Separable<P>) {
      return problem_.potential(in(q));
    } else {
      absent();
    }
  }
  bool has_parts() const override { return Separable<P>; }
  void velocity(const V& p, V& v) const override {
    if constexpr (Separable<P> && n == dynamic) {
      hamflow::velocity(problem_, p, v);
    } else if constexpr (Separable<P>) {
      X out = zeros<S, n>(p.size());
      hamflow::velocity(problem_, in(p), out);
      put(out, v);
    } else {
      absent();
    }
  }
  void force(const V& q, V& f) const override {
    if constexpr (Separable<P> && n == dynamic) {
      hamflow::force(problem_, q, f);
    } else if constexpr (Separable<P>) {
      X out = zeros<S, n>(q.size());
      hamflow::force(problem_, in(q), out);
      put(out, f);
    } else {
      absent();
    }
  }
  bool has_scaled_velocity() const override { return drifts_by; }
  bool has_scaled_force() const override { return kicks_by; }
  void scaled_velocity(const S& factor, const V& p, V& v) const override {
    if constexpr (drifts_by && n == dynamic) {
      problem_.scaled_velocity(factor, p, v);
    } else if constexpr (drifts_by) {
      X out = zeros<S, n>(p.size());
      problem_.scaled_velocity(factor, in(p), out);
      put(out, v);
    } else {
      absent();
    }
  }
  void scaled_force(const S& factor, const V& q, V& f) const override {
    if constexpr (kicks_by && n == dynamic) {
      problem_.scaled_force(factor, q, f);
    } else if constexpr (kicks_by) {
      X out = zeros<S, n>(q.size());
      problem_.scaled_force(factor, in(q), out);
      put(out, f);
    } else {
      absent();
    }
  }
  void gradient(const V& q, const V& p, V& dq, V& dp) const override {
    X by_q = zeros<S, n>(q.size());
    X by_p = zeros<S, n>(q.size());
    hamflow::gradient(problem_, in(q), in(p), by_q, by_p);
    put(by_q, dq);
    put(by_p, dp);
  }
  void hessian(const V& q, const V& p, M& qq, M& qp, M& pp) const override {
    // For traces, which lanes need, only if the problem has a hand-written Hessian.
    if constexpr (Smooth<P> && has_hessian && (std::is_same_v<S, RealOf<P>> || HasHessian<P, S>)) {
      const X x = in(q);
      Matrix<S, n> by_qq = zero_matrix(x);
      Matrix<S, n> by_qp = by_qq;
      Matrix<S, n> by_pp = by_qq;
      hamflow::hessian(problem_, x, in(p), by_qq, by_qp, by_pp);
      put(by_qq, qq);
      put(by_qp, qp);
      put(by_pp, pp);
    } else {
      absent();
    }
  }
  void force_and_hessian(const V& q, V& f, M& h) const override {
    if constexpr (TwiceDifferentiable<P> && has_hessian) {
      const X x = in(q);
      X out = zeros<S, n>(q.size());
      Matrix<S, n> second = zero_matrix(x);
      hamflow::force_and_hessian(problem_, x, out, second);
      put(out, f);
      put(second, h);
    } else {
      absent();
    }
  }
  // In double this avoids a virtual call for each point. In other number types such calls cost little.
  void forces_at(std::size_t size, std::size_t count, const S* q, S* f) const override {
    if constexpr (Separable<P> && in_double) {
      hamflow::forces_at(problem_, count, q, f);
    } else {
      Functions<S>::forces_at(size, count, q, f);
    }
  }
  void forces_and_hessians_at(std::size_t size, std::size_t count, const S* q, S* f, S* h) const override {
    if constexpr (TwiceDifferentiable<P> && in_double) {
      hamflow::forces_and_hessians_at(problem_, count, q, f, h);
    } else {
      Functions<S>::forces_and_hessians_at(size, count, q, f, h);
    }
  }
  void gradients_at(std::size_t size, std::size_t count, const S* q, const S* p, S* dq, S* dp) const override {
    if constexpr (in_double) {
      hamflow::gradients_at(problem_, count, q, p, dq, dp);
    } else {
      Functions<S>::gradients_at(size, count, q, p, dq, dp);
    }
  }
  void hessians_at(std::size_t size, std::size_t count, const S* q, const S* p, S* qq, S* qp, S* pp) const override {
    if constexpr (Smooth<P> && in_double) {
      hamflow::hessians_at(problem_, count, q, p, qq, qp, pp);
    } else {
      Functions<S>::hessians_at(size, count, q, p, qq, qp, pp);
    }
  }
  V invariants(const V& q, const V& p, const S& t) const override {
    if constexpr (HasInvariants<P, S>) {
      const auto values = problem_.invariants(in(q), in(p), t);
      V all = zeros<S, dynamic>(values.size());
      for (std::size_t i = 0; i < values.size(); ++i) all[i] = values[i];
      return all;
    } else {
      return {};
    }
  }
  std::vector<std::size_t> invariant_sizes() const override { return detail::invariant_sizes(problem_); }
  std::string label() const override { return detail::problem_label<P>(); }
  std::shared_ptr<const Functions<S>> reduced(const S& momentum) const override {
    if constexpr (cyclic && std::is_same_v<S, RealOf<P>>) {
      return shared_functions<S>(new FunctionsOf<typename P::Reduced, S>(problem_.reduced(momentum)));
    } else {
      absent();
    }
  }
  S cyclic_rate(const V& q, const S& momentum) const override {
    if constexpr (cyclic && std::is_same_v<S, RealOf<P>>) {
      Vector<S, P::Reduced::dimension> rest{};
      for (std::size_t i = 0; i < rest.size(); ++i) rest[i] = q[i];
      return problem_.cyclic_rate(rest, momentum);
    } else {
      absent();
    }
  }
  void velocity_of(const V& q, const V& p, V& v) const override {
    if constexpr (charge) {
      X out = zeros<S, n>(q.size());
      problem_.velocity_of(in(q), in(p), out);
      put(out, v);
    } else {
      absent();
    }
  }
  void momentum_of(const V& q, const V& v, V& p) const override {
    if constexpr (charge) {
      X out = zeros<S, n>(q.size());
      problem_.momentum_of(in(q), in(v), out);
      put(out, p);
    } else {
      absent();
    }
  }
  V rotation() const override {
    if constexpr (charge) {
      const auto omega = problem_.rotation();
      V out = zeros<S, dynamic>(omega.size());
      for (std::size_t i = 0; i < omega.size(); ++i) out[i] = omega[i];
      return out;
    } else {
      absent();
    }
  }
  S distance_rate(const V& q, const V& v) const override {
    if constexpr (HasDistanceRate<P, S>) {
      return problem_.distance_rate(in(q), in(v));
    } else {
      absent();
    }
  }
  std::size_t radial_space() const override {
    if constexpr (radial) {
      return problem_.radial_space();
    } else {
      absent();
    }
  }
  std::vector<RadialTerm<base_scalar<S>>> radial_terms() const override {
    if constexpr (radial && std::is_same_v<S, RealOf<P>>) {
      return problem_.radial_terms();
    } else {
      absent();
    }
  }
  RadialLaw<S> radial_law(const S& u) const override {
    if constexpr (radial) {
      return problem_.radial_law(u);
    } else {
      absent();
    }
  }
  PointMasses<base_scalar<S>> point_masses() const override {
    if constexpr (GravitatingBodies<P> && std::is_same_v<base_scalar<S>, RealOf<P>>) {
      return problem_.point_masses();
    } else {
      absent();
    }
  }

 private:
  [[noreturn]] static void absent() { throw std::logic_error("hamflow: the problem does not have this function"); }

  static decltype(auto) in(const V& x) {
    if constexpr (n == dynamic) {
      return (x);
    } else {
      X y{};
      for (std::size_t i = 0; i < n; ++i) y[i] = x[i];
      return y;
    }
  }
  static void put(const X& from, V& to) {
    for (std::size_t i = 0; i < from.size(); ++i) to[i] = from[i];
  }
  static void put(const Matrix<S, n>& from, M& to) {
    for (std::size_t i = 0; i < from.size(); ++i) {
      for (std::size_t j = 0; j < from.size(); ++j) to[i][j] = from[i][j];
    }
  }

  P problem_;
};

/// The functions of a problem for states of type S.
template <class S, class P>
std::shared_ptr<const Functions<S>> functions_of(const P& problem) {
  return shared_functions<S>(new FunctionsOf<P, S>(problem));
}

/// A problem of dynamic size that calls these functions. It has value semantics; copies share the functions.
/// @tparam States the number types of states, R the first @tparam capability the capabilities of the problem
template <class R, Capability capability, class... Others>
class AnyProblem {
 public:
  using Real = R;
  static constexpr std::size_t dimension = dynamic;
  static constexpr bool quadratic_kinetic = includes(capability, Capability::quadratic_kinetic);
  static constexpr bool separable = includes(capability, Capability::separable);
  static constexpr bool cyclic = includes(capability, Capability::cyclic);
  static constexpr bool charge = includes(capability, Capability::charge);
  static constexpr bool radial = includes(capability, Capability::radial);
  static constexpr bool constrained = includes(capability, Capability::constrained);
  static constexpr bool gravitating = includes(capability, Capability::gravitating);

  AnyProblem(std::size_t size, std::shared_ptr<const Functions<R>> own,
             std::shared_ptr<const Functions<Others>>... others)
      : size_(size),
        functions_(std::move(own), std::move(others)...),
        has_clock_(on<R>().has_clock()),
        invariant_sizes_(std::allocate_shared<const std::vector<std::size_t>>(PoolAllocator<std::size_t>{},
                                                                              on<R>().invariant_sizes())) {}
  template <class P>
  static AnyProblem of(const P& problem) {
    return {degrees_of_freedom(problem), functions_of<R>(problem), functions_of<Others>(problem)...};
  }

  std::size_t size() const { return size_; }
  bool has_clock() const { return has_clock_; }
  template <class S>
  S energy(const Vector<S, dynamic>& q, const Vector<S, dynamic>& p) const {
    return on<S>().energy(q, p);
  }
  template <class S>
  S kinetic(const Vector<S, dynamic>& p) const requires separable {
    return on<S>().kinetic(p);
  }
  template <class S>
  S potential(const Vector<S, dynamic>& q) const requires separable {
    return on<S>().potential(q);
  }
  template <class S>
  void velocity(const Vector<S, dynamic>& p, Vector<S, dynamic>& v) const requires separable {
    on<S>().velocity(p, v);
  }
  template <class S>
  void force(const Vector<S, dynamic>& q, Vector<S, dynamic>& f) const requires separable {
    on<S>().force(q, f);
  }
  template <class S>
  void inverse_mass_times(const Vector<S, dynamic>& f, Vector<S, dynamic>& out) const requires quadratic_kinetic {
    on<S>().inverse_mass_times(f, out);
  }
  /// |T| + |V| if H = T + V, which is known at run time also if the type does not show it; else 0.
  R size_of_parts(const Vector<R, dynamic>& q, const Vector<R, dynamic>& p) const {
    return on<R>().has_parts() ? R(abs(on<R>().kinetic(p)) + abs(on<R>().potential(q))) : R(0);
  }
  /// T if H = T + V, else p . dH/dp, both without the momentum of the time.
  template <class S>
  S kinetic_part(const Vector<S, dynamic>& q, const Vector<S, dynamic>& p) const {
    const Functions<S>& functions = on<S>();
    const std::size_t moving = p.size() - clocks_of(*this);
    if (functions.has_parts()) {
      if (!has_clock_) return functions.kinetic(p);
      Vector<S, dynamic> of_motion = p;
      for (std::size_t i = moving; i < p.size(); ++i) of_motion[i] = S(0);
      return functions.kinetic(of_motion);
    }
    Vector<S, dynamic> dq = zeros_like(q);
    Vector<S, dynamic> dp = zeros_like(p);
    functions.gradient(q, p, dq, dp);
    S sum(0);
    for (std::size_t i = 0; i < moving; ++i) sum += p[i] * dp[i];
    return sum;
  }
  /// Whether there are scaled functions, known at run time; their bits differ from those of products.
  bool has_scaled_velocity() const requires(separable&& takes_factors<R>) { return on<R>().has_scaled_velocity(); }
  bool has_scaled_force() const requires(separable&& takes_factors<R>) { return on<R>().has_scaled_force(); }
  template <class S>
  requires(separable&& takes_factors<S>) void scaled_velocity(const std::type_identity_t<S>& factor,
                                                              const Vector<S, dynamic>& p,
                                                              Vector<S, dynamic>& v) const {
    on<S>().scaled_velocity(factor, p, v);
  }
  template <class S>
  requires(separable&& takes_factors<S>) void scaled_force(const std::type_identity_t<S>& factor,
                                                           const Vector<S, dynamic>& q, Vector<S, dynamic>& f) const {
    on<S>().scaled_force(factor, q, f);
  }
  template <class S>
  void gradient(const Vector<S, dynamic>& q, const Vector<S, dynamic>& p, Vector<S, dynamic>& dq,
                Vector<S, dynamic>& dp) const {
    on<S>().gradient(q, p, dq, dp);
  }
  template <class S>
  void hessian(const Vector<S, dynamic>& q, const Vector<S, dynamic>& p, Matrix<S, dynamic>& qq, Matrix<S, dynamic>& qp,
               Matrix<S, dynamic>& pp) const {
    on<S>().hessian(q, p, qq, qp, pp);
  }
  template <class S>
  void force_and_hessian(const Vector<S, dynamic>& q, Vector<S, dynamic>& f,
                         Matrix<S, dynamic>& h) const requires separable {
    on<S>().force_and_hessian(q, f, h);
  }
  template <class S>
  void forces_at(std::size_t count, const S* q, S* f) const requires separable {
    on<S>().forces_at(size_, count, q, f);
  }
  template <class S>
  void forces_and_hessians_at(std::size_t count, const S* q, S* f, S* h) const requires separable {
    on<S>().forces_and_hessians_at(size_, count, q, f, h);
  }
  template <class S>
  void gradients_at(std::size_t count, const S* q, const S* p, S* dq, S* dp) const {
    on<S>().gradients_at(size_, count, q, p, dq, dp);
  }
  template <class S>
  void hessians_at(std::size_t count, const S* q, const S* p, S* qq, S* qp, S* pp) const {
    on<S>().hessians_at(size_, count, q, p, qq, qp, pp);
  }
  template <class S>
  void potential_hessian(const Vector<S, dynamic>& q, Matrix<S, dynamic>& h) const requires separable {
    Vector<S, dynamic> f = zeros_like(q);
    on<S>().force_and_hessian(q, f, h);
  }
  template <class S>
  Vector<S, dynamic> invariants(const Vector<S, dynamic>& q, const Vector<S, dynamic>& p, const S& t) const {
    return on<S>().invariants(q, p, t);
  }
  const std::vector<std::size_t>& invariant_sizes() const { return *invariant_sizes_; }
  std::string label() const { return on<R>().label(); }
  /// The number of last invariants that are residuals of constraints, 2 or 0, known at run time.
  std::size_t residual_groups() const { return on<R>().residual_groups(); }
  template <class S>
  Vector<S, dynamic> constraints(const Vector<S, dynamic>& q) const requires constrained {
    return on<S>().constraints(q);
  }
  template <class S>
  Gradients<S, dynamic> constraint_gradients(const Vector<S, dynamic>& q) const requires constrained {
    return on<S>().constraint_gradients(q);
  }

  using Reduced = AnyProblem<R, Capability::separable | Capability::quadratic_kinetic>;
  Reduced reduced(const R& momentum) const requires cyclic { return {size_ - 1, on<R>().reduced(momentum)}; }
  R cyclic_rate(const Vector<R, dynamic>& q, const R& momentum) const requires cyclic {
    return on<R>().cyclic_rate(q, momentum);
  }
  template <class S>
  void velocity_of(const Vector<S, dynamic>& q, const Vector<S, dynamic>& p,
                   Vector<S, dynamic>& v) const requires charge {
    on<S>().velocity_of(q, p, v);
  }
  template <class S>
  void momentum_of(const Vector<S, dynamic>& q, const Vector<S, dynamic>& v,
                   Vector<S, dynamic>& p) const requires charge {
    on<S>().momentum_of(q, v, p);
  }
  /// Requires that the problem defines it, which is known only at run time.
  template <class S>
  S distance_rate(const Vector<S, dynamic>& q, const Vector<S, dynamic>& v) const {
    return on<S>().distance_rate(q, v);
  }
  /// Whether the functions exist for states of this number type.
  template <class S>
  static constexpr bool knows = (std::is_same_v<S, R> || ... || std::is_same_v<S, Others>);
  Vector<R, dynamic> rotation() const requires charge { return on<R>().rotation(); }
  std::size_t radial_space() const requires radial { return on<R>().radial_space(); }
  std::vector<RadialTerm<R>> radial_terms() const requires radial { return on<R>().radial_terms(); }
  template <class S>
  RadialLaw<S> radial_law(const S& u) const requires radial {
    return on<S>().radial_law(u);
  }
  PointMasses<base_scalar<R>> point_masses() const requires gravitating { return on<R>().point_masses(); }

 private:
  template <class S>
  const Functions<S>& on() const {
    return *std::get<std::shared_ptr<const Functions<S>>>(functions_);
  }
  std::size_t size_;
  std::tuple<std::shared_ptr<const Functions<R>>, std::shared_ptr<const Functions<Others>>...> functions_;
  bool has_clock_ = false;
  std::shared_ptr<const std::vector<std::size_t>> invariant_sizes_;  // needed at every step
};

}  // namespace hamflow
