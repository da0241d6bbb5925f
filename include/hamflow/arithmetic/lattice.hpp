// Positions and momenta on integer lattices: every kick and every drift adds an integer that is a pure function of
// integers, hence is undone exactly by its mirror image. A palindromic splitting returns every bit.
// [spec: methods, section 7; Levesque and Verlet 1993]
#pragma once

#include <cmath>
#include <cstdint>
#include <string_view>

namespace hamflow {

/// s -> s * unit, s a 64-bit integer. Forces are computed in double from the rounded reading of s.
struct Lattice {
  using Real = double;
  using Stored = std::int64_t;
  static constexpr std::string_view name = "lattice";
  static constexpr bool exact_undo = true;
  static constexpr double default_unit = 0x1p-52;  // range +-2048 at a spacing of 2.2e-16

  struct Axis {
    double unit = default_unit;            // a power of two, so that scaling either way is exact
    double per_unit = 1.0 / default_unit;  // 1/unit
    bool lost = false;                     // set once a number left the range; never cleared by arithmetic

    /// @param power_of_two the lattice spacing, in the units of the coordinate
    void set_unit(double power_of_two) {
      unit = power_of_two;
      per_unit = 1.0 / power_of_two;
    }

    Stored store(Real x) {
      Stored s = 0;
      add(s, x);
      return s;
    }
    Real read(Stored s) const { return static_cast<Real>(s) * unit; }
    /// s <- s + round(r / unit). Rounding to nearest, ties to even, is odd: round(-x) = -round(x).
    void add(Stored& s, Real r) {
      const Real scaled = r * per_unit;
      // 2^62 leaves room to round and add; the comparison is false for NaN too.
      if (!(std::fabs(scaled) < 0x1p62)) {
        lost = true;
        return;
      }
      Stored sum = 0;
      // The range is kept symmetric (no -2^63), so that negating a momentum always works.
      if (__builtin_add_overflow(s, static_cast<Stored>(std::llrint(scaled)), &sum) || sum == INT64_MIN) {
        lost = true;
        return;
      }
      s = sum;
    }
    static Stored negated(Stored s) { return -s; }
    template <class Archive>
    void archive(Archive& ar) {
      ar(unit, per_unit, lost);
    }
  };
  Axis position;
  Axis momentum;

  bool lost() const { return position.lost || momentum.lost; }
};

}  // namespace hamflow
