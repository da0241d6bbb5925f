#include "hamflow/workflow/rejection_json.hpp"

#include <nlohmann/json.hpp>

#include "summary.hpp"

namespace hamflow {

namespace {
using Json = nlohmann::ordered_json;

std::string rejected(const Json& errors) { return json_text({{"status", "rejected"}, {"errors", errors}}); }
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
    errors.push_back({{"file", ""}, {"line", 0}, {"column", 0}, {"key", ""}, {"message", line}});
  }
  return rejected(errors);
}

std::string failure_json(const std::string& kind, const std::string& message) {
  return json_text({{"status", "failed"}, {"error", {{"kind", kind}, {"message", message}}}});
}

}  // namespace hamflow
