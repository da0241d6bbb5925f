// Handles Ctrl-C while C++ computes without the interpreter's lock.
#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>

namespace hamflow::python {

/// Checks Python's signals at most every 50 ms, and calls the user's progress function. If either raises, go_on()
/// returns false, so that the computation stops after its step, and rethrow() raises the exception again.
class Interrupts {
 public:
  /// @param progress the progress function, called with the number of steps taken; may be empty
  explicit Interrupts(std::function<void(std::int64_t)> progress = {}) : progress_(std::move(progress)) {}

  /// Returns false if the computation has to stop. The caller has released the lock.
  bool go_on(std::int64_t steps) {
    const Clock::time_point now = Clock::now();
    if (raised_) return false;
    if (now - last_ < std::chrono::milliseconds(50)) return true;
    last_ = now;
    const pybind11::gil_scoped_acquire lock;
    try {
      if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
      if (progress_) progress_(steps);
    } catch (...) {
      raised_ = std::current_exception();
    }
    return !raised_;
  }
  bool was_interrupted() const { return raised_ != nullptr; }
  /// Returns the exception that stopped the computation (KeyboardInterrupt, or what the progress function raised), or
  /// None. The caller holds the lock.
  pybind11::object raised() const {
    try {
      rethrow();
    } catch (const pybind11::error_already_set& error) {
      pybind11::object value = error.value();
      if (error.trace()) value.attr("__traceback__") = error.trace();
      return value;
    }
    return pybind11::none();
  }
  /// Raises the exception that stopped the computation, if there is one. The caller holds the lock.
  void rethrow() const {
    if (raised_) std::rethrow_exception(raised_);
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::function<void(std::int64_t)> progress_;
  Clock::time_point last_ = Clock::now();
  std::exception_ptr raised_;
};

}  // namespace hamflow::python
