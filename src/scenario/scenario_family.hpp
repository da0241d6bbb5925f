// Many scenarios that differ in a few keys. The text is parsed once; then each member is read and checked like a single
// scenario with --set PATH=VALUE.
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

  /// The errors that all members share.
  const std::vector<Complaint>& complaints() const;
  /// Parses a value for later members, so that it is parsed only once. @return its number
  std::size_t add_value(const std::string& text);
  void replace_value(std::size_t number, const std::string& text);
  /// Sets paths[i] to the value with number values[i] and reads the scenario. Its text is empty. If the only error is
  /// that no start has the requested energy, `startless` is set in place of `scenario`.
  Reading read(const std::vector<std::string>& paths, const std::vector<std::size_t>& values);
  /// The scenario that all members share, with every --set, before any key is varied.
  const std::string& text() const;
  /// The keys of the shared scenario. Keys of single members are not listed.
  const std::map<std::string, Setting>& settings() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hamflow
