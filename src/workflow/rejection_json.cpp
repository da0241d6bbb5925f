#include "hamflow/workflow/rejection_json.hpp"

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "summary.hpp"

namespace hamflow {

namespace {
using Json = nlohmann::ordered_json;

std::string rejected(const Json& errors) { return json_text({{"status", "rejected"}, {"errors", errors}}); }

/// FILE:LINE:COL: error: KEY: message, --vary: error: KEY: message, --out: message, or another sentence.
Complaint parts_of(const std::string& line) {
  const std::string mark = ": error: ";
  const std::size_t at = line.find(mark);
  if (at == std::string::npos) {
    return {"", 0, 0, line.starts_with("-") ? line.substr(0, line.find_first_of(": ")) : "", line};
  }
  const std::string head = line.substr(0, at);
  const std::string behind = line.substr(at + mark.size());
  std::string key = behind.substr(0, behind.find(": "));
  if (key.find(' ') != std::string::npos) key.clear();  // a sentence
  if (head.starts_with("--")) return {"", 0, 0, key.empty() ? head : key, line};
  const std::size_t second = head.rfind(':');
  const std::size_t first = second == std::string::npos || second == 0 ? second : head.rfind(':', second - 1);
  if (first == std::string::npos || first == second) return {"", 0, 0, key, line};
  return {head.substr(0, first), std::atoi(head.c_str() + first + 1), std::atoi(head.c_str() + second + 1), key, line};
}
}  // namespace

std::string rejection_json(const std::vector<Complaint>& complaints) {
  Json errors = Json::array();
  for (const Complaint& c : complaints) {
    errors.push_back({{"file", c.file}, {"line", c.line}, {"column", c.column}, {"key", c.key}, {"message", c.text()}});
  }
  return rejected(errors);
}

std::string rejection_json(const std::vector<std::string>& lines) {
  Json errors = Json::array();
  for (const std::string& line : lines) {
    const Complaint c = parts_of(line);
    errors.push_back({{"file", c.file}, {"line", c.line}, {"column", c.column}, {"key", c.key}, {"message", line}});
  }
  return rejected(errors);
}

std::string failure_json(const std::string& kind, const std::string& message) {
  return json_text({{"status", "failed"}, {"error", {{"kind", kind}, {"message", message}}}});
}

}  // namespace hamflow
