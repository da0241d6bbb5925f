// expect: nothing
// The same ways of use, rightly: if this did not compile, the others would prove nothing.
#include "hamflow/hamflow.hpp"

void use() {
  (void)hamflow::simulate(hamflow::HenonHeiles<double>(), hamflow::Cg{}, {0.1, 0.1}, {0.1, 0.1}, 0.1);
  const auto h =
      hamflow::natural<1>([](const auto& p) { return p[0] * p[0] / 2; }, [](const auto& q) { return q[0] * q[0] / 2; });
  (void)hamflow::simulate(h, hamflow::Composition<hamflow::compositions::verlet>{}, {0.1}, {0.1}, 0.1,
                          hamflow::Lattice{});
  (void)hamflow::simulate(h, hamflow::Cg{}, {0.1}, {0.1}, 0.1);
}
