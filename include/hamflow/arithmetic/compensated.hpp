// Compensated summation: each stored number is an unevaluated sum high + low, so that small increments are not lost to
// the rounding of the state. [HLW2006, Sect. VIII.5; the exact sum of two numbers: Knuth1997, 4.2.2]
#pragma once

#include <cmath>
#include <string_view>
#include <type_traits>

namespace hamflow {

template <class R>
struct Compensated {
  using Real = R;
  struct Stored {
    R high{};
    R low{};
    friend bool operator==(const Stored&, const Stored&) = default;
    template <class Archive>
    void archive(Archive& ar) {
      ar(high, low);
    }
  };
  static constexpr std::string_view name = "compensated";
  static constexpr bool exact_undo = false;  // low is itself rounded

  struct Axis {
    static constexpr Stored store(const Real& x) { return {x, R(0)}; }
    static constexpr const Real& read(const Stored& s) { return s.high; }
    /// s <- s + r: the error of high + (r + low) is found exactly (two-sum, no assumption on magnitudes) and kept.
    static constexpr void add(Stored& s, const Real& r) { settle(s, begin(s, r)); }
    /// As add(), but the sum r + low is exact, because its rounding error had a mean other than 0 on some orbits
    /// (docs/design/cg.md).
    static constexpr void add_with_exact_low(Stored& s, const Real& r) {
      const R increment = r + s.low;
      const R of_low = increment - r;
      const R lost = (r - (increment - of_low)) + (s.low - of_low);
      settle(s, begin_with(s, increment));
      s.low += lost;
    }
    /// Data that `begin` passes to `settle`.
    struct Pending {
      R before{};
      R increment{};
    };
    /// The first half of add, on which later operations depend: high is the sum, but low is not its error yet.
    static constexpr Pending begin(Stored& s, const Real& r) { return begin_with(s, r + s.low); }
    static constexpr Pending begin_with(Stored& s, const R& increment) {
      const Pending pending{s.high, increment};
      s.high = pending.before + pending.increment;
      return pending;
    }
    static constexpr void settle(Stored& s, const Pending& pending) {
      const R part = s.high - pending.before;
      s.low = (pending.before - (s.high - part)) + (pending.increment - part);
    }
    /// Gives the bits of add() without a branch, with low available two operations earlier. The error of a sum is the
    /// smaller summand minus its part in the sum [Dekker1971, (4.14)]; it is computed for both orders, then one is
    /// selected. If the error is 0, add() gives +0, so zeros are added here to turn -0 into +0.
    static void add_without_branch(Stored& s, const Real& r) {
      if constexpr (std::is_floating_point_v<R>) {
        const R increment = r + s.low;
        const R sum = s.high + increment;
        const R if_smaller = (r + (s.low + R(0))) - (sum - s.high);
        const R if_larger = (s.high + R(0)) - (sum - increment);
        s.low = std::abs(increment) <= std::abs(s.high) ? if_smaller : if_larger;
        s.high = sum;
      } else {  // for other types the formula may be inexact
        add(s, r);
      }
    }
    static constexpr Stored negated(const Stored& s) { return {-s.high, -s.low}; }
  };
  [[no_unique_address]] Axis position;
  [[no_unique_address]] Axis momentum;

  static constexpr bool lost() { return false; }
};

}  // namespace hamflow
