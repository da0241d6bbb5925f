// A kernel of its own for kick-drift-kick, sound or with a fault in how it keeps the force.
#pragma once

#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/method_info.hpp"
#include "hamflow/core/outcome.hpp"
#include "hamflow/core/phase_point.hpp"

namespace hamflow::mutants {

enum class KernelFault { none, stale_force, force_computed_twice };

template <class P, Arithmetic A>
class VerletKernel {
 public:
  static constexpr std::size_t n = P::dimension;
  using Real = typename A::Real;
  using Base = base_scalar<Real>;
  explicit VerletKernel(KernelFault fault, std::string name) : fault_(fault), name_(std::move(name)) {}

  MethodInfo info() const {
    return {.name = name_,
            .order = 2,
            .symplectic = true,
            .weakly_reversible = true,
            .symmetric = true,
            .reversible = true,
            .forces_per_step = 1};
  }
  Outcome step(const P& problem, const Base& h, PhasePoint<A, n>& z) {
    if (!current_ || fault_ == KernelFault::force_computed_twice) evaluate(problem, z);
    z.push(h / 2, force_);
    Vector<Real, n> v{};
    velocity(problem, z.momenta(), v);
    z.move(h, v);
    if (fault_ != KernelFault::stale_force) evaluate(problem, z);  // else the force is that before the drift
    z.push(h / 2, force_);
    current_ = fault_ != KernelFault::stale_force;
    return Outcome::done;
  }
  void invalidate() { current_ = false; }
  Effort effort() const { return {.force = forces_}; }

 private:
  void evaluate(const P& problem, const PhasePoint<A, n>& z) {
    force(problem, z.positions(), force_);
    ++forces_;
  }
  KernelFault fault_;
  std::string name_;
  Vector<Real, n> force_{};
  bool current_ = false;
  long long forces_ = 0;
};

struct VerletBy {
  static constexpr bool implicit = false;
  static constexpr bool bijective = true;
  template <class P>
  static constexpr bool accepts = Separable<P>;
  KernelFault fault;
  std::string name;
  template <class P, class A>
  using Stepper = VerletKernel<P, A>;
  template <class P, class A>
  Stepper<P, A> bind(const P&) const {
    return Stepper<P, A>(fault, name);
  }
};

}  // namespace hamflow::mutants
