// A typed V(r) as a central potential (detail/problems/potential.hpp), so that turning points, starts by energy and
// orbit facts follow from the effective potential as for built-in potentials.
#pragma once

#include "hamflow/detail/formula/bound_model.hpp"
#include "hamflow/detail/problems/potential.hpp"

namespace hamflow {

template <class R>
class TypedPotential {
 public:
  /// @param model of p_r^2/2 + V(r) in the coordinate r
  TypedPotential(std::shared_ptr<const formula::Model> model, const Parameters<R>& parameters)
      : model_(std::move(model), parameters) {}

  template <class S>
  S value(const S& u) const {
    return model_.template potential<S>({S(sqrt(u))});
  }
  template <class S>
  S slope(const S& u) const {
    const S r = sqrt(u);
    Vector<S, dynamic> force(1);
    model_.template force<S>({r}, force);
    return -force[0] / r;
  }
  /// W'' from V'' = d/dr (r slope): 4 W'' = (V'' - slope)/u.
  template <class S>
  CentralDerivatives<S> derivatives(const S& u) const {
    const S r = sqrt(u);
    Vector<S, dynamic> force(1);
    Matrix<S, dynamic> second(1);
    model_.template force_and_hessian<S>({r}, force, second);
    const S slope = -force[0] / r;
    return {slope, (second[0][0] - slope) / u};
  }

 private:
  formula::BoundModel<R> model_;
};

}  // namespace hamflow
