// The largest Lyapunov exponent for a problem and a method that are known as types, for parameter maps of many orbits.
// State and tangent vector together are dual numbers, which the kernel of the step advances.
#pragma once

#include <cmath>

#include "hamflow/arithmetic/plain.hpp"
#include "hamflow/core/math.hpp"
#include "hamflow/core/phase_point.hpp"
#include "hamflow/detail/verify/lyapunov.hpp"

namespace hamflow {

/// Like largest_lyapunov(StepMap). Returns NaN if the orbit does not stay finite. For problems of fixed size the loop
/// allocates nothing. Several threads may call it.
template <class P, class Recipe>
double largest_lyapunov(const P& problem, const Recipe& recipe, const Vector<double, P::dimension>& q,
                        const Vector<double, P::dimension>& p, double h, std::int64_t steps,
                        const LyapunovOptions& options = {}) {
  static_assert(!Recipe::implicit, "hamflow: the tangent of an implicit step is that of a StepMap");
  using A = Plain<Dual<double, 1>>;
  constexpr std::size_t n = P::dimension;
  const TangentFrame first(q.size(), 1, options.seed);
  PhasePoint<A, n> z;
  auto as_dual = zeros<Dual<double, 1>, n>(q.size());
  auto as_dual_p = as_dual;
  for (std::size_t i = 0; i < q.size(); ++i) {
    as_dual[i] = q[i];
    as_dual[i].slope[0] = first.vectors()[0][i];
    as_dual_p[i] = p[i];
    as_dual_p[i].slope[0] = first.vectors()[0][q.size() + i];
  }
  z.store(as_dual, as_dual_p);
  auto method = recipe.template bind<P, A>(problem);
  double total = 0;
  double log = 0;
  std::int64_t block = 1;
  for (std::int64_t done = -options.transient; done < steps;) {
    const std::int64_t now = std::min(block, (done < 0 ? 0 : steps) - done);
    for (std::int64_t i = 0; i < now; ++i) {
      if (method.step(problem, h, z) != Outcome::done) return std::numeric_limits<double>::quiet_NaN();
    }
    double square = 0;
    for (std::size_t i = 0; i < q.size(); ++i) {
      square += z.q[i].slope[0] * z.q[i].slope[0] + z.p[i].slope[0] * z.p[i].slope[0];
    }
    const double length = std::sqrt(square);
    if (!(length > 0 && length <= std::numeric_limits<double>::max())) return std::numeric_limits<double>::quiet_NaN();
    for (std::size_t i = 0; i < q.size(); ++i) {
      z.q[i].slope[0] /= length;
      z.p[i].slope[0] /= length;
    }
    method.invalidate();  // the cached kick carries a derivative along the vector before it was normalised
    log = hamflow::log(length);
    if (done >= 0) total += log;
    block = steps_between(block, {&log, 1});
    done += now;
  }
  return total / (static_cast<double>(steps) * std::abs(h));
}

}  // namespace hamflow
