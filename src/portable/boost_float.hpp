// The numbers of Boost.Multiprecision behind SoftFloat.
#pragma once

#include <boost/math/constants/constants.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cstdint>
#include <cstring>

#include "hamflow/detail/arithmetic/soft_float.hpp"

namespace hamflow {

template <int binary, int largest_exponent>
using BoostFloat = boost::multiprecision::number<
    boost::multiprecision::cpp_bin_float<static_cast<unsigned>(binary), boost::multiprecision::digit_base_2, void,
                                         std::int32_t, 1 - largest_exponent, largest_exponent>,
    boost::multiprecision::et_off>;

// Numbers of a fixed size hold no pointer: their bytes are the number.
template <int binary, int largest_exponent>
template <class Boost>
SoftFloat<binary, largest_exponent> SoftFloat<binary, largest_exponent>::holding(const Boost& x) {
  static_assert(sizeof x <= sizeof bytes_);
  SoftFloat result{Nothing()};
  std::memcpy(result.bytes_, static_cast<const void*>(&x), sizeof x);
  return result;
}
template <int binary, int largest_exponent>
template <class Boost>
Boost SoftFloat<binary, largest_exponent>::held() const {
  Boost x;
  std::memcpy(static_cast<void*>(&x), bytes_, sizeof x);
  return x;
}

}  // namespace hamflow
