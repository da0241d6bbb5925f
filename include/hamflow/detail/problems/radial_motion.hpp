// The radial motion in a central potential, in long double:
//     (mu/2) r'^2 = E - V_eff(r),   V_eff(r) = V(r) + l^2/(2 mu r^2).   [Gross1999, (2.39), (2.40)]
// Differences of V_eff are computed from the mean of V'(r)/r between two radii, so that close radii cause no
// cancellation; r' near a turning point r1 is the square root of (r - r1) times a function that does not vanish there.
#pragma once

#include <limits>
#include <vector>

#include "hamflow/core/math.hpp"
#include "hamflow/core/vector.hpp"
#include "hamflow/numerics/gauss_legendre.hpp"
#include "hamflow/numerics/quadrature.hpp"
#include "hamflow/numerics/root.hpp"

namespace hamflow {

/// A radius at which V_eff' = 0: a circular orbit, stable where V_eff has a minimum.
struct CircularOrbit {
  long double radius = 0;
  bool stable = false;
};

/// A class with value(u), slope(u) and derivatives(u) of u = r^2, a mass and a state.
template <class Potential>
class RadialMotion {
 public:
  using R = long double;
  static constexpr R infinity = std::numeric_limits<R>::infinity();

  /// @param rounding relative accuracy of the components of q and p; smaller quantities count as 0
  RadialMotion(const Potential& potential, R mass, const Vector<R, 2>& q, const Vector<R, 2>& p, R rounding)
      : potential_(potential), mass_(mass), rounding_(rounding) {
    r_ = hypot(q[0], q[1]);
    const R p_square = p[0] * p[0] + p[1] * p[1];
    const R left = q[0] * p[1];
    const R right = q[1] * p[0];
    l_ = abs(left - right) > rounding * (abs(left) + abs(right)) ? left - right : R(0);
    radial_velocity_ = r_ > R(0) ? (q[0] * p[0] + q[1] * p[1]) / (r_ * mass) : sqrt(p_square) / mass;
    if (l_ == R(0)) radial_velocity_ = copysign(sqrt(p_square) / mass, radial_velocity_);
    here_ = reference(r_);
    const R potential_energy = here_.value;
    energy_ = p_square / (R(2) * mass) + potential_energy;
    energy_rounding_ = R(4) * rounding * (p_square / (R(2) * mass) + abs(potential_energy));
    find_extrema();
    circular_ = is_circular(p_square);
    if (circular_) {
      r_min_ = r_max_ = r_;
    } else {
      r_max_ = turning_point(true);
      r_min_ = turning_point(false);
    }
    inner_ = reference(r_min_);
    outer_ = reference(r_max_);
  }

  R energy() const { return energy_; }
  R energy_rounding() const { return energy_rounding_; }
  R angular_momentum() const { return l_; }
  R radius() const { return r_; }
  R radial_velocity() const { return radial_velocity_; }
  R r_min() const { return r_min_; }               // 0 if the centre is reached
  R r_max() const { return r_max_; }               // infinity if the motion is unbounded
  bool circular() const { return circular_; }      // to rounding of the state
  bool marginal() const { return marginal_; }      // E is the limit of V_eff at infinity, to rounding: parabolic
  bool separatrix() const { return separatrix_; }  // a turning point takes infinite time: a maximum of V_eff
  const std::vector<CircularOrbit>& extrema() const { return extrema_; }  // all radii with V_eff' = 0, ascending

