// Compensated summation: each stored number is an unevaluated sum high + low, so that adding small increments loses
// nothing to the rounding of the state. [HLW2006, Sect. VIII.5; the exact sum of two numbers: Knuth, TAOCP 2, 4.2.2]
#pragma once

#include <string_view>

namespace hamflow {

template <class R>
struct Compensated {
  using Real = R;
  struct Stored {
    R high{};
    R low{};
    friend constexpr bool operator==(const Stored&, const Stored&) = default;
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
    static constexpr void add(Stored& s, const Real& r) {
      const R increment = r + s.low;
      const R sum = s.high + increment;
      const R part = sum - s.high;
      s.low = (s.high - (sum - part)) + (increment - part);
      s.high = sum;
    }
    static constexpr Stored negated(const Stored& s) { return {-s.high, -s.low}; }
  };
  [[no_unique_address]] Axis position;
  [[no_unique_address]] Axis momentum;

  static constexpr bool lost() { return false; }
};

}  // namespace hamflow
