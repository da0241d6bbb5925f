// Functions that formulas need for every number type, in addition to the operations (detail/core/operation.hpp).
#pragma once

#include "hamflow/core/dual.hpp"
#include "hamflow/detail/core/tape.hpp"
#include "hamflow/detail/formula/graph.hpp"

namespace hamflow::formula {

/// Converts a constant to a number of type S, through any nesting of dual numbers.
template <class S, class R>
S lifted(const R& x) {
  if constexpr (std::is_same_v<S, R>) {
    return x;
  } else if constexpr (IsDual<S>::value) {
    return S(lifted<decltype(S::value)>(x));
  } else {
    return static_cast<S>(x);
  }
}

/// The largest whole exponent for which a power is computed by products.
inline constexpr int largest_whole_power = 64;

}  // namespace hamflow::formula