  /// E - V_eff(r), from the radial velocity at the radius of the state.
  R above(R r) const {
    return mass_ / R(2) * radial_velocity_ * radial_velocity_ +
           (r_ - r) * (r_ + r) / R(2) * mean_effective_slope(r, here_);
  }
  /// V_eff'(r)
  R effective_slope(R r) const { return r * potential_.slope(r * r) - l_ * l_ / (mass_ * r * r * r); }
  /// V_eff''(r)
  R effective_curvature(R r) const {
    const R u = r * r;
    const auto d = potential_.derivatives(u);
    return d.slope + u * d.curvature + (l_ == R(0) ? R(0) : R(3) * l_ * l_ / (mass_ * u * u));
  }
  /// The sum of the sizes of its terms, to estimate the effect of a rounding of the state.
  R size_of_curvature(R r) const {
    const R u = r * r;
    const auto d = potential_.derivatives(u);
    return abs(d.slope) + abs(u * d.curvature) + (l_ == R(0) ? R(0) : R(3) * l_ * l_ / (mass_ * u * u));
  }

  // ---- r'^2 without its zeros ----

  /// r'^2/(r - r_min)
  R from_inside(R r) const {
    if (r <= R(2) * r_min_) return positive(-(r + r_min_) / mass_ * mean_effective_slope(r, inner_));
    // r^2 (E - V) as a product, without l^2/r_min^2 and V(r_min), which cancel far out on a long orbit.
    const R value = potential_.value(r * r);
    const R mean_slope = R(2) * (value - inner_.value) / ((r - r_min_) * (r + r_min_));
    return positive((r + r_min_) * (R(2) / mass_) * (energy_ - value - r_min_ * r_min_ * mean_slope / R(2)) / (r * r));
  }
  /// r'^2/(r_max - r)
  R from_outside(R r) const { return positive((r + r_max_) / mass_ * mean_effective_slope(r, outer_)); }
  /// r'^2/((r - r_min)(r_max - r)) = (2/mu) V_eff[r_min, r, r_max], a divided difference; inside and outside are the
  /// distances to both turning points.
  R between(R r, R inside, R outside) const {
    if (r_max_ - r_min_ <= r_min_ / R(16)) return positive(R(2) / mass_ * second_difference(r));
    return inside < outside ? from_inside(r) / outside : from_outside(r) / inside;
  }

 private:
  static R positive(R x) { return x > R(0) ? x : R(0); }

  /// A radius and V there, kept because many differences refer to it.
  struct Reference {
    R r = 0;
    R value = 0;
  };
  Reference reference(R r) const { return {r, r < infinity ? potential_.value(r * r) : R(0)}; }

  /// The mean of slope(u) between u = r^2 and s^2: 2 (V(r) - V(s))/(r^2 - s^2). Gauss' rule where that would cancel;
  /// its points suffice for 1e-19 with V ~ r^-12, whose singularity is at 0.
  R mean_slope(R r, const Reference& s) const {
    const R u = r * r;
    const R v = s.r * s.r;
    const R distance = (r - s.r) * (r + s.r);
    const R share = abs(distance) / (u < v ? u : v);
    if (!(share <= R(0.125))) return R(2) * (potential_.value(u) - s.value) / distance;
    const auto& rule = gauss_rule<R>(share > R(1) / R(512) ? 8 : share > R(1e-5) ? 4 : share > R(1e-10) ? 2 : 1);
    R mean(0);
    for (std::size_t i = 0; i < rule.c.size(); ++i) mean += rule.b[i] * potential_.slope(R(v + rule.c[i] * distance));
    return mean;
  }
  /// As above, for V_eff.
  R mean_effective_slope(R r, const Reference& s) const {
    const R slope = mean_slope(r, s);
    return l_ == R(0) ? slope : slope - l_ / (r * r) * (l_ / (s.r * s.r)) / mass_;
  }
  /// V_eff[r_min, r, r_max] for close turning points: the mean of V'' over the triangle of Hermite and Genocchi.
  R second_difference(R r) const {
    const R a = r_min_;
    const R c = r_max_;
    const R share = (c - a) / a;
    const auto& rule = gauss_rule<R>(share > R(1) / R(1024) ? 6 : share > R(1e-6) ? 3 : 2);
    R sum(0);
    for (std::size_t i = 0; i < rule.c.size(); ++i) {
      for (std::size_t j = 0; j < rule.c.size(); ++j) {
        const R x = a + rule.c[i] * ((c - a) + rule.c[j] * (r - c));
        const auto d = potential_.derivatives(x * x);
        sum += rule.b[i] * rule.b[j] * rule.c[i] * (d.slope + x * x * d.curvature);
      }
    }
    const R product = a * r * c;
    return sum + l_ * l_ / (R(2) * mass_) * (a * c + r * a + r * c) / (product * product);
  }

