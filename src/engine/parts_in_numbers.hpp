// Partial steps on plain numbers: while a wall is located, only the numbers of the state change and not the simulation.
// A path between walls is then only machine code.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "hamflow/core/method_info.hpp"
#include "hamflow/detail/numerics/program.hpp"

namespace hamflow {

/// A part of a step, recorded (recorded_part.hpp). The values of the program: those of the archive of the state, h,
/// then q, dH/dp and H at the end.
struct RecordedPart {
  Program program;
  std::size_t state = 0;                 // number of values in the archive of the state
  std::size_t size = 0;                  // of q
  Effort effort;                         // the work of one part
  std::vector<std::int64_t> counters{};  // increments by one part of the counters in the method's archive, in order

  std::size_t length() const { return state; }
  std::size_t end() const { return state + 1; }
};

class PartsInNumbers {
 public:
  explicit PartsInNumbers(RecordedPart part);

  const RecordedPart& part() const { return compiled_->part; }
  /// The numbers of the state, to be filled in before the first part.
  double* begin();
  const double* state() const { return state_.data(); }
  /// Evaluates Psi_h from the state: q, dH/dp, H, valid until the next call. Null if a number is not finite or the part
  /// takes another branch.
  const double* look(double h);
  /// Moves to the state that look has just evaluated.
  void go();

  /// Return a coordinate and a momentum. A compensated number is stored as two, and the first is its value.
  double position(std::size_t i) const { return state_[each_ * i]; }
  double momentum(std::size_t i) const { return state_[each_ * (part().size + i)]; }
  void negate_momentum(std::size_t i);

  /// The work since begin().
  Effort effort() const;                            // the work of all calls of look
  std::int64_t parts() const { return parts_; }     // number of parts taken
  double energy() const { return values_.back(); }  // after the last look

 private:
  struct Compiled {
    RecordedPart part;
    std::unique_ptr<const StepLoop> loop;
  };
  std::shared_ptr<const Compiled> compiled_;  // copies share it
  std::size_t each_;                          // stored numbers per coordinate
  std::vector<double> state_;
  std::vector<double> values_;  // the values of the program after the last look
  std::int64_t looks_ = 0;
  std::int64_t parts_ = 0;
};

/// A simulation whose parts may be recorded.
class HasPartsInNumbers {
 public:
  virtual ~HasPartsInNumbers() = default;
  /// Partial steps on the numbers of the present state; the simulation is updated by land(). Null if parts are not
  /// recorded yet.
  virtual PartsInNumbers* parts_in_numbers() = 0;
  /// Moves the simulation to the state of the numbers. @return false, with nothing done, if complete_step would not
  /// find a finite energy
  virtual bool write_back_state() = 0;
};

}  // namespace hamflow
