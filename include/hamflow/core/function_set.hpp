// Which functions (exp, sin, ...) of doubles this process computes with: those of the system's library, or those of
// detail/core/portable_functions.hpp, which have the same bits on every machine.
//
// The choice is one for the process, because functions are called in kernels that know only numbers. It holds until
// another one is made, and cannot change while a simulation exists.
#pragma once

#include <atomic>

namespace hamflow {

enum class FunctionSet : unsigned char { system, portable };

namespace detail {
inline std::atomic<bool> portable_functions{false};
}  // namespace detail

/// Whether exp(x), sin(x), ... of hamflow are the portable functions. In the laboratory they always are.
inline bool functions_are_portable() {
#ifdef __EMSCRIPTEN__
  return true;
#else
  return detail::portable_functions.load(std::memory_order_relaxed);
#endif
}

/// As long as one exists, the functions of the process do not change.
class FunctionsInUse {
 public:
  /// Keeps the functions as they are.
  FunctionsInUse() noexcept { ++users_; }
  /// Chooses the functions. @throws Error if the others are in use
  explicit FunctionsInUse(FunctionSet wanted);
  FunctionsInUse(const FunctionsInUse&) noexcept : FunctionsInUse() {}
  FunctionsInUse& operator=(const FunctionsInUse&) noexcept { return *this; }
  ~FunctionsInUse() { --users_; }

 private:
  static std::atomic<int> users_;
};

}  // namespace hamflow
