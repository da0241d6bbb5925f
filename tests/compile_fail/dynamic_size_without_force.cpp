// expect: for dynamic size velocity(p, v) and force(q, f)
#include "hamflow/hamflow.hpp"

/// Generic, so that dual numbers could pass through; but those of a system of any size would have no slopes.
struct Oscillators {
  using Real = double;
  static constexpr std::size_t dimension = hamflow::dynamic;
  static constexpr bool quadratic_kinetic = true;
  std::size_t n = 3;
  std::size_t size() const { return n; }
  template <class S>
  S kinetic(const hamflow::Vector<S, hamflow::dynamic>& p) const {
    S sum(0);
    for (const S& x : p) sum += x * x;
    return sum / 2.0;
  }
  template <class S>
  S potential(const hamflow::Vector<S, hamflow::dynamic>& q) const {
    return kinetic(q);
  }
};

static_assert(!hamflow::Separable<Oscillators> && !hamflow::Differentiable<Oscillators>);
static_assert(!hamflow::TwiceDifferentiable<Oscillators> && !hamflow::Smooth<Oscillators>);

void misuse() {
  (void)hamflow::simulate(Oscillators{}, hamflow::Composition<hamflow::compositions::verlet>{}, {0.1, 0.2, 0.3},
                          {0.1, 0.2, 0.3}, 0.1);
}
