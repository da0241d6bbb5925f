// A problem whose force is computed by its fast kernel. Everything else, the energy that is watched above all, stays.
//     hamflow::FastKernel problem{hamflow::CentralForce<double, hamflow::Kepler>(1, hamflow::Kepler<double>(1))};
// Results differ in the last bits from those of the problem itself, and between machines with and without the
// instructions (core/inverse_cube.hpp); without them they are those of the problem itself, bit for bit.
// Implicit methods, which ask for force and Hessian together, compute as before.
#pragma once

#include <utility>

#include "hamflow/core/concepts.hpp"

namespace hamflow {

template <HasFastForce P>
class FastKernel : public P {
 public:
  using P::P;
  explicit FastKernel(P problem) : P(std::move(problem)) {}

  template <class S>
  void force(const Vector<S, P::dimension>& q, Vector<S, P::dimension>& f) const {
    P::fast_force(q, f, RealOf<P>(1));
  }
  template <class F, class S>
  void scaled_force(const F& factor, const Vector<S, P::dimension>& q, Vector<S, P::dimension>& f) const {
    P::fast_force(q, f, factor);
  }
};

}  // namespace hamflow
