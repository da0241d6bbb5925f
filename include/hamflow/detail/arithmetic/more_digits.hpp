// The laboratory (web/engine) is built without arithmetics that have more digits than double, so that it is small.
#pragma once

namespace hamflow {

#ifdef HAMFLOW_DOUBLE_ONLY
inline constexpr bool has_more_digits = false;
#else
inline constexpr bool has_more_digits = true;
#endif

}  // namespace hamflow