  // ---- extrema and turning points ----

  /// r^3 V_eff'(r) = r^3 V' - l^2/mu and its derivative over r^3, 3 V'/r + V'': neither contains a steep centrifugal
  /// term.
  struct Steepness {
    R r;
    R value;
    R slope;
  };
  Steepness steepness(R r) const {
    const R u = r * r;
    const auto d = potential_.derivatives(u);
    return {r, u * u * d.slope - l_ * l_ / mass_, R(4) * d.slope + u * d.curvature};
  }
  void add_extremum(const Steepness& a, const Steepness& b) {
    if ((a.value > R(0)) == (b.value > R(0))) return;
    const R root = bracketed_root([this](R r) { return steepness(r).value; }, a.r, b.r, a.value, b.value);
    extrema_.push_back({root, (b.value > R(0)) == (b.r > a.r)});
  }
  /// The extrema of V_eff within a factor of 2^300 of the radius, searched with a finer grid near it (steps of 19 % up
  /// to a factor of 256). If r^3 V' is monotone between neighbouring points there is at most one; at an extremum of r^3
  /// V' the interval is divided. Two extrema of r^3 V' within one step are not found, but sums of powers do not have
  /// these.
  void find_extrema() {
    const R center = r_ > R(0) ? r_ : R(1);
    const R fine = exp(log(R(2)) / R(4));
    for (const bool outward : {false, true}) {
      Steepness a = steepness(center);
      R r = center;
      for (int k = 0; k < 32 + 28 + 17; ++k) {
        const R factor = k < 32 ? fine : k < 32 + 28 ? R(2) : R(1 << 16);
        r = outward ? r * factor : r / factor;
        const Steepness b = steepness(r);
        if (!isfinite(b.value) || !isfinite(b.slope)) break;
        if ((a.slope > R(0)) != (b.slope > R(0))) {
          const R cut = bracketed_root([this](R x) { return steepness(x).slope; }, a.r, b.r, a.slope, b.slope);
          const Steepness c = steepness(cut);
          add_extremum(a, c);
          add_extremum(c, b);
        } else {
          add_extremum(a, b);
        }
        a = b;
      }
      if (!outward) extrema_ = {extrema_.rbegin(), extrema_.rend()};
    }
  }
  /// No radial velocity and no radial force, both to 16 roundings of their terms.
  bool is_circular(R p_square) const {
    if (!(r_ > R(0))) return p_square == R(0);
    const R attraction = r_ * potential_.slope(r_ * r_);
    const R centrifugal = l_ * l_ / (mass_ * r_ * r_ * r_);
    return abs(attraction - centrifugal) <= R(16) * rounding_ * (abs(attraction) + centrifugal) &&
           abs(radial_velocity_) * mass_ <= R(16) * rounding_ * sqrt(p_square);
  }

