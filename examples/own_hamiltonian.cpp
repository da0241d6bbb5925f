// A Hamiltonian of your own: T and V as generic lambdas; the forces come from dual numbers.
#include <cstdio>

#include "hamflow/hamflow.hpp"

int main() {
  // A particle in the double well V = (x^2 - 1)^2, with an anisotropic second direction.
  const auto well = hamflow::natural<2>(
      [](const auto& p) { return (p[0] * p[0] + p[1] * p[1]) / 2; },
      [](const auto& q) { return (q[0] * q[0] - 1) * (q[0] * q[0] - 1) + 3 * q[1] * q[1] * (1 + q[0] * q[0] / 4); });
  const hamflow::Vector<double, 2> q{0.1, 0.3};
  const hamflow::Vector<double, 2> p{0.0, 0.2};

  auto symplectic = hamflow::simulate(well, hamflow::Composition<hamflow::compositions::stv4>{}, q, p, 0.05);
  auto conserving = hamflow::simulate(well, hamflow::Cg{}, q, p, 0.05);
  if (symplectic.advance(100000) != hamflow::Outcome::done) return 1;
  if (conserving.advance(100000) != hamflow::Outcome::done) return 1;
  std::printf("largest energy error in 10^5 steps: stv4 %.1e, cg %.1e\n", symplectic.energy().max_error,
              conserving.energy().max_error);
}
