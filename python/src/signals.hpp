// Ctrl-C while C++ computes without the interpreter's lock.
#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>

namespace hamflow::python {

/// Asks Python for signals, at most every 50 ms, and calls what the user wants to be told. What Python raises is kept,
/// the computation stops at the next step boundary, and rethrow() raises it again there.
class Interrupts {
 public:
  /// @param told called with the steps taken; may be empty
  explicit Interrupts(std::function<void(std::int64_t)> told = {}) : told_(std::move(told)) {}

  /// False: stop. To be called without the lock.
  bool go_on(std::int64_t steps) {
    const Clock::time_point now = Clock::now();
    if (raised_) return false;
    if (now - last_ < std::chrono::milliseconds(50)) return true;
    last_ = now;
    const pybind11::gil_scoped_acquire lock;
    try {
      if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
      if (told_) told_(steps);
    } catch (...) {
      raised_ = std::current_exception();
    }
    return !raised_;
  }
  bool was_interrupted() const { return raised_ != nullptr; }
  /// The exception that stopped the computation, a KeyboardInterrupt or what the user's function raised; None without
  /// one. To be called with the lock.
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
  /// To be called with the lock.
  void rethrow() const {
    if (raised_) std::rethrow_exception(raised_);
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::function<void(std::int64_t)> told_;
  Clock::time_point last_ = Clock::now();
  std::exception_ptr raised_;
};

}  // namespace hamflow::python
