// expect: hamflow: T and V are called with dual numbers too
#include "hamflow/hamflow.hpp"

int main() {
  const auto well = hamflow::natural<1>([](const auto& p) { return p[0] * p[0] / 2; },
                                        [](const hamflow::Vector<double, 1>& q) { return q[0] * q[0]; });
  auto orbit = hamflow::simulate(well, hamflow::Composition<hamflow::compositions::stv4>{}, {1.0}, {0.0}, 0.05);
  return orbit.advance(1) == hamflow::Outcome::done ? 0 : 1;
}
