// The container of a gas: a soft wall (a circle in the plane, a sphere in space), V = 1/(2 S^(2+2e)) sum_i 1/(R^2 -
// |q_i|^2)^e [Sonnleitner2010, ch. 3a]; a periodic box, in which the distance of a pair is that of its nearest images;
// or none. The hard walls of a box are walls on coordinates (src/walls/walled_simulation.cpp).
#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "core/outside_note.hpp"
#include "hamflow/core/math.hpp"
#include "hamflow/core/problem_info.hpp"

namespace hamflow {

enum class ContainerKind { none, circle, box, periodic };

struct ContainerNames {
  static constexpr const char* none = "none";
  static constexpr const char* circle = "circle";
  static constexpr const char* box = "box";
  static constexpr const char* periodic = "periodic";
  static ContainerKind kind(const std::string& name) {
    return name == circle     ? ContainerKind::circle
           : name == box      ? ContainerKind::box
           : name == periodic ? ContainerKind::periodic
                              : ContainerKind::none;
  }
};

/// x^-e for a whole e by products, so that the bits do not depend on a library.
template <class R, class S>
S negative_power(const S& x, const R& e, int whole) {
  if (whole == 0) return exp(S(R(-e)) * log(x));
  const S inverse = R(1) / x;
  S power = inverse;
  for (int i = 1; i < whole; ++i) power = power * inverse;
  return power;
}

/// The soft wall of one particle: V(g) = strength g^-e, g = R^2 - |q|^2.
template <class R>
class SoftWall {
 public:
  SoftWall() = default;
  SoftWall(const R& radius, const R& exponent, const R& scale) : square_(radius * radius), exponent_(exponent) {
    const auto e = static_cast<double>(exponent);
    if (e == std::floor(e) && e <= 64) whole_ = static_cast<int>(e);
    const R square = scale * scale;
    strength_ = negative_power(square, exponent_, whole_) / (R(2) * square);
  }

  template <class S>
  S potential(const S* q, std::size_t space, std::size_t particle) const {
    const S g = room(q, space, particle);
    return strength_ * power(g);
  }
  /// The force is the result times q.
  template <class S>
  S pull(const S* q, std::size_t space, std::size_t particle) const {
    const S g = room(q, space, particle);
    return R(-2) * strength_ * exponent_ * (power(g) / g);
  }
  /// V_qq = first I + second q q^T.
  template <class S>
  std::array<S, 2> hessian_factors(const S* q, std::size_t space, std::size_t particle) const {
    const S g = room(q, space, particle);
    const S first = R(2) * strength_ * exponent_ * (power(g) / g);
    return {first, R(2) * (exponent_ + R(1)) * (first / g)};
  }

 private:
  /// R^2 - |q|^2; NaN, and recorded in OutsideNote, if the particle is on or beyond the wall.
  template <class S>
  S room(const S* q, std::size_t space, std::size_t particle) const {
    S g(square_);
    for (std::size_t k = 0; k < space; ++k) g -= q[k] * q[k];
    if constexpr (requires { g.is_exact(); }) {
      if (!g.is_exact()) return g;  // a Taylor series cannot branch; the check is made at the ends of its steps
    }
    if (S(R(0)) < g) return g;
    OutsideNote::note(particle);
    return S(std::numeric_limits<R>::quiet_NaN());
  }
  template <class S>
  S power(const S& g) const {
    return negative_power(g, exponent_, whole_);
  }

  R square_{};
  R exponent_{};
  R strength_{};
  int whole_ = 0;  // the exponent if it is a whole number
};

}  // namespace hamflow
