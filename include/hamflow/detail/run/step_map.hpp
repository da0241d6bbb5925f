// The map of one step, z -> Psi_h(z), which the verification measures. It is type-erased, so that methods of the
// catalogue and deliberately broken ones go through the same measurements.
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

/// Steps with tangent vectors without dual numbers (src/engine/recorded_tangents.hpp). Returns false, with nothing
/// changed, if it does not support these steps.
using TangentSteps =
    std::function<bool(State<double>& z, std::vector<State<double>>& tangents, double h, std::int64_t steps)>;

class StepMap {
 public:
  virtual ~StepMap() = default;
  virtual std::size_t dimension() const = 0;
  virtual MethodInfo claims() const = 0;
  /// The full state of a run that begins at z = (q, p). A method with a second copy (x, y) of the state is a map of (q,
  /// x, p, y): advance() and jacobian() accept and return such states, too.
  virtual State<double> begun(const State<double>& z) const { return z; }
  /// With constraints a step is a map of the states on them: settled() projects z onto them, to the rounding of its
  /// number type, and directions() is an orthonormal basis of the tangent space. Without constraints: z itself, and no
  /// directions.
  virtual State<long double> settled(const State<long double>& z) const { return z; }
  virtual State<Quad> settled(const State<Quad>& z) const { return z; }
  virtual std::vector<State<double>> directions(const State<double>&) const { return {}; }
  /// Takes `steps` steps of length h from a fresh start, in double. Returns false if a step fails.
  virtual bool advance(State<double>& z, double h, std::int64_t steps) const = 0;
  /// As above, in long double, so that the rounding of double does not limit measured orders.
  virtual bool advance(State<long double>& z, long double h, std::int64_t steps) const = 0;
  /// d Psi_h(z)/dz row by row, exact: by dual numbers for an explicit step, by the implicit function theorem at the
  /// solution of an implicit step.
  virtual std::vector<std::vector<double>> jacobian(const State<double>& z, double h) const = 0;
  /// H at the start and after each of `blocks` blocks of `steps` steps, in the double arithmetic of the method.
  virtual std::vector<double> energies(const State<double>& z, double h, int blocks, std::int64_t steps) const = 0;
  /// max(|H|, |T| + |V|).
  virtual double energy_scale(const State<double>& z) const = 0;
  /// The work of `steps` steps.
  virtual Effort cost(const State<double>& z, double h, std::int64_t steps) const = 0;
  /// The exact flow over time t by a method of another family (extrapolation) in long double.
  virtual State<long double> flow(const State<long double>& z, long double t) const = 0;
  /// Whether there are steps and a flow in quad: the error of a method of order 8 reaches the rounding of long double
  /// within a few halvings.
  virtual bool has_quad() const { return false; }
  virtual bool advance(State<Quad>&, const Quad&, std::int64_t) const { return false; }
  virtual State<Quad> flow(const State<Quad>& z, const Quad&) const { return z; }
  /// advance(z, h, steps), with the same bits, which also advances tangent vectors: each is multiplied by d
  /// Psi_h^steps/dz, exact to rounding like jacobian().
  virtual bool advance_with_tangents(State<double>& z, std::vector<State<double>>& tangents, double h,
                                     std::int64_t steps) const = 0;
};

}  // namespace hamflow
