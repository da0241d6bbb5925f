// Options and claims of the methods with adaptive sub-steps. docs/design/adaptive.md explains how they
// choose these.
#pragma once

#include <cmath>
#include <string>

#include "hamflow/core/method_info.hpp"

namespace hamflow {

struct AdaptiveOptions {
  long double tolerance = 1e-12;  // beyond the range of a double for more than 300 digits; on the error of a sub-step,
                                  // relative to the size of q and of p, each by itself
  int order = 0;                  // the order of taylor; 0: the cheapest for the tolerance
  bool fixed = false;             // one sub-step per step, without error control; used to measure orders
  int max_substeps = 100000;
};

/// The claims of dop853. The step control is even in h and does not depend on the sign of p, so that the first step is
/// weakly reversible; later steps depend on the proposal of earlier ones.
inline MethodInfo describe_dop853(const AdaptiveOptions& options) {
  return {.name = "dop853",
          .summary = options.fixed ? "explicit Runge-Kutta, 12 stages, order 8"
                                   : "explicit Runge-Kutta, 12 stages, order 8, with adaptive sub-steps",
          .reference = "HNW1993, II.5, II.10",
          .order = 8,
          .weakly_reversible = true,
          .forces_per_step = options.fixed ? 12 : 0,
          .own_substeps = !options.fixed};
}

/// The order of taylor: that of the options, or the cheapest for the tolerance.   [JorbaZou2005, (3.4)]
inline int taylor_order(const AdaptiveOptions& options) {
  return options.order > 0 ? options.order : static_cast<int>(std::ceil(1 - std::log(options.tolerance) / 2));
}

/// The claims of taylor of a given order.
inline MethodInfo describe_taylor(const AdaptiveOptions& options, int order) {
  return {.name = "taylor",
          .summary = "Taylor series of order " + std::to_string(order) + " by automatic differentiation" +
                     (options.fixed ? "" : ", with adaptive sub-steps"),
          .reference = "JorbaZou2005; GriewankWalther2008, ch. 13",
          .order = order,
          .weakly_reversible = true,
          .own_substeps = !options.fixed};
}

}  // namespace hamflow
