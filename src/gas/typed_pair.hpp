// A typed phi(r) as a pair law (problems/pairs).
#pragma once

#include "problems/typed_potential.hpp"

namespace hamflow {

template <class R>
class TypedPair {
 public:
  explicit TypedPair(TypedPotential<R> phi) : phi_(std::move(phi)) {}
  template <class S>
  S value(const S& u) const {
    return phi_.value(u);
  }
  template <class S>
  S first(const S& u) const {
    return phi_.slope(u) / R(2);
  }
  template <class S>
  S second(const S& u) const {
    return phi_.derivatives(u).curvature / R(4);
  }

 private:
  TypedPotential<R> phi_;
};

}  // namespace hamflow
