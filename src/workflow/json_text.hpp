// Writes JSON as text and reads it. These functions are compiled once, because the reader and the writer are the
// largest part of the JSON library.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace hamflow {

/// @param indent blanks of each level; -1: one line. Bytes that are not UTF-8 are replaced.
std::string written_json(const nlohmann::ordered_json& json, int indent = -1);
/// Writes the format of files and of --json: each key on a separate line.
std::string json_text(const nlohmann::ordered_json& json);
/// @throws nlohmann::json::exception if the text is not JSON
nlohmann::ordered_json read_json(const std::string& text);
/// The same, but returns a discarded value if the text is not JSON.
nlohmann::ordered_json read_if_json(const std::string& text);
/// The same, but the order of keys does not matter when two values are compared.
nlohmann::json read_json_by_keys(const std::string& text);

}  // namespace hamflow
