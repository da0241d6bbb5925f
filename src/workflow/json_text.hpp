// JSON as text and back, compiled once: its reader and its writer are most of what a unit compiles of that library.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace hamflow {

/// @param indent of each level; -1: one line. What is no UTF-8 is replaced.
std::string written_json(const nlohmann::ordered_json& json, int indent = -1);
/// As files and --json have it: each key on a line of its own.
std::string json_text(const nlohmann::ordered_json& json);
/// @throws nlohmann::json::exception what is no JSON
nlohmann::ordered_json read_json(const std::string& text);
/// The same, discarded where it is no JSON.
nlohmann::ordered_json read_if_json(const std::string& text);
/// Likewise, equal where the keys of objects stand in another order.
nlohmann::json read_json_by_keys(const std::string& text);

}  // namespace hamflow
