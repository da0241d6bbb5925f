// The nonlinear double pendulum in relative angles.   [Gross1999, ch. 3]
#pragma once

#include "hamflow/detail/problems/double_pendulum.hpp"

namespace hamflow {

template <class R = double>
using DoublePendulumNonlinearRelative = DoublePendulumNonlinear<R, Angles::relative>;

}  // namespace hamflow
