// Orbital elements of a state, for any conic, with the full accuracy of the state.
//
// Angles are arc tangents of two components, never arc cosines, which lose half of the digits near 0 and pi. Longitudes
// are sums of angles that may be undefined on a circle or in the plane; the undefined parts cancel, with their
// rounding. Near the parabola, elements follow from pericentre distance, beta = mu/a and 1 - e = beta q/mu, so that 1 -
// e is never computed as a difference.   [Danby1988, ch. 6]
#pragma once

#include "hamflow/core/vector.hpp"
#include "hamflow/detail/core/two.hpp"
#include "hamflow/orbits/universal_kepler.hpp"

namespace hamflow {

/// Angles are in radians, `inclination` in [0, pi], the others in [0, 2 pi). If `node` or `pericentre` is undefined (in
/// the plane, on a circle) it is 0, and the longitudes give the place.
template <class R>
struct OrbitalElements {
  R a;  // negative on a hyperbola, infinite on a parabola
  R e;
  R pericentre_distance;
  R inclination;
  R node;
  R pericentre;  // argument of the pericentre, from the node
  R longitude_of_pericentre;
  R true_anomaly;
  R mean_anomaly;           // hyperbola: e sinh F - F, of either sign; NaN on a parabola
  R mean_longitude;         // NaN unless the orbit is an ellipse
  R period;                 // NaN unless the orbit is an ellipse
  R time_since_pericentre;  // of either sign; ellipse: the nearest pericentre
};

namespace detail {

/// angle[i] = atan2(y[i], x[i]).
template <class R>
void arc_tangents(const R (&y)[6], const R (&x)[6], R (&angle)[6]) {
  for (int i = 0; i < 6; ++i) angle[i] = atan2(y[i], x[i]);
}

/// Computes six arc tangents with an error of at most 2 units in the last place; 0 for (0, 0). It processes two at a
/// time without branches, in a fifth of the time of the C library. The polynomial is the Chebyshev expansion of
/// (atan(t)/t - 1)/t^2 on [0, tan(pi/8)]; its error is 2^-57.
inline void arc_tangents(const double (&y)[6], const double (&x)[6], double (&angle)[6]) {
  constexpr double c[11] = {-0.3333333333333333016,   0.19999999999995520674,  -0.14285714284666542061,
                            0.11111111015256292406,   -0.090909045781210852,   0.076921831907606508702,
                            -0.066645114464602189808, 0.058581489047951238442, -0.050854496960392585335,
                            0.039231657085083686644,  -0.019176885636589051899};
  constexpr double pi = 3.141592653589793;
  constexpr double rest_of_pi = 1.2246467991473532e-16;
  const Two zero{0, 0};
  const Two one{1, 1};
  for (int i = 0; i < 6; i += 2) {
    const Two right{x[i], x[i + 1]};
    const Two size_x{std::abs(x[i]), std::abs(x[i + 1])};
    const Two size_y{std::abs(y[i]), std::abs(y[i + 1])};
    const auto is_steep = size_x < size_y;
    const Two low = is_steep ? size_x : size_y;
    const Two high = is_steep ? size_y : size_x;
    const auto is_diagonal = low > 0.41421356237309503 * high;
    const Two over = is_diagonal ? low - high : low;
    const Two under = is_diagonal ? low + high : high;
    const Two t = over / (under == zero ? one : under);
    const Two z = t * t;
    const Two z2 = z * z;
    const Two z4 = z2 * z2;
    const Two first = (c[0] + c[1] * z) + (c[2] + c[3] * z) * z2;
    const Two second = (c[4] + c[5] * z) + (c[6] + c[7] * z) * z2;
    const Two third = (c[8] + c[9] * z) + c[10] * z2;
    const Two rest = t * z * (first + (second + third * z4) * z4);
    // The angle is eighths pi/4 + sign (t + rest).
    const Two of_octant = is_diagonal ? one : zero;
    const Two of_quarter = is_steep ? 2 - of_octant : of_octant;
    const auto is_left = right < zero;
    const Two eighths = is_left ? 4 - of_quarter : of_quarter;
    const Two turn = is_steep ? -one : one;
    const Two sign = is_left ? -turn : turn;
    const Two found = eighths * (pi / 4) + (sign * t + (sign * rest + eighths * (rest_of_pi / 4)));
    angle[i] = std::copysign(found[0], y[i]);
    angle[i + 1] = std::copysign(found[1], y[i + 1]);
  }
}

/// Maps an angle between -4 pi and 4 pi to [0, 2 pi).
template <class R>
R in_one_turn(R angle) {
  const R turn = full_turn<R>();
  const R zero(0);
  angle += angle < zero ? turn : zero;
  angle += angle < zero ? turn : zero;
  angle -= angle < turn ? zero : turn;
  return angle < turn ? angle : R(0);  // a tiny negative angle may have become a whole turn
}

}  // namespace detail

/// Returns the elements of the orbit of a body at r with velocity v, for mu = G m > 0. The motion along a line through
/// the centre is a conic with e = 1 and pericentre distance 0, whose angles are 0.
template <class R>
OrbitalElements<R> elements_of(const Vector<R, 3>& r, const Vector<R, 3>& v, const R& mu) {
  OrbitalElements<R> out;
  const R nan = std::numeric_limits<R>::quiet_NaN();
  const R zero(0);
  const R one(1);
  const R distance = sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
  const R inverse_distance = one / distance;
  const R eta = r[0] * v[0] + r[1] * v[1] + r[2] * v[2];
  const R beta = R(2) * mu * inverse_distance - (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);

  // The plane.
  // Far from the centre r and v are nearly parallel, and the products cancel.
  using Careful = typename CarefulNumber<R>::type;
  const auto area = [&](std::size_t i, std::size_t k) {
    return static_cast<R>(Careful(r[i]) * Careful(v[k]) - Careful(r[k]) * Careful(v[i]));
  };
  const R hx = area(1, 2);
  const R hy = area(2, 0);
  const R hz = area(0, 1);
  const R square_in_plane = hx * hx + hy * hy;
  const R in_plane = sqrt(square_in_plane);
  const R square_of_h = square_in_plane + hz * hz;
  const R h = sqrt(square_of_h);
  const bool is_tilted = zero < square_in_plane;
  const R node_x = is_tilted ? -hy : one;
  const R node_y = is_tilted ? hx : zero;
  // The components along and across the direction of the node.
  const R along = (r[0] * node_x + r[1] * node_y) * h;
  const R across = (r[1] * node_x - r[0] * node_y) * hz + r[2] * square_in_plane;

  // The conic: e cos and e sin of the true anomaly.
  const R inverse_mu = one / mu;
  const R latus = square_of_h * inverse_mu;
  const R cosine = latus * inverse_distance - one;
  const R sine = h * eta * inverse_distance * inverse_mu;
  const R by_vector = sqrt(cosine * cosine + sine * sine);
  const R sum = one + by_vector;
  const R q = latus / sum;
  const R deficit = beta * q * inverse_mu;  // 1 - e
  out.e = abs(deficit) < R(0.5) ? one - deficit : by_vector;
  const R inverse_beta = one / beta;
  out.a = mu * inverse_beta;
  out.pericentre_distance = q;
  // The direction of half of the true anomaly, computed from 1 + cos or 1 - cos, so that nothing cancels.
  const bool is_near = !(cosine < zero);
  const R half_x = is_near ? by_vector + cosine : abs(sine);
  const R half_y = is_near ? sine : (sine < zero ? cosine - by_vector : by_vector - cosine);
  // The eccentric anomaly E. Near the circle it follows from the true anomaly: both are rounding there, but their
  // difference is not. Near the parabola it is computed directly, because E is small and the true anomaly is not.
  const R root = sqrt(abs(beta));
  const R e_sine = eta * root * inverse_mu;
  const bool is_round = by_vector < R(0.5);
  const R eccentric_y = is_round ? h * root * inverse_mu * half_y : e_sine;
  const R eccentric_x = is_round ? sum * half_x : one - distance * beta * inverse_mu;

  const R y[6] = {in_plane, node_y, across, half_y, eccentric_y, zero};
  const R x[6] = {hz, node_x, along, half_x, eccentric_x, one};
  R angle[6];
  detail::arc_tangents(y, x, angle);
  const R argument = angle[2];
  const bool is_circle = by_vector == zero;
  const R anomaly = is_circle ? argument : R(2) * angle[3];
  const R pericentre = argument - anomaly;
  out.inclination = angle[0];
  out.node = detail::in_one_turn(angle[1]);
  out.pericentre = detail::in_one_turn(pericentre);
  out.longitude_of_pericentre = detail::in_one_turn(angle[1] + pericentre);
  out.true_anomaly = detail::in_one_turn(anomaly);

  out.mean_longitude = nan;
  out.period = nan;
  const R inverse_rate = mu * inverse_beta * inverse_beta * root;  // 1/mean motion
  if (zero < beta) {
    const R eccentric = is_circle ? argument : is_round ? R(2) * angle[4] : angle[4];
    const bool cancels = !is_round && abs(eccentric) < one;
    const R mean = cancels ? deficit * eccentric + out.e * angle_minus_sine(eccentric) : eccentric - e_sine;
    out.mean_anomaly = detail::in_one_turn(mean);
    out.mean_longitude = detail::in_one_turn(angle[1] + pericentre + mean);
    out.period = detail::full_turn<R>() * inverse_rate;
    out.time_since_pericentre = mean * inverse_rate;
  } else if (beta < zero) {
    const R eccentric = inverse_sinh(e_sine / out.e);
    const bool cancels = abs(eccentric) < one;
    out.mean_anomaly = cancels ? out.e * sinh_minus_angle(eccentric) - deficit * eccentric : e_sine - eccentric;
    out.time_since_pericentre = out.mean_anomaly * inverse_rate;
  } else {
    const R s = eta * inverse_mu;
    out.a = std::numeric_limits<R>::infinity();
    out.mean_anomaly = nan;
    out.time_since_pericentre = q * s + mu * (s * s * s) / R(6);
  }
  return out;
}

}  // namespace hamflow
