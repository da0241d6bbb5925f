#include "suggested_names.hpp"

#include <algorithm>
#include <map>

#include "hamflow/core/text.hpp"
#include "hamflow/formula/problem_texts.hpp"
#include "method_keys.hpp"
#include "run_keys.hpp"

namespace hamflow {

namespace {
bool has(const std::vector<std::string>& list, const std::string& word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

/// Returns the words that choose between problems of one name, each with a text such as `central-force with potential =
/// "kepler"`.
const std::map<std::string, std::string>& problems_by_choice() {
  static const std::map<std::string, std::string> all = [] {
    std::map<std::string, std::string> map;
    for (const ProblemEntry& entry : problems()) {
      for (const auto& [key, word] : entry.info.variant) {
        map.try_emplace(word, entry.info.name + " with " + key + " = \"" + word + "\"");
      }
    }
    return map;
  }();
  return all;
}
}  // namespace

std::string suggested_problem(const std::string& name) {
  std::vector<std::string> names;
  for (const ProblemEntry& entry : problems()) names.push_back(entry.info.name);
  std::vector<std::string> choices;
  for (const auto& [word, whole] : problems_by_choice()) choices.push_back(word);
  const std::string choice = nearest(name, choices);
  const std::string near = choice == name ? "" : suggestion(name, names);
  if (!near.empty() || choice.empty()) return near;
  return "; did you mean " + problems_by_choice().at(choice) + "?";
}

std::string removed_key(const std::string& path) {
  if (path == "run.kernel") return "delete this key; every run now behaves as with kernel = \"exact\"";
  return {};
}

std::string key_elsewhere(const std::string& path, const ProblemEntry* problem, const std::string& method) {
  const std::size_t dot = path.rfind('.');
  const std::string name = path.substr(dot == std::string::npos ? 0 : dot + 1);
  std::vector<std::string> places;
  for (const DeclaredTable& table : declared_tables()) {
    if (has(option_names(table.keys), name)) places.push_back(table.name + "." + name);
  }
  const bool of_method =
      method.empty() ? has(all_method_keys(), name) : find_option(find_method(method).family->options, name) != nullptr;
  if (of_method) places.push_back("method." + name);
  const auto has_key = [&](const ProblemEntry& entry) {
    const auto is_choice = [&](const auto& choice) { return choice.first == name; };
    return find_option(entry.info.parameters, name) != nullptr ||
           std::any_of(entry.info.variant.begin(), entry.info.variant.end(), is_choice);
  };
  const bool of_problem =
      problem == nullptr ? std::any_of(problems().begin(), problems().end(), has_key) : has_key(*problem);
  const bool typed = problem != nullptr && problem->structure && find_option(problem->info.parameters, name) != nullptr;
  if (typed) places.push_back(std::string("problem.") + FormulaKeys::parameters + "." + name);
  if ((of_problem && !typed) || name == "initial" || name == "orbit") places.push_back("problem." + name);
  std::erase(places, path);
  return places.empty() ? "" : "; did you mean " + joined(places, " or ") + "?";
}

}  // namespace hamflow
