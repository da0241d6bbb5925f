// Plain arithmetic: stored and computed in the same type.
#pragma once

#include <string_view>

namespace hamflow {

/// Positions and momenta are numbers of type R, and so is everything computed from them.
template <class R>
struct Plain {
  using Real = R;
  using Stored = R;
  static constexpr std::string_view name = "double";
  static constexpr bool exact_undo = false;  // (s + r) - r rounds twice

  struct Axis {
    static constexpr Stored store(const Real& x) { return x; }
    static constexpr const Real& read(const Stored& s) { return s; }
    static constexpr void add(Stored& s, const Real& r) { s += r; }
    static constexpr Stored negated(const Stored& s) { return -s; }
  };
  [[no_unique_address]] Axis position;
  [[no_unique_address]] Axis momentum;

  static constexpr bool lost() { return false; }
};

}  // namespace hamflow
