// expect: one of dynamic size must define velocity and force, or gradient
#include "hamflow/hamflow.hpp"

/// H whole, generic, of any size.
struct Coupled {
  using Real = double;
  static constexpr std::size_t dimension = hamflow::dynamic;
  std::size_t size() const { return 2; }
  template <class S>
  S energy(const hamflow::Vector<S, hamflow::dynamic>& q, const hamflow::Vector<S, hamflow::dynamic>& p) const {
    S sum(0);
    for (std::size_t i = 0; i < 2; ++i) sum += p[i] * p[i] * (q[i] * q[i] + 1.0);
    return sum;
  }
};

static_assert(!hamflow::Differentiable<Coupled> && !hamflow::Smooth<Coupled>);

void misuse() {
  (void)hamflow::simulate(Coupled{}, hamflow::RungeKuttaBy<hamflow::tableaus::rk4>{}, {0.1, 0.2}, {0.1, 0.2}, 0.1);
}
