// Finds the first wall that a simulation hits within a length of time, and changes the momentum there.
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

  /// The first wall on the path of this length from the present state, which is saved at Place::path. The state is
  /// undefined afterwards. If the result is `failed`, outcome() has the reason.
  /// @param in_pieces see WallSearch
  Found first(const R& length, Hit& hit, bool in_pieces);
  Outcome outcome() const { return outcome_; }
  /// Moves to the state after this part of the path.
  Outcome go_to(const R& part);

  /// Reverses the normal velocity at a wall. @return false if no other momentum has the same energy
  bool reflect(std::size_t coordinate);

 private:
  bool follow_path(const R& part, const R*& q, const R*& v);
  V velocity(const V& q, const V& p) const;

  Parts& parts_;
  const Functions<R>& functions_;
  WallSearch<R> search_;
  R length_{};
  V q_;  // after the last part that was taken
  V v_;
  Outcome outcome_ = Outcome::done;
  R reached_{};        // the part after which the state is, or,
  bool seen_ = false;  // if seen_, the part evaluated last
};

}  // namespace hamflow
