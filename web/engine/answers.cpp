#include "answers.hpp"

namespace hamflow {

const char* answered(const Json& json) {
  static std::string answer;
  answer = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  return answer.c_str();
}

Json errors_of(const std::vector<Complaint>& complaints) {
  Json all = Json::array();
  for (const Complaint& each : complaints) {
    all.push_back({{"line", each.line}, {"column", each.column}, {"key", each.key}, {"message", each.message}});
  }
  return {{"errors", all}};
}

Json errors_of_exception() {
  try {
    throw;
  } catch (const Rejection& rejection) {
    return errors_of(rejection.complaints);
  } catch (const std::exception& error) {
    return errors_of({Complaint{.message = error.what()}});
  }
}

}  // namespace hamflow