  /// Between a radius that is reached, where E - V_eff may be 0 to rounding, and one that is not.
  R root(R from, R to) const {
    return bracketed_root([this](R r) { return above(r); }, from, to, infinity, -infinity);
  }
  /// The first zero of E - V_eff from the radius of the state, outward or inward. Between extrema V_eff is monotone, so
  /// its signs there decide.
  R turning_point(bool outward) {
    if (radial_velocity_ == R(0) && (effective_slope(r_) > R(0)) == outward) return r_;
    R from = r_;
    for (std::size_t i = 0; i < extrema_.size(); ++i) {
      const CircularOrbit& at = extrema_[outward ? i : extrema_.size() - 1 - i];
      if (outward ? at.radius <= r_ : at.radius >= r_) continue;
      const R there = above(at.radius);
      if (!at.stable && abs(there) <= energy_rounding_) {
        separatrix_ = true;
        return at.radius;
      }
      if (there < R(0)) return root(from, at.radius);
      from = at.radius;
    }
    const R center = r_ > R(0) ? r_ : R(1);
    const R far = outward ? center * 0x1p300L : center * 0x1p-300L;
    const R there = above(far);
    if (!(there < -energy_rounding_)) {
      if (outward && abs(there) <= energy_rounding_) {
        marginal_ = true;
        energy_ = potential_.value(far * far);  // infinity is reached, with no speed
      }
      if (!outward && l_ == R(0) && abs(there) <= energy_rounding_ && isfinite(potential_.slope(R(0))))
        separatrix_ = true;
      return outward ? infinity : R(0);
    }
    R to = from > R(0) ? from : center / R(2);
    for (int k = 0; k < 1000; ++k) {
      to = outward ? R(2) * to : to / R(2);
      if (above(to) < R(0)) break;
      from = to;
    }
    return root(from, to);
  }

  Potential potential_;
  R mass_;
  R rounding_;
  R r_ = 0;
  R l_ = 0;
  R radial_velocity_ = 0;
  R energy_ = 0;
  R energy_rounding_ = 0;
  R r_min_ = 0;
  R r_max_ = 0;
  Reference here_;
  Reference inner_;
  Reference outer_;
  bool circular_ = false;
  bool marginal_ = false;
  bool separatrix_ = false;
  std::vector<CircularOrbit> extrema_;
};

/// Time and phase along a radial motion from an apsis: from pericentre if there is one, else from apocentre, else from
/// the centre. The radius is a function of a parameter x >= 0 in which both are smooth.
template <class Potential>
class RadialClock {
 public:
  using R = long double;
  enum class From { pericentre_to_apocentre, pericentre_to_infinity, apocentre_to_centre, centre_to_infinity };

  /// At a parameter: the radius, the absolute radial velocity, dt/dx and dphi/dx.
  struct At {
    R r;
    R speed;
    R time;
    R phase;
  };

  explicit RadialClock(const RadialMotion<Potential>& motion, R mass)
      : motion_(motion), rate_(motion.angular_momentum() / mass), mass_(mass) {
    const bool inner = motion.r_min() > R(0);
    const bool outer = motion.r_max() < motion.infinity;
    from_ = inner ? (outer ? From::pericentre_to_apocentre : From::pericentre_to_infinity)
                  : (outer ? From::apocentre_to_centre : From::centre_to_infinity);
    end_ = from_ == From::pericentre_to_apocentre ? pi_value<R>()
           : from_ == From::apocentre_to_centre   ? sqrt(motion.r_max())
                                                  : motion.infinity;
  }

  From from() const { return from_; }
  /// x at the other end.
  R end() const { return end_; }
  /// Whether every integral so far has converged, that is, E - V_eff is above rounding everywhere on the path.
  bool settled() const { return settled_; }
  /// @param to_end end() - x, to its own relative precision
  At at(R x, R to_end) const {
    const R r1 = motion_.r_min();
    const R r2 = motion_.r_max();
    if (from_ == From::pericentre_to_apocentre) {  // r = (r1 + r2)/2 - (r2 - r1)/2 cos x
      const R s = sin(x / R(2));
      const R c = sin(to_end / R(2));
      const R inside = (r2 - r1) * s * s;
      const R outside = (r2 - r1) * c * c;
      const R r = inside < outside ? r1 + inside : r2 - outside;
      const R root = sqrt(motion_.between(r, inside, outside));
      return make(r, (r2 - r1) * s * c * root, R(1) / root);
    }
    if (from_ == From::pericentre_to_infinity) {  // r = r1 + x^2
      const R r = r1 + x * x;
      const R root = sqrt(motion_.from_inside(r));
      return make(r, x * root, R(2) / root);
    }
    if (from_ == From::apocentre_to_centre) {  // r = r2 - x^2
      const R r = to_end * (end_ + x);
      const R root = sqrt(motion_.from_outside(r));
      return make(r, x * root, R(2) / root);
    }
    const R above = motion_.above(x);
    const R speed = above > R(0) ? sqrt(R(2) / mass_ * above) : R(0);
    return make(x, speed, R(1) / speed);
  }
  At at(R x) const { return at(x, end_ - x); }

