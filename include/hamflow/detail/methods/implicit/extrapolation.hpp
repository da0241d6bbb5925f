// The initial guess of a step, from the steps before it.
#pragma once

#include <cstddef>

namespace hamflow {

/// Extrapolates a smooth sequence from its last three members. Part of the state of a run.
template <class V>
class Extrapolation {
 public:
  bool empty() const { return remembered_ == 0; }
  void forget() { remembered_ = 0; }
  /// Whether all three members are known.
  bool is_full() const { return remembered_ == 3; }
  /// The k-th last member, k = 0, 1, 2.
  const V& last(std::size_t k) const { return last_[k]; }
  void remember(const V& x) {
    last_[2] = last_[1];
    last_[1] = last_[0];
    last_[0] = x;
    if (remembered_ < 3) ++remembered_;
  }
  /// @pre not empty
  [[gnu::always_inline]] V predicted() const {
    V x = last_[0];
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] = remembered_ == 1   ? last_[0][i]
             : remembered_ == 2 ? 2 * last_[0][i] - last_[1][i]
                                : 3 * (last_[0][i] - last_[1][i]) + last_[2][i];
    }
    return x;
  }
  template <class Archive>
  void archive(Archive& ar) {
    ar(last_, remembered_);
  }

 private:
  V last_[3]{};
  int remembered_ = 0;
};

}  // namespace hamflow
