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
  // Of dynamic size, with velocity, force and second derivatives by hand.
  const hamflow::Fput<double> chain(2, 0.25, 0.0);
  static_assert(hamflow::QuadraticKinetic<hamflow::Fput<double>> && hamflow::Smooth<hamflow::Fput<double>>);
  static_assert(hamflow::Separable<hamflow::NBody<double>> && hamflow::TwiceDifferentiable<hamflow::NBody<double>>);
  (void)hamflow::simulate(chain, hamflow::Composition<hamflow::compositions::verlet>{}, {0.1, 0.2}, {0.1, 0.2}, 0.1);
  (void)hamflow::simulate(chain, hamflow::RungeKuttaBy<hamflow::tableaus::rk4>{}, {0.1, 0.2}, {0.1, 0.2}, 0.1);
  (void)hamflow::simulate(chain, hamflow::Cg{}, {0.1, 0.2}, {0.1, 0.2}, 0.1);
}
