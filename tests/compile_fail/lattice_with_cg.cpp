// expect: the lattice needs an explicit splitting method
#include "hamflow/hamflow.hpp"

void misuse() {
  (void)hamflow::simulate(hamflow::HenonHeiles<double>(), hamflow::Cg{}, {0.1, 0.1}, {0.1, 0.1}, 0.1,
                          hamflow::Lattice{});
}
