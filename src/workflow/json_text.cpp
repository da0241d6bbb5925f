#include "json_text.hpp"

#include <nlohmann/json.hpp>

namespace hamflow {

std::string written_json(const nlohmann::ordered_json& json, int indent) {
  return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::string json_text(const nlohmann::ordered_json& json) { return written_json(json, 2) + "\n"; }

nlohmann::ordered_json read_json(const std::string& text) { return nlohmann::ordered_json::parse(text); }

nlohmann::ordered_json read_if_json(const std::string& text) {
  return nlohmann::ordered_json::parse(text, nullptr, false);
}

nlohmann::json read_json_by_keys(const std::string& text) { return nlohmann::json::parse(text, nullptr, false); }

}  // namespace hamflow
