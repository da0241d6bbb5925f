// An expression of a state: "atan2(y, x)", "x*p_y - y*p_x", "q1 - cos(t)". It knows the coordinates and momenta of a
// problem by their names, the parameters with their values, and the time t. Observables and sections are made of them.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "hamflow/detail/numerics/program.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// A value, whose copies share what was read.
class StateExpression {
 public:
  /// @param parameters complete   @param size of q
  /// @throws Error at the column where the text makes no sense, with the names that are known
  StateExpression(const std::string& text, const ProblemEntry& problem, const Texts& parameters, std::size_t size);

  /// In double, whatever the arithmetic of the run.
  double operator()(const Frame& frame) const;
  const std::string& text() const;
  /// Whether the k-th number of q, then of p, decides its value.
  bool uses(std::size_t k) const;
  bool uses_time() const;
  /// Appends what computes it, with the same bits, to a program. @param state the numbers of q, then of p
  /// @return the value; nothing where it uses the time
  std::optional<Operand> append_to(Program& program, std::span<const Operand> state) const;

 private:
  struct Read;
  std::shared_ptr<const Read> read_;
};

/// A name for an expression, as an observable has.
struct NamedExpression {
  std::string name;
  StateExpression expression;
};

}  // namespace hamflow
