#include "hamflow/core/function_set.hpp"

#include <mutex>

#include "hamflow/core/error.hpp"

namespace hamflow {

namespace {

#ifdef __EMSCRIPTEN__
constexpr bool is_fixed = true;  // whatever is wanted: functions_are_portable()
#else
constexpr bool is_fixed = false;
#endif

}  // namespace

std::atomic<int> FunctionsInUse::users_{0};

FunctionsInUse::FunctionsInUse(FunctionSet wanted) {
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  const bool portable = wanted == FunctionSet::portable;
  if (!is_fixed && portable != detail::portable_functions) {
    // In this order, no simulation can begin between the question and the change.
    if (users_ > 0) {
      throw Error(std::string("this process computes with functions = \"") + (portable ? "system" : "portable") +
                  "\", because a simulation with them still exists; end it first, or use another process");
    }
    detail::portable_functions = portable;
  }
  ++users_;
}

}  // namespace hamflow
