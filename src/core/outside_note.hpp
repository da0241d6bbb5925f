// Who stood beyond a soft wall. There V is none, and a force that is no number ends the step, wherever in it the place
// was asked for; which coordinate or particle it was is noted here, so that the run can say it.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>

namespace hamflow {

/// While it lives, functions of this thread say here which soft interval, or which particle, was outside: the first.
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
