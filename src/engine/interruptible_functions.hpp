// The functions of a problem with a check for a requested stop before each evaluation
// (src/engine/step_interruption.hpp).
#pragma once

#include <memory>

#include "forwarding_functions.hpp"
#include "step_interruption.hpp"

namespace hamflow {

template <class S>
class InterruptibleFunctions final : public ForwardingFunctions<S> {
  using Base = ForwardingFunctions<S>;
  using Base::exact_;

 public:
  using Base::Base;
  using typename Base::M;
  using typename Base::Pointer;
  using typename Base::V;

  S energy(const V& q, const V& p) const override { return asked().energy(q, p); }
  S kinetic(const V& p) const override { return asked().kinetic(p); }
  S potential(const V& q) const override { return asked().potential(q); }
  void velocity(const V& p, V& v) const override { asked().velocity(p, v); }
  void force(const V& q, V& f) const override { asked().force(q, f); }
  void gradient(const V& q, const V& p, V& dq, V& dp) const override { asked().gradient(q, p, dq, dp); }
  void hessian(const V& q, const V& p, M& qq, M& qp, M& pp) const override { asked().hessian(q, p, qq, qp, pp); }
  void force_and_hessian(const V& q, V& f, M& h) const override { asked().force_and_hessian(q, f, h); }
  V constraints(const V& q) const override { return asked().constraints(q); }
  Gradients<S, dynamic> constraint_gradients(const V& q) const override { return asked().constraint_gradients(q); }
  Pointer reduced(const S& momentum) const override { return asking(exact_->reduced(momentum)); }
  S cyclic_rate(const V& q, const S& momentum) const override { return asked().cyclic_rate(q, momentum); }
  RadialLaw<S> radial_law(const S& u) const override { return asked().radial_law(u); }

  static Pointer asking(Pointer exact) { return shared_functions<S>(new InterruptibleFunctions(std::move(exact))); }

 private:
  const Functions<S>& asked() const {
    StepInterruption::ask();
    return *exact_;
  }
};

}  // namespace hamflow
