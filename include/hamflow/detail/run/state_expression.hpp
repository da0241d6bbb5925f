// An expression of a state: "atan2(y, x)", "x*p_y - y*p_x", "q1 - cos(t)". It may contain coordinates and momenta of a
// problem by name, parameters, and the time t. Observables and sections use such expressions.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "hamflow/detail/numerics/program.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// An expression with value semantics; copies share the parsed text.
class StateExpression {
 public:
  /// @param parameters complete   @param size of q
  /// @throws Error with the column of a syntax error or of an unknown name, and the known names
  StateExpression(const std::string& text, const ProblemEntry& problem, const Texts& parameters, std::size_t size);

  /// The value in double, whatever the arithmetic of the run.
  double operator()(const Frame& frame) const;
  const std::string& text() const;
  /// Whether the value depends on the k-th number of (q, p).
  bool uses(std::size_t k) const;
  bool uses_time() const;
  /// Appends operations that compute it, with the same bits, to a program. @param state the numbers of q, then of p
  /// @return the value; nullopt if it uses the time
  std::optional<Operand> append_to(Program& program, std::span<const Operand> state) const;

 private:
  struct Read;
  std::shared_ptr<const Read> read_;
};

/// An expression with a name, such as an observable.
struct NamedExpression {
  std::string name;
  StateExpression expression;
};

}  // namespace hamflow
