// Recordings in every number type of the catalogue.
#include "erased.hpp"

namespace hamflow {

#define HAMFLOW_TRACED(R)   \
  template struct Trace<R>; \
  template class Recorder<R>;
HAMFLOW_FOR_EACH_TRACED(HAMFLOW_TRACED)
#undef HAMFLOW_TRACED

}  // namespace hamflow
