// expect: cg with p eliminated needs a QuadraticKinetic problem
#include "hamflow/hamflow.hpp"

void misuse() {
  const auto h = hamflow::separable<1>([](const auto& p) { return p[0] * p[0] * p[0] / 3; },
                                       [](const auto& q) { return q[0] * q[0] / 2; });
  (void)hamflow::simulate(h, hamflow::Cg{}, {0.1}, {0.1}, 0.1);
}
