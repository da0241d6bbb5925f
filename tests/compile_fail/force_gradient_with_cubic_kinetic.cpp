// expect: a method with force gradient needs a QuadraticKinetic problem
#include "hamflow/hamflow.hpp"

void misuse() {
  const hamflow::Sextic<double> h;
  (void)hamflow::simulate(h, hamflow::ForceGradient{&hamflow::force_gradient::chin4a}, {0.6}, {0.9}, 0.1);
}
