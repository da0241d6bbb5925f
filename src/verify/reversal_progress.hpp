// Progress of a reversal. Together with the simulation it lets a stopped reversal continue with the same bits and find
// the same distance.
#pragma once

#include "hamflow/verify/certificate.hpp"

namespace hamflow {

struct ReversalProgress {
  bool begun = false;
  bool turned = false;          // the momenta have been negated, so the second half is running
  std::int64_t first = 0;       // step at which the first half began
  StateSizes sizes;             // sizes along the first half
  Frame start, turn;            // without effort and diagnostics once they have been archived
  std::vector<std::byte> bits;  // bits of the start
  std::uint64_t start_hash = 0, turn_hash = 0;
  Excursion forward_energy;  // energy error of the first half so far; not archived here

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

/// Continues a reversal from `progress` and keeps it up to date: whenever `pulse` or an observer is called, the
/// simulation and the progress belong together.
/// @param observers observers of both halves
Reversal reverse(Simulation& simulation, std::int64_t steps, const std::function<bool(std::int64_t step)>& pulse,
                 std::span<Observer* const> observers, ReversalProgress& progress, const UnitGroups& groups = {});

}  // namespace hamflow
