// Parts of a step as numbers alone: while a wall is sought nothing of the simulation moves but the numbers of its
// state. A flight between walls is some machine code and nothing else.
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
  std::size_t state = 0;                 // how many values the archive of the state has
  std::size_t size = 0;                  // of q
  Effort effort;                         // of one part
  std::vector<std::int64_t> counters{};  // what one part adds to the counters that the method archives, in their order

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
  /// Where Psi_h leads from the state: q, dH/dp, H, until the next look. Null: a number is not finite, or the part is
  /// one of another branch.
  const double* look(double h);
  /// To where look has just led.
  void go();

  /// As numbers, of which compensated ones have two: the first is their value.
  double position(std::size_t i) const { return state_[each_ * i]; }
  double momentum(std::size_t i) const { return state_[each_ * (part().size + i)]; }
  void negate_momentum(std::size_t i);

  /// Since begin().
  Effort effort() const;                            // of all looks
  std::int64_t parts() const { return parts_; }     // that were taken
  double energy() const { return values_.back(); }  // behind the last look

 private:
  struct Compiled {
    RecordedPart part;
    std::unique_ptr<const StepLoop> loop;
  };
  std::shared_ptr<const Compiled> compiled_;  // copies share it
  std::size_t each_;                          // numbers of a coordinate
  std::vector<double> state_;
  std::vector<double> values_;  // of the program, behind the last look
  std::int64_t looks_ = 0;
  std::int64_t parts_ = 0;
};

/// A simulation whose parts are recorded some day.
class MovesInNumbers {
 public:
  virtual ~MovesInNumbers() = default;
  /// Parts of the present state as numbers, which the simulation knows nothing of until land. Null: there are none yet.
  virtual PartsInNumbers* parts_in_numbers() = 0;
  /// To where the numbers have gone. @return false where complete_step would not find a finite energy: then nothing was
  /// done
  virtual bool land() = 0;
};

}  // namespace hamflow
