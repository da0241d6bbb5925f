// Many scenarios that differ in a few keys: the text is parsed once, then each member is read and checked like a
// scenario of its own with --set PATH=VALUE.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

class ScenarioFamily {
 public:
  /// @param sets PATH=VALUE texts, for all members
  ScenarioFamily(const std::string& text, const std::string& name, const std::vector<std::string>& sets);
  ~ScenarioFamily();
  ScenarioFamily(const ScenarioFamily&) = delete;
  ScenarioFamily& operator=(const ScenarioFamily&) = delete;

  /// What is wrong for all members.
  const std::vector<Complaint>& complaints() const;
  /// Prepares a value that members may have, so that it is parsed once. @return its number
  std::size_t add_value(const std::string& text);
  void replace_value(std::size_t number, const std::string& text);
  /// Sets paths[i] to the value of number values[i] and reads the scenario. Its text is empty. Where nothing is wrong
  /// but that no start has the energy asked for, `startless` is set in the place of `scenario`.
  Reading read(const std::vector<std::string>& paths, const std::vector<std::size_t>& values);
  /// What is common to all members: the scenario with every --set, before anything is varied.
  const std::string& text() const;
  /// Its keys. Those of a member's scenario are not listed.
  const std::map<std::string, Setting>& settings() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hamflow
