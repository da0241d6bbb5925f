// expect: a splitting method needs a Separable problem
#include "hamflow/hamflow.hpp"

void misuse() {
  const auto h =
      hamflow::hamiltonian<1>([](const auto& q, const auto& p) { return p[0] * p[0] * (1 + q[0] * q[0]) / 2; });
  (void)hamflow::simulate(h, hamflow::Composition<hamflow::compositions::verlet>{}, {0.1}, {0.1}, 0.1);
}
