#include "names.hpp"

#include <algorithm>
#include <cmath>

#include "core/text_place.hpp"
#include "hamflow/core/text.hpp"

namespace hamflow::formula {

namespace {

constexpr double most_coordinates = 10'000;

std::string place(const std::string& key, std::size_t i) { return key + "[" + std::to_string(i) + "]"; }

void check_word(const std::string& key, const std::string& word) {
  if (const std::string why = refused_formula_name(word); !why.empty()) {
    throw FormulaError(key, "found " + why + "; allowed another name");
  }
}

/// Reads the value of a parameter, such as "1/3" or "[1, 2]".
ProblemNames::Parameter parameter_of(const std::string& name, const std::string& text) {
  const std::string key = std::string(FormulaKeys::parameters) + "." + name;
  check_word(key, name);
  ProblemNames::Parameter p{name, 0, {}};
  const std::vector<std::string> parts = list_parts(text);
  if (!text.empty() && text.front() == '[') {
    p.length = parts.size();
    if (parts.empty()) throw FormulaError(key, "found []; allowed a number, or a list of one or more");
  }
  try {
    for (const std::string& part : parts) {
      p.values.push_back(part == FormulaKeys::unknown ? std::nan("") : evaluate_number<double>(part));
    }
  } catch (const Error& error) {
    throw FormulaError(key, error.what());
  }
  return p;
}

/// Returns the names that a text such as "x" or "x[n]" declares.
std::vector<std::string> expanded_names(const std::string& key, const std::string& text,
                                        const FormulaSymbols& parameters, std::set<std::string>& whole) {
  const std::size_t opened = text.find('[');
  const std::string word(trimmed(std::string_view(text).substr(0, opened)));
  check_word(key, word);
  if (opened == std::string::npos) return {word};
  const std::size_t closed = text.rfind(']');
  if (closed == std::string::npos || closed < opened || !trimmed(std::string_view(text).substr(closed + 1)).empty()) {
    throw FormulaError(key, "found \"" + shown(text) + "\"; allowed a name, or name[n] for name[1] to name[n]");
  }
  double count = 0;
  try {
    const Formula f = parse_formula(std::string_view(text).substr(opened + 1, closed - opened - 1), parameters);
    std::vector<double> values;
    for (const std::string& name : parameters.names) {
      const auto known = parameters.known.find(name);
      values.push_back(known == parameters.known.end() ? std::nan("") : known->second);
    }
    for (const int symbol : f.symbols()) whole.insert(parameters.names.at(static_cast<std::size_t>(symbol)));
    count = f.evaluate<double>(std::span<const double>(values));
  } catch (const Error& error) {
    throw FormulaError(key, error.what());
  }
  if (!(count >= 1 && count <= most_coordinates) || count != std::nearbyint(count)) {
    throw FormulaError(key, "found \"" + shown(text) + "\" with " + shortest(count) +
                                "; allowed a whole number of coordinates from 1 to 10000");
  }
  std::vector<std::string> all;
  for (std::size_t i = 1; i <= static_cast<std::size_t>(count); ++i) all.push_back(place(word, i));
  return all;
}

/// Returns the default name of a momentum: p for q, p1 for q1, p_x for x.
std::string momentum_of(const std::string& coordinate) {
  return coordinate.starts_with('q') ? "p" + coordinate.substr(1) : "p_" + coordinate;
}

/// Returns the name without its index: x for x[3].
std::string word_of(const std::string& name) { return name.substr(0, name.find('[')); }

}  // namespace

ProblemNames names_of(const FormulaTexts& texts) {
  ProblemNames names;
  FormulaSymbols parameters{.what = "parameters"};
  std::set<std::string> taken;
  for (const auto& [name, text] : texts.parameters) {
    names.parameters.push_back(parameter_of(name, text));
    const ProblemNames::Parameter& p = names.parameters.back();
    taken.insert(name);
    for (std::size_t i = 0; i < std::max<std::size_t>(p.length, 1); ++i) {
      parameters.names.push_back(p.length == 0 ? name : place(name, i + 1));
      if (p.values[i] == p.values[i]) parameters.known[parameters.names.back()] = p.values[i];
    }
  }
  const auto take = [&](const std::string& key, const std::string& word) {
    if (!taken.insert(word).second) {
      throw FormulaError(key, "found the name " + word + " a second time; allowed names that differ");
    }
  };
  if (texts.coordinates.empty())
    throw FormulaError(FormulaKeys::coordinates, "missing; allowed one or more, such as [\"x\", \"y\"]");
  if (!texts.momenta.empty() && texts.momenta.size() != texts.coordinates.size()) {
    throw FormulaError(FormulaKeys::momenta, "found " + std::to_string(texts.momenta.size()) +
                                                 "; allowed as many as coordinates, " +
                                                 std::to_string(texts.coordinates.size()));
  }
  for (std::size_t i = 0; i < texts.coordinates.size(); ++i) {
    const std::string key = place(FormulaKeys::coordinates, i);
    const auto some = expanded_names(key, texts.coordinates[i], parameters, names.whole);
    take(key, word_of(some[0]));
    const std::string momentum_key = texts.momenta.empty() ? key : place(FormulaKeys::momenta, i);
    const auto their = texts.momenta.empty()
                           ? expanded_names(key, momentum_of(texts.coordinates[i]), parameters, names.whole)
                           : expanded_names(momentum_key, texts.momenta[i], parameters, names.whole);
    take(momentum_key, word_of(their[0]));
    const auto indexed = [](const std::string& name) { return name.back() == ']'; };
    if (some.size() != their.size() || indexed(some[0]) != indexed(their[0])) {
      throw FormulaError(momentum_key,
                         "found " + texts.momenta[i] + "; allowed a momentum for each of " + texts.coordinates[i]);
    }
    names.coordinates.insert(names.coordinates.end(), some.begin(), some.end());
    names.momenta.insert(names.momenta.end(), their.begin(), their.end());
    if (static_cast<double>(names.coordinates.size()) > most_coordinates) {
      throw FormulaError(FormulaKeys::coordinates, "found more than 10000; allowed at most 10000");
    }
  }
  return names;
}

FormulaSymbols symbols_of(const ProblemNames& names) {
  FormulaSymbols all{.what = "coordinates, momenta and parameters"};
  all.names = names.coordinates;
  all.names.insert(all.names.end(), names.momenta.begin(), names.momenta.end());
  all.names.emplace_back("t");
  for (const ProblemNames::Parameter& p : names.parameters) {
    for (std::size_t i = 0; i < std::max<std::size_t>(p.length, 1); ++i) {
      all.names.push_back(p.length == 0 ? p.name : place(p.name, i + 1));
      if (p.values[i] == p.values[i]) all.known[all.names.back()] = p.values[i];
    }
  }
  return all;
}

}  // namespace hamflow::formula
