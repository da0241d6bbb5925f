// Checks whether H(q, -p) = H(q, p), at states in general position near the states of a motion.
#include <algorithm>
#include <cmath>

#include "hamflow/core/counter_random.hpp"
#include "hamflow/verify/certificate.hpp"
#include "rounding.hpp"

namespace hamflow {

namespace {

/// Moves every coordinate by up to `part` times its size along the motion, each by a different amount, so that terms do
/// not cancel by chance. For example x p_y - y p_x is 0 along a motion without angular momentum. A coordinate that is 0
/// along the motion is moved by the size of the largest one.
std::vector<double> beside(const std::vector<double>& x, const std::vector<double>& sizes, double part,
                           std::uint64_t draw) {
  const double largest = sizes.empty() ? 0 : *std::max_element(sizes.begin(), sizes.end());
  std::vector<double> out = x;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double own = i < sizes.size() && sizes[i] > 0 ? sizes[i] : largest;
    out[i] += part * counter_uniform(draw, i) * (own > 0 ? own : 1);
  }
  return out;
}

std::vector<double> negated(std::vector<double> p) {
  for (double& x : p) x = -x;
  return p;
}

}  // namespace

/// Tests the velocities v = dH/dp, because V and constants do not contribute to them. H is even in p if and only if v
/// is odd. If the expression of H is even, v is odd bit for bit.
MomentumParity parity_in_momenta(const ProblemEntry& problem, const Texts& parameters, const StateSizes& sizes,
                                 std::span<const Frame* const> states) {
  constexpr double parts[] = {0x1p-4, 0x1p-16, 0x1p-32};  // near a singularity H is finite only close to the motion
  constexpr std::uint64_t draws = 4;
  constexpr std::size_t large = 1000;  // with so many coordinates one state is enough
  const Texts all = complete(problem.info, parameters);
  MomentumParity found;
  const auto finite = [&](const std::vector<double>& q, const std::vector<double>& p) {
    return problem.regular(all, q, p);
  };
  const auto look = [&](const std::vector<double>& q, const std::vector<double>& p) {
    const std::vector<double> back = negated(p);
    if (!finite(q, back)) {
      found.is_defined = false;
      return;
    }
    const std::vector<double> there = problem.gradient(all, q, p).by_p;
    const std::vector<double> here = problem.gradient(all, q, back).by_p;
    double largest = 0;
    for (std::size_t i = 0; i < there.size(); ++i) {
      if (there[i] != -here[i]) found.to_the_last_bit = false;
      largest = std::max(largest, std::abs(there[i]));
    }
    for (std::size_t i = 0; i < there.size(); ++i) {
      const double terms = std::max(std::abs(there[i]) + std::abs(here[i]), epsilon * largest);
      if (std::abs(there[i] + here[i]) > 64 * epsilon * terms) found.is_even = false;
    }
  };
  for (const Frame* state : states) {
    if (finite(state->q, state->p)) look(state->q, state->p);
    for (std::uint64_t k = 0; k < (state->q.size() > large ? 1 : draws); ++k) {
      for (const double part : parts) {
        const std::vector<double> q = beside(state->q, sizes.q, part, 2 * k + 1);
        const std::vector<double> p = beside(state->p, sizes.p, part, 2 * k + 2);
        if (!finite(q, p)) continue;
        look(q, p);
        break;
      }
    }
    if (!found.is_even || !found.is_defined) break;
  }
  if (!found.is_even || !found.is_defined) found.to_the_last_bit = false;
  return found;
}

std::string why_not_reversed(const MomentumParity& parity) {
  if (!parity.is_defined)
    return "H is not defined at (q, -p), so the motion cannot be reversed by negating the momenta";
  if (parity.is_even) return {};
  return "H(q, -p) differs from H(q, p), so negating the momenta does not reverse the motion itself";
}

}  // namespace hamflow
