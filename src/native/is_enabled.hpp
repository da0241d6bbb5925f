#pragma once

#include <cstdlib>
#include <string_view>

namespace hamflow::native {

/// Whether machine code is enabled; HAMFLOW_NATIVE=0 selects the interpreter.
inline bool is_enabled() {
  const char* const text = std::getenv("HAMFLOW_NATIVE");
  return text == nullptr || std::string_view(text) != "0";
}

}  // namespace hamflow::native
