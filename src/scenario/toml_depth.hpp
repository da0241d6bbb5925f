// How deep a TOML text nests, before it is parsed: toml++ walks and destroys nested tables by recursion, and a key of
// thousands of parts, a.a.a..., is as many tables in each other, more than the stack holds.
#pragma once

#include <optional>
#include <string>

namespace hamflow {

/// Far more than any scenario has.
constexpr int most_key_parts = 16;
constexpr int most_nested_brackets = 32;

/// Where a text is nested too deep, and how.
struct TooDeep {
  int line = 1;
  int column = 1;
  std::string message;  // "found ...; allowed ..."
};

/// The first key with too many parts, or the first bracket within too many others.
std::optional<TooDeep> too_deep(const std::string& toml);

}  // namespace hamflow
