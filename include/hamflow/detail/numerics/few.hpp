// A small vector and a small matrix, stored in place, with a size chosen at run time. Newton's iteration of recorded
// equations uses them, so that one compiled iteration serves systems of several sizes at the speed of fixed sizes.
#pragma once

#include "hamflow/core/error.hpp"
#include "hamflow/detail/numerics/dense.hpp"

namespace hamflow {

/// A vector of at most `most` numbers, with value semantics.
struct SmallVector {
  static constexpr std::size_t most = 6;
  using value_type = double;

  double entry[most]{};
  std::size_t count = 0;

  double& operator[](std::size_t i) { return entry[i]; }
  const double& operator[](std::size_t i) const { return entry[i]; }
  std::size_t size() const { return count; }
  const double* begin() const { return entry; }
  const double* end() const { return entry + count; }
  template <class Archive>
  void archive(Archive& ar) {
    ar(entry, count);
    if constexpr (Archive::reading) {
      if (count > most) throw Error("the saved bytes hold a vector of another size");
    }
  }
};

/// A small square matrix.
struct SmallRows {
  double entry[SmallVector::most][SmallVector::most];
  std::size_t count = 0;

  double* operator[](std::size_t row) { return entry[row]; }
  const double* operator[](std::size_t row) const { return entry[row]; }
  std::size_t size() const { return count; }
};

/// x with m x = b, with the bits of systems of that size.
SmallVector solve(const SmallRows& m, const SmallVector& b);
/// The largest absolute entry.
inline double max_norm(const SmallVector& x) {
  double largest = 0;
  for (const double v : x) largest = larger(largest, std::abs(v));
  return largest;
}
double determinant(const SmallRows& m);
double condition_number(const SmallRows& m);

}  // namespace hamflow
