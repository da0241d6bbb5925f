#include "wall_events.hpp"

#include <limits>

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
bool WallEvents<R>::follow_path(const R& part, const R*& q, const R*& v) {
  reached_ = part;
  const R length = part * length_;
  q = parts_.see_part(length);
  seen_ = q != nullptr;
  if (seen_) {
    v = q + q_.size();
    return true;
  }
  parts_.restore_state(Parts::Place::path);
  outcome_ = parts_.take_part(length);
  if (outcome_ != Outcome::done) return false;
  q_ = parts_.present_positions();
  v_ = velocity(q_, parts_.present_momenta());
  q = q_.begin();
  v = v_.begin();
  return true;
}

template <class R>
Outcome WallEvents<R>::go_to(const R& part) {
  if (reached_ == part) {
    if (seen_) parts_.take_seen_part();
    return Outcome::done;
  }
  const R length = part * length_;
  if (part != R(0) && parts_.see_part(length) != nullptr) {
    parts_.take_seen_part();
    return Outcome::done;
  }
  parts_.restore_state(Parts::Place::path);
  return part == R(0) ? Outcome::done : parts_.take_part(length);
}

template <class R>
typename WallEvents<R>::Found WallEvents<R>::first(const R& length, Hit& hit, bool in_pieces) {
  length_ = length;
  reached_ = R(0);
  seen_ = false;
  const V q0 = parts_.present_positions();
  const V v0 = velocity(q0, parts_.present_momenta());
  q_ = q0;
  return search_.first(
      length, q0.begin(), v0.begin(), [&](const R& part, const R*& q, const R*& v) { return follow_path(part, q, v); },
      hit, in_pieces);
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
  // In most problems H is even in p_i.
  other[i] = -p[i];
  if (velocity(q, other)[i] == -v && keeps_energy()) {
    parts_.negate_momentum(i);
    return true;
  }
  // Otherwise H may be quadratic in it: (M^-1)_ii follows from a velocity that is linear in p_i.
  const R unit = p[i] == R(0) ? R(1) : R(abs(p[i]));
  other[i] = p[i] + unit;
  const R inverse_mass = (velocity(q, other)[i] - v) / unit;
  R change = R(-2) * v / inverse_mass;
  // Otherwise Newton's method finds the other root of H(q, p + lambda e_i) = H(q, p), from beyond it.
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
  // The old momentum is a root, too.
  if (!keeps_energy() || !(velocity(q, other)[i] * v <= R(0))) return false;
  parts_.push_momentum(i, change);
  return true;
}

template class WallEvents<double>;
template class WallEvents<DoubleDouble>;
template class WallEvents<Quad>;
template class WallEvents<Mp>;

}  // namespace hamflow
