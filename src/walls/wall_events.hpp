// The flight of a simulation to the wall that it meets first, and what becomes of the momentum there.
#pragma once

#include "hamflow/detail/run/any_problem.hpp"
#include "hamflow/detail/run/steps_in_parts.hpp"
#include "wall_search.hpp"

namespace hamflow {

template <class R>
class WallEvents {
 public:
  using Parts = StepsInParts<R>;
  using V = Vector<R, dynamic>;

  using Hit = typename WallSearch<R>::Hit;
  using Found = typename WallSearch<R>::Found;

  WallEvents(Parts& parts, const Functions<R>& functions, const std::vector<WallSide<R>>& sides)
      : parts_(parts), functions_(functions), search_(sides) {}

  /// Of the flight of this length from the present state, which is marked, Place::flight. The state is undefined
  /// afterwards. failed: outcome() says how.
  /// @param in_pieces see WallSearch
  Found first(const R& length, Hit& hit, bool in_pieces);
  Outcome outcome() const { return outcome_; }
  /// To the state behind this part of the flight.
  Outcome go_to(const R& part);

  /// Turns the normal velocity at a wall round. @return false where no other momentum has the same energy
  bool reflect(std::size_t coordinate);

 private:
  bool fly(const R& part, const R*& q, const R*& v);
  V velocity(const V& q, const V& p) const;

  Parts& parts_;
  const Functions<R>& functions_;
  WallSearch<R> search_;
  R length_{};
  V q_;  // behind the last part that was taken
  V v_;
  Outcome outcome_ = Outcome::done;
  R flown_{};          // the part behind which the state is, or
  bool seen_ = false;  // the one that was seen last
};

}  // namespace hamflow
