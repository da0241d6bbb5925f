#include "wall_events.hpp"

#include <limits>
#include <utility>

#include "hamflow/arithmetic/double_double.hpp"
#include "hamflow/arithmetic/mp.hpp"
#include "hamflow/arithmetic/quad.hpp"

namespace hamflow {

template <class R>
typename WallEvents<R>::V WallEvents<R>::velocity(const V& q, const V& p) const {
  V v = zeros_like(p);
  if (functions_.has_parts()) {
    functions_.velocity(p, v);
  } else {
    V by_q = zeros_like(q);
    functions_.gradient(q, p, by_q, v);
  }
  return v;
}

template <class R>
typename WallEvents<R>::Point WallEvents<R>::here(const R& part) const {
  Point point{part, parts_.present_positions(), {}};
  point.rate = velocity(point.q, parts_.present_momenta());
  for (R& x : point.rate) x *= length_;
  return point;
}

template <class R>
bool WallEvents<R>::fly(const R& part, Point& point) {
  flown_ = part;
  const R length = part * length_;
  const R* const end = parts_.see_part(length);
  seen_ = end != nullptr;
  if (seen_) {
    const std::size_t n = start_.size();
    point.part = part;
    if (point.q.size() != n) point.q = point.rate = V(n);
    for (std::size_t i = 0; i < n; ++i) {
      point.q[i] = end[i];
      point.rate[i] = end[n + i] * length_;
    }
    return true;
  }
  parts_.back(Parts::Place::flight);
  outcome_ = parts_.take_part(length);
  if (outcome_ != Outcome::done) return false;
  point = here(part);
  return true;
}

template <class R>
Outcome WallEvents<R>::go_to(const R& part) {
  if (flown_ == part) {
    if (seen_) parts_.take_seen_part();
    return Outcome::done;
  }
  const R length = part * length_;
  if (part != R(0) && parts_.see_part(length) != nullptr) {
    parts_.take_seen_part();
    return Outcome::done;
  }
  parts_.back(Parts::Place::flight);
  return part == R(0) ? Outcome::done : parts_.take_part(length);
}

/// What is on a wall as far as numbers can tell.
template <class R>
R WallEvents<R>::rounding(std::size_t k) const {
  return 2 * std::numeric_limits<R>::epsilon() * larger(R(abs(sides_[k].at)), R(abs(start_[sides_[k].coordinate])));
}

template <class R>
typename WallEvents<R>::Found WallEvents<R>::first(const R& length, Hit& hit) {
  length_ = length;
  flown_ = R(0);
  seen_ = false;
  const Point start = here(R(0));
  start_ = start.q;
  for (std::size_t k = 0; k < sides_.size(); ++k) {
    if (beyond(k, start) >= -rounding(k) && rate(k, start) > R(0)) {
      hit = {k, R(0)};
      return Found::hit;
    }
  }
  Point end;
  if (!fly(R(1), end)) return Found::failed;
  Found found = Found::none;
  for (std::size_t k = 0; k < sides_.size(); ++k) {
    const bool leaves = rate(k, start) > R(0);
    const bool comes_in = rate(k, end) < R(0);
    const bool ends_beyond = beyond(k, end) > R(0);
    if (!ends_beyond) {
      if (!leaves || !comes_in) continue;
      const R ahead = beyond(k, start) + R(2) * rate(k, start);
      const R behind = beyond(k, end) - R(2) * rate(k, end);
      if (!(ahead > R(0) && behind > R(0))) continue;
    }
    Point from = start;
    Point to = end;
    if (ends_beyond) {
      if (beyond(k, start) >= -rounding(k)) {  // thrown back a moment ago, and here again
        if (comes_in) continue;                // rounding alone
        if (!turn(k, start, end, false, from)) return Found::failed;
        if (!(beyond(k, from) < R(0))) return Found::stuck;
      }
    } else {
      if (!turn(k, start, end, true, to)) return Found::failed;
      if (!(beyond(k, to) > R(0))) continue;
    }
    R part{};
    if (!locate(k, std::move(from), std::move(to), part)) return Found::failed;
    if (found == Found::none || part < hit.part) hit = {k, part};
    found = Found::hit;
  }
  return found;
}

template <class R>
bool WallEvents<R>::locate(std::size_t k, Point inside, Point outside, R& part) {
  constexpr int most = 4000;  // halvings of many digits
  const R close = rounding(k);
  const R epsilon = std::numeric_limits<R>::epsilon();
  R next = rate(k, inside) > R(0) ? R(inside.part - beyond(k, inside) / rate(k, inside)) : R(0);
  Point point;
  for (int i = 0; i < most && outside.part - inside.part > 2 * epsilon * outside.part; ++i) {
    if (!(inside.part < next && next < outside.part)) {
      next = inside.part + (outside.part - inside.part) / R(2);
      if (!(inside.part < next && next < outside.part)) break;
    }
    if (!fly(next, point)) return false;
    const R x = beyond(k, point);
    const R speed = rate(k, point);
    next = speed > R(0) ? R(point.part - (x > R(0) && x <= close ? 2 * close : x) / speed) : R(0);
    std::swap(x > R(0) ? outside : inside, point);
    if (x <= R(0) && x >= -close) break;
  }
  part = inside.part;
  return true;
}

template <class R>
bool WallEvents<R>::turn(std::size_t k, const Point& a, const Point& b, bool outward, Point& found) {
  Point left = a;
  Point right = b;
  const R enough = sqrt(std::numeric_limits<R>::epsilon()) / R(16);
  const bool rising = rate(k, right) > R(0);
  found = outward == (beyond(k, left) > beyond(k, right)) ? left : right;
  for (int i = 0; i < 400 && right.part - left.part > enough * right.part; ++i) {
    const R rise = rate(k, right) - rate(k, left);
    R next = left.part - rate(k, left) * (right.part - left.part) / rise;
    const R width = right.part - left.part;
    // A secant that hardly moves an end is followed by a halving.
    if (i % 3 == 2 || !(left.part + width / R(1024) < next && next < right.part - width / R(1024))) {
      next = left.part + width / R(2);
    }
    Point point;
    if (!fly(next, point)) return false;
    if (outward == (beyond(k, point) > beyond(k, found))) found = point;
    if (outward ? beyond(k, found) > R(0) : beyond(k, found) < R(0)) return true;
    ((rate(k, point) > R(0)) == rising ? right : left) = point;
  }
  return true;
}

template <class R>
bool WallEvents<R>::reflect(std::size_t i) {
  const V q = parts_.present_positions();
  const V p = parts_.present_momenta();
  const R v = velocity(q, p)[i];
  const R energy = functions_.energy(q, p);
  const R size = abs(energy) + abs(v * p[i]);
  const R epsilon = std::numeric_limits<R>::epsilon();
  V other = p;
  const auto keeps_energy = [&] { return abs(functions_.energy(q, other) - energy) <= 64 * epsilon * size; };
  // Mostly H is even in p_i.
  other[i] = -p[i];
  if (velocity(q, other)[i] == -v && keeps_energy()) {
    parts_.negate_momentum(i);
    return true;
  }
  // Else quadratic in it: (M^-1)_ii from a velocity that is linear in p_i.
  const R unit = p[i] == R(0) ? R(1) : R(abs(p[i]));
  other[i] = p[i] + unit;
  const R inverse_mass = (velocity(q, other)[i] - v) / unit;
  R change = R(-2) * v / inverse_mass;
  // Else the other root of H(q, p + lambda e_i) = H(q, p), by Newton from behind it.
  const auto gain = [&] {
    other[i] = p[i] + change;
    return functions_.energy(q, other) - energy;
  };
  R rise = gain();
  for (int n = 0; n < 200 && rise < R(0) && !keeps_energy(); ++n) {
    change *= R(2);
    rise = gain();
  }
  for (int n = 0; n < 100 && !keeps_energy(); ++n) {
    const R correction = rise / velocity(q, other)[i];
    change -= correction;
    rise = gain();
    if (!(abs(correction) > 4 * epsilon * abs(change))) break;
  }
  // The momentum that there was is a root, too.
  if (!keeps_energy() || !(velocity(q, other)[i] * v <= R(0))) return false;
  parts_.push_momentum(i, change);
  return true;
}

template class WallEvents<double>;
template class WallEvents<DoubleDouble>;
template class WallEvents<Quad>;
template class WallEvents<Mp>;

}  // namespace hamflow
