// A pair potential with a cut-off at a distance R. All three forms are potentials, so that H is exact:
//   shifted        phi(r) - phi(R): continuous, its force jumps at R;
//   force-shifted  phi(r) - phi(R) - (r - R) phi'(R): the force is continuous;
//   smooth         phi(r) s(r^2), s = 1 up to `inner`, 0 from R on, between them the polynomial of degree 9 in r^2 with
//                  four derivatives that vanish at both ends: as smooth as a method of fourth order needs.
#pragma once

#include "hamflow/core/math.hpp"
#include "hamflow/core/problem_info.hpp"
#include "hamflow/detail/core/radial_forces.hpp"

namespace hamflow {

enum class CutoffKind { none, shifted, force_shifted, smooth };

struct CutoffNames {
  static constexpr const char* none = "none";
  static constexpr const char* shifted = "shifted";
  static constexpr const char* force_shifted = "force-shifted";
  static constexpr const char* smooth = "smooth";
  static CutoffKind kind(const std::string& name) {
    return name == shifted         ? CutoffKind::shifted
           : name == force_shifted ? CutoffKind::force_shifted
           : name == smooth        ? CutoffKind::smooth
                                   : CutoffKind::none;
  }
};

/// Lengths are in the units of the potential.
template <class R>
struct Cutoff {
  CutoffKind kind = CutoffKind::none;
  R radius{};
  R inner{};      // for smooth
  R at_radius{};  // phi(R)
  R rate{};       // dphi/dr at R
  R square{};     // R^2
  R inner_square{};
  R inverse_width{};  // 1/(R^2 - inner^2)

  Cutoff() = default;
  template <class Law>
  Cutoff(CutoffKind k, const R& outer, const R& from, const Law& law)
      : kind(k), radius(outer), inner(from), square(outer * outer), inner_square(from * from) {
    if (kind == CutoffKind::shifted || kind == CutoffKind::force_shifted) at_radius = law.value(square);
    if (kind == CutoffKind::force_shifted) rate = R(2) * radius * law.first(square);
    if (kind == CutoffKind::smooth) inverse_width = R(1) / (square - inner_square);
  }

  template <class S>
  bool ends(const S& w) const {
    return kind != CutoffKind::none && !(w < S(square));
  }
  template <class S>
  S value(const S& w, const S& phi) const {
    switch (kind) {
      case CutoffKind::none:
        break;
      case CutoffKind::shifted:
        return phi - at_radius;
      case CutoffKind::force_shifted:
        return phi - at_radius - (sqrt(w) - radius) * rate;
      case CutoffKind::smooth:
        if (S(inner_square) < w) return phi * fade(w);
        break;
    }
    return phi;
  }
  /// @param law evaluates phi
  template <class S, class Law>
  S first(const S& w, const S& slope, const Law& law) const {
    if (kind == CutoffKind::force_shifted) return slope - rate / (R(2) * sqrt(w));
    if (kind == CutoffKind::smooth && S(inner_square) < w) return slope * fade(w) + law.value(w) * fade_first(w);
    return slope;
  }
  template <class S, class Law>
  S second(const S& w, const S& curvature, const Law& law) const {
    if (kind == CutoffKind::force_shifted) return curvature + rate / (R(4) * w * sqrt(w));
    if (kind == CutoffKind::smooth && S(inner_square) < w) {
      return curvature * fade(w) + R(2) * law.first(w) * fade_first(w) + law.value(w) * fade_second(w);
    }
    return curvature;
  }

 private:
  /// The switching function s: 1 at `inner`, 0 at R.
  template <class S>
  S place(const S& w) const {
    return (square - w) * inverse_width;
  }
  template <class S>
  S fade(const S& w) const {
    const S y = place(w);
    const S y2 = y * y;
    return y2 * y2 * y * (R(126) + y * (R(-420) + y * (R(540) + y * (R(-315) + R(70) * y))));
  }
  template <class S>
  S fade_first(const S& w) const {
    const S y = place(w);
    const S hump = y * (R(1) - y);
    return R(-630) * inverse_width * (hump * hump * hump * hump);
  }
  template <class S>
  S fade_second(const S& w) const {
    const S y = place(w);
    const S hump = y * (R(1) - y);
    return R(2520) * inverse_width * inverse_width * (hump * hump * hump) * (R(1) - R(2) * y);
  }
};

}  // namespace hamflow
