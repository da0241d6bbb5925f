// The files of tests/data.
#pragma once

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace hamflow::test {

inline nlohmann::json reference_file(const std::string& name) {
  std::ifstream in(std::string(HAMFLOW_TEST_DATA) + "/" + name);
  return nlohmann::json::parse(in);
}

inline std::vector<double> doubles(const nlohmann::json& texts) {
  std::vector<double> out;
  for (const auto& x : texts) out.push_back(x.is_string() ? std::stod(x.get<std::string>()) : x.get<double>());
  return out;
}

inline std::vector<std::string> texts(const nlohmann::json& list) {
  std::vector<std::string> out;
  for (const auto& x : list) out.push_back(x.is_string() ? x.get<std::string>() : x.dump());
  return out;
}

}  // namespace hamflow::test
