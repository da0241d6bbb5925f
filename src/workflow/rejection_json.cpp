#include "hamflow/detail/workflow/rejection_json.hpp"

#include <nlohmann/json.hpp>

#include "json_text.hpp"

namespace hamflow {

namespace {
using Json = nlohmann::ordered_json;
}  // namespace

std::string rejection_json(const std::vector<Complaint>& complaints) {
  Json errors = Json::array();
  for (const Complaint& c : complaints) {
    errors.push_back(
        {{"file", c.origin()}, {"line", c.line}, {"column", c.column}, {"key", c.key}, {"message", c.message}});
  }
  return json_text({{"status", "rejected"}, {"errors", errors}});
}

std::string failure_json(const std::string& kind, const std::string& message) {
  return json_text({{"status", "failed"}, {"error", {{"kind", kind}, {"message", message}}}});
}

}  // namespace hamflow
