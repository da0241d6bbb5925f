// The linear double pendulum in relative angles.   [Gross1999, ch. 3]
#pragma once

#include "hamflow/detail/problems/double_pendulum.hpp"

namespace hamflow {

template <class R = double>
using DoublePendulumLinearRelative = DoublePendulumLinear<R, Angles::relative>;

}  // namespace hamflow
