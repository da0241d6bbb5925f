// expect: the order of this table holds only for a QuadraticKinetic problem
#include "hamflow/hamflow.hpp"

void misuse() {
  const hamflow::Sextic<double> h;
  (void)hamflow::simulate(h, hamflow::SplittingBy<hamflow::splittings::srkn6b>{}, {0.6}, {0.9}, 0.1);
}
