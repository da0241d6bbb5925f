// Records which coordinate or particle left the domain of a soft-wall potential, so that the run can report it. V is
// undefined outside the domain: the force is NaN there, which ends the step at whatever stage it was evaluated.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>

namespace hamflow {

/// While this object exists, functions of this thread record here the first soft interval or particle found outside.
class OutsideNote {
 public:
  explicit OutsideNote(std::optional<std::size_t>& which) : before_(std::exchange(here(), &which)) {}
  ~OutsideNote() { here() = before_; }
  OutsideNote(const OutsideNote&) = delete;
  OutsideNote& operator=(const OutsideNote&) = delete;
  [[gnu::cold]] static void note(std::size_t which) {
    if (here() != nullptr && !*here()) *here() = which;
  }

 private:
  static std::optional<std::size_t>*& here() {
    thread_local std::optional<std::size_t>* note = nullptr;
    return note;
  }
  std::optional<std::size_t>* before_;
};

}  // namespace hamflow
