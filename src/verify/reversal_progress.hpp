// The progress of a reversal: the data that, with the simulation, let a stopped reversal continue with the same bits
// and find the same distance.
#pragma once

#include "hamflow/verify/certificate.hpp"

namespace hamflow {

struct ReversalProgress {
  bool begun = false;
  bool turned = false;          // the momenta are negated: this is the way back
  std::int64_t first = 0;       // the step at which the way there began
  StateSizes sizes;             // along the way there
  Frame start, turn;            // without effort and diagnostics once they were archived
  std::vector<std::byte> bits;  // of the start
  std::uint64_t start_hash = 0, turn_hash = 0;
  Excursion forward_energy;  // of the way there, as far as it has come; archived by those who want it

  template <class Archive>
  void archive(Archive& ar) {
    ar(begun, turned, first, bits, start_hash, turn_hash, sizes);
    for (Frame* frame : {&start, &turn}) {
      FrameDigits& digits = frame->digits;
      ar(frame->step, frame->time, frame->q, frame->p, frame->energy, frame->invariants);
      ar(digits.time, digits.q, digits.p, digits.energy, digits.initial_energy);
    }
  }
};

/// reverse() from where `progress` stands, which is kept up to date: whenever `pulse` or an observer is called, the
/// simulation and the progress belong together.
/// @param observers watch both ways
Reversal reverse(Simulation& simulation, std::int64_t steps, const std::function<bool(std::int64_t step)>& pulse,
                 std::span<Observer* const> observers, ReversalProgress& progress, const UnitGroups& groups = {});

}  // namespace hamflow
