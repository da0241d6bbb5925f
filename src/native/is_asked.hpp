#pragma once

#include <cstdlib>
#include <string_view>

namespace hamflow::native {

/// HAMFLOW_NATIVE=0 asks for the interpreter.
inline bool is_asked() {
  const char* const text = std::getenv("HAMFLOW_NATIVE");
  return text == nullptr || std::string_view(text) != "0";
}

}  // namespace hamflow::native
