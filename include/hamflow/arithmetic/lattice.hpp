// Positions and momenta on integer lattices: every kick and every drift adds an integer that is a pure function of
// integers, so that the mirrored action undoes it exactly. A palindromic splitting can be reversed bit for bit.
// [LevesqueVerlet1993]
#pragma once

#include <cmath>
#include <cstdint>
#include <string_view>

namespace hamflow {

/// s -> s * unit, s a 64-bit integer of less than 2^62 in size: the sum and the difference of two such integers always
/// fit into 64 bits, so that leaving the range is detected before an overflow. Forces are computed in double, from the
/// rounded reading of s or from the exact difference of two.
struct Lattice {
  using Real = double;
  using Stored = std::int64_t;
  static constexpr std::string_view name = "lattice";
  static constexpr bool exact_undo = true;
  static constexpr double default_unit = 0x1p-52;  // range +-1024 at a spacing of 2.2e-16
  static constexpr Stored range = Stored{1} << 62;

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
    /// (a - b) unit. The integers are subtracted exactly and then rounded, so that a common shift by a lattice vector
    /// does not change a bit, and close neighbours far from the origin lose no digits.
    Real difference(Stored a, Stored b) const { return static_cast<Real>(a - b) * unit; }
    /// k = round(r / unit), to nearest, ties to even, which is odd: round(-x) = -round(x).
    /// @return false, with k unchanged, unless |r / unit| is below `limit` <= 2^62; false for NaN, too
    bool units(Real r, Real limit, Stored& k) const {
      const Real scaled = r * per_unit;
      if (!(std::fabs(scaled) < limit)) return false;
      k = static_cast<Stored>(std::llrint(scaled));
      return true;
    }
    /// s <- s + k, |k| < 2^62.
    void add_units(Stored& s, Stored k) {
      const Stored sum = s + k;
      // The range is symmetric, so that negating a momentum always works.
      if (sum <= -range || sum >= range) {
        lost = true;
      } else {
        s = sum;
      }
    }
    /// s <- s + round(r / unit).
    void add(Stored& s, Real r) {
      Stored k = 0;
      if (units(r, static_cast<Real>(range), k)) {
        add_units(s, k);
      } else {
        lost = true;
      }
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
