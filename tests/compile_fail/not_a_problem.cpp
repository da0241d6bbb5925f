// expect: Problem
#include "hamflow/hamflow.hpp"

struct NoEnergy {
  using Real = double;
  static constexpr std::size_t dimension = 1;
};

void misuse() {
  (void)hamflow::simulate(NoEnergy{}, hamflow::Composition<hamflow::compositions::verlet>{}, {0.1}, {0.1}, 0.1);
}
