// Reads the scenarios of a sweep's members one after the other, from one parsed text.
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenario_family.hpp"
#include "varied.hpp"

namespace hamflow {

class MemberReader {
 public:
  /// @param varied has to outlive the reader
  MemberReader(const Varied& varied, const std::string& text, const std::string& name,
               const std::vector<std::string>& sets)
      : varied_(varied), paths_(varied.paths()), family_(text, name, sets) {}

  Reading read(std::size_t member) {
    std::vector<std::size_t> values;
    std::string no_start;
    for (std::size_t key = 0; key < varied_.size(); ++key) {
      if (std::string why = varied_.without_start(member, key); !why.empty()) {
        no_start = std::move(why);
        // The formula has no value for this member, which is not run. Reading it with the number 1 checks its other
        // keys.
        if (!stand_in_) stand_in_ = family_.add_value("1");
        values.push_back(*stand_in_);
      } else {
        values.push_back(value_of(member, key));
      }
    }
    Reading reading = family_.read(paths_, values);
    if (!no_start.empty()) without_start(reading, no_start);
    return reading;
  }
  const std::vector<std::string>& paths() const { return paths_; }
  const ScenarioFamily& family() const { return family_; }

 private:
  /// Marks a member as complete except for its start.
  static void without_start(Reading& reading, const std::string& why) {
    reading.no_start = why;
    if (reading.scenario) reading.scenario_without_start = std::exchange(reading.scenario, std::nullopt);
    if (!reading.scenario_without_start) return;
    reading.scenario_without_start->start_q.assign(reading.scenario_without_start->start_q.size(),
                                                   std::numeric_limits<double>::quiet_NaN());
    reading.scenario_without_start->start_p = reading.scenario_without_start->start_q;
  }
  /// A value of a list is parsed once if several members have it. Values of a formula, and of a list as long as the
  /// sweep, are parsed for each member: a million parsed values would take 300 MB.
  std::size_t value_of(std::size_t member, std::size_t key) {
    const Vary& vary = varied_.keys()[key];
    const bool is_shared = vary.formula.empty() && vary.texts.size() < varied_.members();
    const auto [at, is_new] = numbers_.try_emplace({key, is_shared ? varied_.place(member, key) : 0});
    if (is_new) {
      at->second = family_.add_value(varied_.text(member, key));
    } else if (!is_shared) {
      family_.replace_value(at->second, varied_.text(member, key));
    }
    return at->second;
  }

  const Varied& varied_;
  std::vector<std::string> paths_;
  ScenarioFamily family_;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> numbers_;
  std::optional<std::size_t> stand_in_;  // the number of the value 1
};

}  // namespace hamflow
