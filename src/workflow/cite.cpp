#include "hamflow/workflow/cite.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>

#include "hamflow/core/version.hpp"
#include "hamflow/run/catalog.hpp"
#include "references.hpp"

namespace hamflow {

namespace {

/// Returns the entries of docs/references.bib by their keys. An entry begins with `@` at the start of a line.
const std::map<std::string, std::string>& references() {
  static const std::map<std::string, std::string> all = [] {
    std::map<std::string, std::string> entries;
    const std::string text = references_bib();
    for (std::size_t at = text.find("\n@"); at != std::string::npos;) {
      const std::size_t next = text.find("\n@", at + 1);
      std::string entry = text.substr(at + 1, next == std::string::npos ? next : next - at - 1);
      entry.erase(entry.find_last_of('}') + 1);
      const std::size_t brace = entry.find('{');
      entries[entry.substr(brace + 1, entry.find(',') - brace - 1)] = entry + "\n";
      at = next;
    }
    return entries;
  }();
  return all;
}

std::string hamflow_entry() {
  return "@software{hamflow,\n"
         "  title   = {hamflow: structure-preserving time integration of {H}amiltonian systems},\n"
         "  version = {" HAMFLOW_VERSION
         "},\n"
         "  note    = {Please give the version, and the method and the arithmetic of the run}\n}\n";
}

/// Adds the entries of a reference that have not been added yet.
void add_works(const std::string& reference, std::vector<std::string>& keys, std::string& text) {
  for (const std::string& key : cited_keys(reference)) {
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
    keys.push_back(key);
    text += "\n" + references().at(key);
  }
}

}  // namespace

std::vector<std::string> cited_keys(const std::string& reference) {
  std::vector<std::string> keys;
  const auto is_part = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; };
  for (std::size_t at = 0; at < reference.size();) {
    std::size_t end = at;
    while (end < reference.size() && is_part(reference[end])) ++end;
    const std::string word = reference.substr(at, end - at);
    if (references().contains(word)) keys.push_back(word);
    at = std::max(end, at + 1);
  }
  return keys;
}

std::string bibtex_of(const std::string& name) {
  std::vector<std::string> keys;
  std::string text = hamflow_entry();
  bool found = false;
  for (const ProblemEntry& entry : problems()) {
    if (entry.info.name != name) continue;
    found = true;
    add_works(entry.info.reference, keys, text);
  }
  const auto is_named = [&](const MethodEntry& entry) { return entry.name == name.substr(0, name.find('(')); };
  if (std::any_of(methods().begin(), methods().end(), is_named)) {
    found = true;
    add_works(describe(parse_method(name)).reference, keys, text);
  }
  return found ? text : "";
}

std::string bibtex_of(const Scenario& scenario) {
  std::vector<std::string> keys;
  std::string text = hamflow_entry();
  add_works(describe(scenario.request.method).reference, keys, text);
  add_works(scenario.problem->info.reference, keys, text);
  return text;
}

}  // namespace hamflow
