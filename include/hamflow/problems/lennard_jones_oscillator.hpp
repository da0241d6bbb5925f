// One particle in a Lennard-Jones well, H = p^2/2 + 1/q^12 - 2/q^6, minimum -1 at q = 1.   [Sonnleitner2010, p. 37-42]
// Bounded for H < 0; the seed's start q = 1.5, p = 0 has H = -0.1678756438...
#pragma once

#include "hamflow/core/problem_info.hpp"
#include "hamflow/detail/problems/one_dimensional.hpp"

namespace hamflow {

template <class R = double>
class LennardJonesOscillator : public OneDimensional<R> {
 public:
  LennardJonesOscillator() : OneDimensional<R>(R(1)) {}
  explicit LennardJonesOscillator(const Parameters<R>&) : LennardJonesOscillator() {}

  static ProblemInfo info() {
    return {.name = "lennard-jones-oscillator",
            .formula = "H = p^2/2 + 1/q^12 - 2/q^6",
            .reference = "Sonnleitner2010, p. 37-42",
            .coordinates = {"q"},
            .default_q = {"1.5"},
            .default_p = {"0"},
            .region = {.centre = {1.25, 0.25}, .spread = 0.05, .step = 0.025, .time = 0.7}};
  }

  template <class S>
  S potential(const Vector<S, 1>& q) const {
    const S i6 = inverse_sixth(q[0]);
    return i6 * i6 - R(2) * i6;
  }
  /// -V' = 12/q^13 - 12/q^7.
  template <class S>
  void force(const Vector<S, 1>& q, Vector<S, 1>& f) const {
    const S i6 = inverse_sixth(q[0]);
    f[0] = R(12) * (i6 * i6 - i6) / q[0];
  }
  /// V'' = 156/q^14 - 84/q^8.
  template <class S>
  void potential_hessian(const Vector<S, 1>& q, Matrix<S, 1>& out) const {
    const S i6 = inverse_sixth(q[0]);
    out[0][0] = (R(156) * i6 - R(84)) * i6 / (q[0] * q[0]);
  }

 private:
  template <class S>
  static S inverse_sixth(const S& q) {
    const S i2 = R(1) / (q * q);
    return i2 * i2 * i2;
  }
};

}  // namespace hamflow
