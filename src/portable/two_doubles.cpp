// Elementary functions of double-double by way of 113 binary digits, seven more than it has.
#include "hamflow/arithmetic/double_double.hpp"

#define HAMFLOW_FUNCTIONS_OF_ONE(X) X(exp) X(log) X(sin) X(cos) X(tan) X(asin) X(acos) X(atan) X(sinh) X(cosh) X(tanh)
#define HAMFLOW_FUNCTIONS_OF_TWO(X) X(atan2) X(pow)

namespace {
using Traits = hamflow::ExtendedTraits<dd_real>;
}

#define HAMFLOW_BY_WIDER(name) \
  dd_real name(const dd_real& x) { return Traits::rounded(Traits::Wider::name(Traits::widened(x))); }
HAMFLOW_FUNCTIONS_OF_ONE(HAMFLOW_BY_WIDER)
#undef HAMFLOW_BY_WIDER
#define HAMFLOW_BY_WIDER(name)                                                           \
  dd_real name(const dd_real& x, const dd_real& y) {                                     \
    return Traits::rounded(Traits::Wider::name(Traits::widened(x), Traits::widened(y))); \
  }
HAMFLOW_FUNCTIONS_OF_TWO(HAMFLOW_BY_WIDER)
#undef HAMFLOW_BY_WIDER
