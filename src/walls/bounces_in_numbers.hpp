// A fast path for a step with bounces, on plain numbers (src/engine/parts_in_numbers.hpp), for walls at which a bounce
// only changes the sign of one momentum. WallEvents handles all other cases.
#pragma once

#include "engine/parts_in_numbers.hpp"
#include "hamflow/detail/run/any_problem.hpp"
#include "wall_search.hpp"

namespace hamflow {

class BouncesInNumbers {
 public:
  /// @param functions with the velocity of H = T + V
  BouncesInNumbers(const Functions<double>& functions, const std::vector<WallSide<double>>& sides)
      : functions_(functions), sides_(sides), search_(sides) {}

  /// Advances the present numbers by Psi_length. Each bounce ends one part of it.
  /// @param bounced (side, length taken so far); returns false if there are too many bounces
  /// @return false if WallEvents must take over: an evaluation failed, or the motion stays on a wall
  template <class Bounced>
  bool take(PartsInNumbers& numbers, double length, const Bounced& bounced) {
    using Found = WallSearch<double>::Found;
    const std::size_t n = numbers.part().size;
    if (q_.size() != n) q_ = p_ = v_ = Vector<double, dynamic>(n);
    double left = length;
    while (true) {
      for (std::size_t i = 0; i < n; ++i) {
        q_[i] = numbers.position(i);
        p_[i] = numbers.momentum(i);
      }
      functions_.velocity(p_, v_);
      double reached = 0;
      const auto look = [&](double part, const double*& q, const double*& v) {
        reached = part;
        q = numbers.look(part * left);
        v = q + n;
        return q != nullptr;
      };
      WallSearch<double>::Hit hit;
      const Found found = search_.first(left, q_.begin(), v_.begin(), look, hit);
      if (found != Found::hit && found != Found::none) return false;
      const double part = found == Found::hit ? hit.part : 1;
      if (part != 0) {
        const double* q = nullptr;
        const double* v = nullptr;
        if (reached != part && !look(part, q, v)) return false;
        numbers.go();
      }
      if (found == Found::none) return true;
      left -= hit.part * left;
      numbers.negate_momentum(sides_[hit.side].coordinate);
      if (!bounced(hit.side, length - left)) return false;
      if (left == 0) return true;
    }
  }

 private:
  const Functions<double>& functions_;
  const std::vector<WallSide<double>>& sides_;
  WallSearch<double> search_;
  Vector<double, dynamic> q_, p_, v_;  // at the start of a part
};

}  // namespace hamflow
