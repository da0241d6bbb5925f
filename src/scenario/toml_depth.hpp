// Limits the nesting of a TOML text before it is parsed. toml++ visits and destroys nested tables recursively, and a
// key with thousands of parts, a.a.a..., makes as many nested tables, which overflow the stack.
#pragma once

#include <optional>
#include <string>

namespace hamflow {

/// These limits are far above those of any scenario.
constexpr int most_key_parts = 16;
constexpr int most_nested_brackets = 32;

/// Position at which a text is nested too deeply, with a message.
struct NestingError {
  int line = 1;
  int column = 1;
  std::string message;  // "found ...; allowed ..."
};

/// Returns the first key with too many parts, or the first bracket that is nested too deeply; nullopt if there is none.
std::optional<NestingError> too_deep(const std::string& toml);

}  // namespace hamflow
