// Compensated summation: each stored number is an unevaluated sum high + low, so that adding small increments loses
// nothing to the rounding of the state. [HLW2006, Sect. VIII.5; the exact sum of two numbers: Knuth1997, 4.2.2]
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
    /// The same with r + low exact as well. What is lost there had a mean on some orbits (docs/design/cg.md).
    static constexpr void add_keeping(Stored& s, const Real& r) {
      const R increment = r + s.low;
      const R of_low = increment - r;
      const R lost = (r - (increment - of_low)) + (s.low - of_low);
      settle(s, begin_with(s, increment));
      s.low += lost;
    }
    /// What `begin` leaves to `settle`.
    struct Pending {
      R before{};
      R increment{};
    };
    /// The first half of add, which others wait for: high is the sum already, low not yet its error.
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
    /// The same as add, bit for bit, with low two operations sooner, for one who waits for it, and without a branch.
    /// The error of a sum is the smaller summand less what the sum has of it [Dekker1971, (4.14)]: computed for either
    /// order, then chosen. Where it is 0 add gives +0, and so must this: the added zeros turn -0 into +0.
    static void add_sooner(Stored& s, const Real& r) {
      if constexpr (std::is_floating_point_v<R>) {
        const R increment = r + s.low;
        const R sum = s.high + increment;
        const R if_smaller = (r + (s.low + R(0))) - (sum - s.high);
        const R if_larger = (s.high + R(0)) - (sum - increment);
        s.low = std::abs(increment) <= std::abs(s.high) ? if_smaller : if_larger;
        s.high = sum;
      } else {  // may be not exact there
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
