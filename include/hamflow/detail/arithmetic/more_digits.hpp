// The laboratory (web/engine) is built without what computes in more digits beside the steps of a run in double-double:
// closed forms, conversions of states, maps of steps. So it is smaller.
#pragma once

namespace hamflow {

#ifdef HAMFLOW_LABORATORY
inline constexpr bool has_more_digits = false;
#else
inline constexpr bool has_more_digits = true;
#endif

}  // namespace hamflow
