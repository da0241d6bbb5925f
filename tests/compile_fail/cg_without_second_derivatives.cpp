// expect: cg needs a Smooth problem
#include "hamflow/hamflow.hpp"

/// Everything by hand and for double alone: nothing that dual numbers could differentiate twice.
struct Rigid {
  using Real = double;
  static constexpr std::size_t dimension = 1;
  static constexpr bool quadratic_kinetic = true;
  using V = hamflow::Vector<double, 1>;
  double kinetic(const V& p) const { return p[0] * p[0] / 2; }
  double potential(const V& q) const { return q[0] * q[0] / 2; }
  void velocity(const V& p, V& v) const { v = p; }
  void force(const V& q, V& f) const { f[0] = -q[0]; }
};

void misuse() { (void)hamflow::simulate(Rigid{}, hamflow::Cg{}, {0.1}, {0.1}, 0.1); }
