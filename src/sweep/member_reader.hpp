// The scenarios of a sweep's members, one after the other, read from one parsed text.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scenario_family.hpp"
#include "varied.hpp"

namespace hamflow {

class MemberReader {
 public:
  /// @param varied has to live as long
  MemberReader(const Varied& varied, const std::string& text, const std::string& name,
               const std::vector<std::string>& sets)
      : varied_(varied), paths_(varied.paths()), family_(text, name, sets) {}

  Reading read(std::size_t member) {
    std::vector<std::size_t> values;
    for (std::size_t key = 0; key < varied_.size(); ++key) values.push_back(value_of(member, key));
    return family_.read(paths_, values);
  }
  const std::vector<std::string>& paths() const { return paths_; }
  const ScenarioFamily& family() const { return family_; }

 private:
  /// Values of a list are parsed once, those of a formula for each member.
  std::size_t value_of(std::size_t member, std::size_t key) {
    const auto [at, is_new] = numbers_.try_emplace({key, varied_.place(member, key)});
    if (is_new) {
      at->second = family_.add_value(varied_.text(member, key));
    } else if (!varied_.keys()[key].formula.empty()) {
      family_.replace_value(at->second, varied_.text(member, key));
    }
    return at->second;
  }

  const Varied& varied_;
  std::vector<std::string> paths_;
  ScenarioFamily family_;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> numbers_;
};

}  // namespace hamflow
