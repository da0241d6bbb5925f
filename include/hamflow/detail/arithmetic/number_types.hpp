// What stands behind the number types with more digits than double: a library or a type of the machine, or, in a
// portable build, software (two_doubles.hpp, soft_float.hpp). Only their names: without the libraries' headers.
#pragma once

#include <limits>

#ifdef HAMFLOW_PORTABLE
#include "hamflow/detail/arithmetic/soft_float.hpp"
#endif

struct dd_real;

namespace hamflow {

template <class T>
class Extended;

/// `Wide` has 64 binary digits: coefficients of steps in double are computed in it and rounded. That is the long double
/// of x86; other machines have other ones, with which coefficients would be rounded otherwise.
#ifdef HAMFLOW_PORTABLE
using Wide = Extended<SoftFloat<64, 16383>>;
using QuadNumber = SoftFloat<113, 16383>;
inline constexpr bool has_quad_and_mp = false;
template <>
inline Wide parse_decimal<Wide>(std::string_view text) {
  return Wide(ExtendedTraits<SoftFloat<64, 16383>>::read(text));
}
#else
using Wide = long double;
using QuadNumber = __float128;
inline constexpr bool has_quad_and_mp = true;
static_assert(std::numeric_limits<Wide>::digits == 64, "this machine needs -DHAMFLOW_PORTABLE=ON");
#endif

}  // namespace hamflow
