// The map of one step, z -> Psi_h(z), seen from outside: what the verification measures. Type-erased, so that catalogue
// methods and deliberately broken ones go through the same measurements.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "hamflow/arithmetic/quad.hpp"
#include "hamflow/core/method_info.hpp"

namespace hamflow {

/// A state in R, first q, then p, n numbers each.
template <class R>
using State = std::vector<R>;

/// Steps with tangent vectors by another way than dual numbers (src/engine/recorded_tangents.hpp). False: it does not
/// know these steps, and has changed nothing.
using TangentSteps =
    std::function<bool(State<double>& z, std::vector<State<double>>& tangents, double h, std::int64_t steps)>;

class StepMap {
 public:
  virtual ~StepMap() = default;
  virtual std::size_t dimension() const = 0;
  virtual MethodInfo claims() const = 0;
  /// Where a run that begins at z = (q, p) has its first step. A method that carries a second copy (x, y) of the state
  /// is a map of (q, x, p, y): advance() and jacobian() take such states, too, and give them back.
  virtual State<double> begun(const State<double>& z) const { return z; }
  /// With constraints a step is a map of the states on them: z moved there, to the rounding of its number type, and the
  /// directions in which z can move there, an orthonormal basis. Without constraints z itself, and no directions.
  virtual State<long double> settled(const State<long double>& z) const { return z; }
  virtual State<Quad> settled(const State<Quad>& z) const { return z; }
  virtual std::vector<State<double>> directions(const State<double>&) const { return {}; }
  /// `steps` steps of length h from a fresh start, in double. False when a step fails.
  virtual bool advance(State<double>& z, double h, std::int64_t steps) const = 0;
  /// The same in long double: measured orders are not limited by the rounding of double.
  virtual bool advance(State<long double>& z, long double h, std::int64_t steps) const = 0;
  /// d Psi_h(z)/dz row by row, exact: dual numbers through an explicit step, the implicit function theorem at the
  /// solution of an implicit one.
  virtual std::vector<std::vector<double>> jacobian(const State<double>& z, double h) const = 0;
  /// H at the start and after each of `blocks` blocks of `steps` steps, in the double arithmetic of the method.
  virtual std::vector<double> energies(const State<double>& z, double h, int blocks, std::int64_t steps) const = 0;
  /// max(|H|, |T| + |V|).
  virtual double energy_scale(const State<double>& z) const = 0;
  /// What `steps` steps cost.
  virtual Effort cost(const State<double>& z, double h, std::int64_t steps) const = 0;
  /// The exact flow over time t by a method of another family (extrapolation) in long double.
  virtual State<long double> flow(const State<long double>& z, long double t) const = 0;
  /// Steps and flow in quad, where there are: the error of a method of order 8 reaches the rounding of long double
  /// within a few halvings.
  virtual bool has_quad() const { return false; }
  virtual bool advance(State<Quad>&, const Quad&, std::int64_t) const { return false; }
  virtual State<Quad> flow(const State<Quad>& z, const Quad&) const { return z; }
  /// advance(z, h, steps), bit for bit, that takes tangent vectors with it: each becomes (d Psi_h^steps/dz) times
  /// itself, exact to rounding like jacobian().
  virtual bool advance_with_tangents(State<double>& z, std::vector<State<double>>& tangents, double h,
                                     std::int64_t steps) const = 0;
};

}  // namespace hamflow
