// The linear double pendulum in absolute angles.   [Gross1999, ch. 3]
#pragma once

#include "hamflow/detail/problems/double_pendulum.hpp"

namespace hamflow {

template <class R = double>
using DoublePendulumLinearAbsolute = DoublePendulumLinear<R, Angles::absolute>;

}  // namespace hamflow
