// Where a flight first meets a wall, on the partial steps Psi_t of the method itself, and what becomes of the momentum
// there.
#pragma once

#include <optional>

#include "hamflow/run/any_problem.hpp"
#include "hamflow/run/steps_in_parts.hpp"
#include "hamflow/run/walls.hpp"

namespace hamflow {

template <class R>
class WallEvents {
 public:
  using Parts = StepsInParts<R>;
  using V = Vector<R, dynamic>;

  WallEvents(Parts& parts, const Functions<R>& functions, const std::vector<WallSide<R>>& sides)
      : parts_(parts), functions_(functions), sides_(sides) {}

  /// A wall, and the part of the flight behind which it is met.
  struct Hit {
    std::size_t side = 0;
    R part{};
  };
  enum class Found { none, hit, stuck, failed };
  /// Of the flight of this length from the present state, which is marked, Place::flight. The state is undefined
  /// afterwards.
  /// stuck: the motion stays on a wall, however often it is thrown back; failed: outcome() says how.
  Found first(const R& length, Hit& hit);
  Outcome outcome() const { return outcome_; }
  /// To the state behind this part of the flight.
  Outcome go_to(const R& part);

  /// Turns the normal velocity at a wall round. @return false where no other momentum has the same energy
  bool reflect(std::size_t coordinate);

 private:
  /// A point of a flight.
  struct Point {
    R part{};
    V q;
    V rate;  // dq/dpart, as H has it
  };
  Point here(const R& part) const;
  bool fly(const R& part, Point& point);
  R beyond(std::size_t k, const Point& at) const { return sides_[k].beyond(at.q[sides_[k].coordinate]); }
  R rate(std::size_t k, const Point& at) const {
    const R& x = at.rate[sides_[k].coordinate];
    return sides_[k].side > 0 ? x : R(-x);
  }
  R rounding(std::size_t k) const;
  /// Between a point inside and one beyond a wall: the last one inside, to rounding.
  bool locate(std::size_t k, Point inside, Point outside, R& part);
  /// Between points of rates of opposite signs: where it is furthest out, or nearest a point that is beyond (for
  /// outward = true), or inside.
  bool turn(std::size_t k, const Point& a, const Point& b, bool outward, Point& found);
  V velocity(const V& q, const V& p) const;

  Parts& parts_;
  const Functions<R>& functions_;
  const std::vector<WallSide<R>>& sides_;
  R length_{};
  V start_;  // q
  Outcome outcome_ = Outcome::done;
  R flown_{};          // the part behind which the state is, or
  bool seen_ = false;  // the one that was seen last
};

}  // namespace hamflow
