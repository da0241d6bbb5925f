// Lennard-Jones pairs, phi(r) = r^-12 - 2 r^-6, with the minimum -1 at r = 1 [Sonnleitner2010, ch. 1.7]; with epsilon
// or sigma the usual form 4 epsilon ((sigma/r)^12 - (sigma/r)^6).
#pragma once

#include "hamflow/core/problem_info.hpp"

namespace hamflow::pairs {

template <class R>
class LennardJones {
 public:
  /// phi = repulsion w^6 - attraction w^3, w = length_squared/r^2.
  struct Coefficients {
    R repulsion{1};
    R attraction{2};
    R length_squared{1};
  };

  explicit LennardJones(const Parameters<R>& given) {
    if (!given.has("epsilon") && !given.has("sigma")) return;
    c_.repulsion = c_.attraction = R(4) * (given.has("epsilon") ? given["epsilon"] : R(1));
    const R sigma = given.has("sigma") ? given["sigma"] : R(1);
    c_.length_squared = sigma * sigma;
  }
  static ProblemInfo info() {
    return {.name = "lennard-jones",
            .formula = "phi(r) = r^-12 - 2 r^-6",
            .reference = "Sonnleitner2010, ch. 1.7",
            .parameters = {{.name = "epsilon",
                            .meaning = "depth epsilon of 4 epsilon ((sigma/r)^12 - (sigma/r)^6). With sigma = 1 "
                                       "particles at distance 1 repel each other, and a lattice of them flies apart",
                            .range = Range::positive,
                            .unset = "1 with sigma; without both phi = r^-12 - 2 r^-6",
                            .example = "1"},
                           {.name = "sigma",
                            .meaning = "zero sigma of that potential; for r^-12 - 2 r^-6 it is 2^(-1/6)",
                            .range = Range::positive,
                            .unset = "1 with epsilon",
                            .example = "2^(-1/6)"}}};
  }

  /// phi as a function of u = r^2, and its derivatives by u.
  template <class S>
  S value(const S& u) const {
    const S w = c_.length_squared / u;
    const S cube = w * w * w;
    return (c_.repulsion * cube - c_.attraction) * cube;
  }
  template <class S>
  S first(const S& u) const {
    const S inverse = R(1) / u;
    const S w = c_.length_squared * inverse;
    const S cube = w * w * w;
    return (R(3) * c_.attraction - R(6) * c_.repulsion * cube) * cube * inverse;
  }
  template <class S>
  S second(const S& u) const {
    const S inverse = R(1) / u;
    const S w = c_.length_squared * inverse;
    const S cube = w * w * w;
    return (R(42) * c_.repulsion * cube - R(12) * c_.attraction) * cube * inverse * inverse;
  }
  const Coefficients& coefficients() const { return c_; }

 private:
  Coefficients c_;
};

}  // namespace hamflow::pairs