  /// The x of the state, from the radial velocity, which near an apsis is more accurate than the radius.
  R start() const {
    const R r = motion_.radius();
    const R speed = abs(motion_.radial_velocity());
    switch (from_) {
      case From::pericentre_to_apocentre: {
        const R inside = r - motion_.r_min();
        const R outside = motion_.r_max() - r;
        const R twice_sine = speed > R(0) ? R(2) * speed / sqrt(motion_.between(r, inside, outside)) : R(0);
        return atan2(twice_sine, outside - inside);
      }
      case From::pericentre_to_infinity:
        return speed > R(0) ? speed / sqrt(motion_.from_inside(r)) : R(0);
      case From::apocentre_to_centre:
        return speed > R(0) && r > R(0) ? speed / sqrt(motion_.from_outside(r)) : (r > R(0) ? R(0) : end_);
      default:
        return r;
    }
  }

  R time(R x) const {
    return integral(x, [](const At& at) { return at.time; });
  }
  R phase(R x) const {
    return integral(x, [](const At& at) { return at.phase; });
  }
  /// The phase between two radii of a motion without apsis.
  R phase(R x, R y) const {
    return noted(integrate([this](R z) { return at(z).phase; }, x, y));
  }
  /// The phase from pericentre to infinity: r = r1/(1 - z^2).
  R phase_to_infinity() const {
    const R r1 = motion_.r_min();
    return integrate_from_ends(
               [&](R z, R to_one) {
                 const R w = to_one * (R(1) + z);
                 return R(2) * rate_ / r1 / sqrt(r1 * motion_.from_inside(r1 / w) / w);
               },
               R(1))
        .value;
  }
  /// x at a given time; NaN if it is not reached (infinity in finite time).
  R when(R time_since_apsis) const {
    if (!(time_since_apsis > R(0))) return R(0);
    R low(0);
    R high = end_;
    if (!(high < motion_.infinity)) {
      high = time_since_apsis / at(R(0)).time;
      if (!(high > R(0) && isfinite(high))) high = sqrt(motion_.radius() + R(1));
      R factor(2);  // growing, so that infinity in finite time is soon recognised
      while (time(high) < time_since_apsis) {
        if (factor > 0x1p24L) return std::numeric_limits<R>::quiet_NaN();
        low = high;
        high = factor * high;
        factor = R(2) * factor;
      }
    }
    return bracketed_root([&](R x) { return time(x) - time_since_apsis; }, low, high, -motion_.infinity,
                          motion_.infinity);
  }

 private:
  At make(R r, R speed, R time) const { return {r, speed, time, rate_ == R(0) ? R(0) : rate_ / (r * r) * time}; }
  template <class F>
  R integral(R x, F&& part) const {
    if (!(x > R(0))) return R(0);
    const R rest = end_ < motion_.infinity ? end_ - x : R(0);
    return noted(integrate_from_ends([&](R left, R right) { return part(at(left, rest + right)); }, x));
  }
  R noted(const Integral& found) const {
    constexpr R small = R(1e-13);  // smaller errors come from rounding in E - V_eff; neighbouring starts show those
    settled_ = settled_ && found.error <= small * abs(found.value);
    return found.value;
  }

  const RadialMotion<Potential>& motion_;
  R rate_;  // r^2 phi'
  R mass_;
  R end_ = 0;
  From from_{};
  mutable bool settled_ = true;
};

}  // namespace hamflow
