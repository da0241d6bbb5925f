// Reads [problem] with a typed Hamiltonian: `formula`, and `central-force` with potential = "formula". The formulas are
// checked and become an entry of the catalogue, which is then used like any other problem.
#include <algorithm>
#include <cctype>
#include <set>
#include <utility>

#include "column_names.hpp"
#include "hamflow/detail/run/formula_options.hpp"
#include "hamflow/run/state_names.hpp"
#include "scenario_reader.hpp"

namespace hamflow {

namespace {

/// Returns the texts of a table of formulas, { L = "x*p_y - y*p_x" }, in the order of the file.
std::vector<std::pair<std::string, std::string>> named_texts(TomlTable table) {
  std::vector<std::pair<std::string, std::string>> all;
  for (const std::string& name : table.keys()) {
    if (const auto text = table.text({.name = name, .type = OptionType::text})) all.emplace_back(name, *text);
  }
  table.finish();
  return all;
}

/// Returns whether two problems differ only in values of parameters that the choices of the first do not contain.
bool have_same_choices(const FormulaTexts& one, const Choices& choices, const FormulaTexts& other) {
  const auto same_parameter = [&](const std::string& name, const std::string& text) {
    const auto there = other.parameters.find(name);
    if (there == other.parameters.end()) return false;
    if (formula_texts(choices).parameters.at(name).find(FormulaKeys::unknown) == std::string::npos) {
      return text == there->second;
    }
    const auto is_list = [](const std::string& any) { return any.starts_with("["); };
    return is_list(text) == is_list(there->second) && list_parts(text).size() == list_parts(there->second).size();
  };
  return one.coordinates == other.coordinates && one.momenta == other.momenta && one.hamiltonian == other.hamiltonian &&
         one.kinetic == other.kinetic && one.potential == other.potential && one.invariants == other.invariants &&
         one.constraints == other.constraints && one.constraint_form == other.constraint_form &&
         one.parameters.size() == other.parameters.size() &&
         std::all_of(one.parameters.begin(), one.parameters.end(),
                     [&](const auto& parameter) { return same_parameter(parameter.first, parameter.second); });
}

/// Returns the choices of a typed problem. It keeps the last result, because a sweep reads its members one after the
/// other.
const Choices& remembered_choices(const FormulaTexts& texts) {
  thread_local FormulaTexts last;
  thread_local Choices found;
  if (found.empty() || !have_same_choices(last, found, texts)) {
    found = formula_choices(texts);
    last = texts;
  }
  return found;
}

}  // namespace

bool has_typed_choice(TomlTable& table, const ProblemInfo& info) {
  return !info.typed_choice.empty() && table.plain_string(info.typed_choice) == FormulaKeys::problem;
}

/// Reads parameters whose names the user has chosen.
Texts ScenarioReader::read_typed_parameters(TomlTable& table) {
  Texts all;
  if (!table.has(FormulaKeys::parameters)) {
    table.know(FormulaKeys::parameters);
    return all;
  }
  TomlTable parameters = table.table(FormulaKeys::parameters);
  for (const std::string& name : parameters.keys()) {
    if (const auto text = parameters.text({.name = name, .type = OptionType::number_or_list})) all[name] = *text;
  }
  parameters.finish();
  return all;
}

namespace {
/// Appends all texts of a part of the document.
void collect_texts(const toml::node& node, std::string& all) {
  if (const auto* const text = node.as_string()) all += " " + text->get();
  if (const auto* const table = node.as_table()) {
    for (const auto& [key, value] : *table) collect_texts(value, all);
  }
  if (const auto* const array = node.as_array()) {
    for (const auto& value : *array) collect_texts(value, all);
  }
}
std::set<std::string> words_of(const std::string& text) {
  std::set<std::string> words;
  std::string word;
  for (const char c : text + " ") {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_') {
      word += c;
    } else {
      words.insert(std::exchange(word, {}));
    }
  }
  return words;
}
}  // namespace

/// Refuses parameters that no formula uses, because a misspelt name would otherwise silently have no effect.
void ScenarioReader::refuse_unused_parameters(TomlTable& table, const FormulaTexts& texts) {
  std::string all = texts.hamiltonian + " " + texts.kinetic + " " + texts.potential;
  for (const std::string& coordinate : texts.coordinates) all += " " + coordinate;
  for (const auto& [name, text] : texts.invariants) all += " " + text;
  for (const std::string& text : texts.constraints) all += " " + text;
  for (const char* const part : {"run", "output"}) {  // sections and observables
    if (const toml::node* const node = document_.get(part)) collect_texts(*node, all);
  }
  const std::set<std::string> words = words_of(all);
  std::vector<std::string> used;
  for (const auto& [name, text] : texts.parameters) {
    if (words.contains(name)) used.push_back(name);
  }
  for (const auto& [name, text] : texts.parameters) {
    if (words.contains(name)) continue;
    const std::vector<std::string> candidates(words.begin(), words.end());
    table.complain_in(
        std::string(FormulaKeys::parameters) + "." + name,
        "found a parameter that no formula uses" + suggestion(name, used.empty() ? candidates : used) +
            "; allowed parameters that H, an invariant, a constraint, a section, an event or an observable uses");
  }
}

/// Notes coordinates that do not move: dq/dt = dH/dp is 0 if H does not contain p. Arrays such as p_x[i] are not
/// checked.
void ScenarioReader::note_constant_coordinates(const FormulaTexts& texts) {
  const StateNames names = state_names(*scenario_.problem, texts.parameters, scenario_.problem->dimension);
  const std::set<std::string> words = words_of(texts.hamiltonian + " " + texts.kinetic);
  if (!texts.constraints.empty()) return;
  for (std::size_t i = 0; i < names.p.size(); ++i) {
    if (names.p[i].find('[') != std::string::npos || words.contains(names.p[i])) continue;
    scenario_.notes.push_back("H does not contain " + names.p[i] + ", so " + names.q[i] + " does not move");
  }
}

/// Checks the names of invariants, which become columns of the run.
void ScenarioReader::check_invariant_names(TomlTable& table, const FormulaTexts& texts) {
  if (texts.invariants.empty()) return;
  TomlTable names = table.table(FormulaKeys::invariants);
  const std::vector<std::string> taken =
      columns_of_every_run(*scenario_.problem, texts.parameters, scenario_.problem->dimension);
  for (const auto& [name, text] : texts.invariants) {
    if (const std::string why_not = refused_column(name, taken); !why_not.empty()) names.complain(name, why_not);
  }
}

/// Reads the keys of `formula`. If they are incomplete, it complains and returns nullopt.
std::optional<FormulaTexts> ScenarioReader::read_formula_texts(TomlTable& table) {
  using Keys = FormulaKeys;
  const std::size_t before = complaints_.size();
  FormulaTexts texts;
  if (!table.has(Keys::coordinates)) {
    table.know(Keys::coordinates);
    table.missing(Keys::coordinates, "an array of names, such as [\"x\", \"y\"]");
  }
  texts.coordinates = table.texts(Keys::coordinates).value_or(texts.coordinates);
  texts.momenta = table.texts(Keys::momenta).value_or(texts.momenta);
  texts.parameters = read_typed_parameters(table);
  const auto formula = [&](const char* key) {
    return table.text({.name = key, .type = OptionType::text}).value_or("");
  };
  texts.hamiltonian = formula(Keys::hamiltonian);
  texts.kinetic = formula(Keys::kinetic);
  texts.potential = formula(Keys::potential);
  const bool whole = table.has(Keys::hamiltonian);
  const bool parts = table.has(Keys::kinetic) || table.has(Keys::potential);
  const std::string allowed =
      std::string("either ") + Keys::hamiltonian + ", or " + Keys::kinetic + " and " + Keys::potential;
  if (whole && parts) {
    const char* const part = table.has(Keys::kinetic) ? Keys::kinetic : Keys::potential;
    table.complain(part, std::string("found ") + part + " together with " + Keys::hamiltonian + "; allowed " + allowed);
  } else if (!whole && table.has(Keys::kinetic) != table.has(Keys::potential)) {
    const char* const other = table.has(Keys::kinetic) ? Keys::potential : Keys::kinetic;
    table.missing(other, allowed);
  } else if (!whole && !parts) {
    table.missing(Keys::hamiltonian, allowed);
  }
  table.know_all({Keys::invariants, Keys::constraints});
  if (table.has(Keys::invariants)) texts.invariants = named_texts(table.table(Keys::invariants));
  if (table.has_any(Keys::constraints)) {
    texts.constraints = table.texts(Keys::constraints).value_or(texts.constraints);
  }
  const auto form = table.text(constraint_form_option());
  if (!texts.constraints.empty()) {
    texts.constraint_form = form.value_or("");
  } else if (table.has(Keys::constraint_form) && !table.has(Keys::constraints)) {
    table.complain(Keys::constraint_form, table.found(Keys::constraint_form) + "; allowed with " + Keys::constraints);
  }
  if (complaints_.size() != before) return std::nullopt;
  return texts;
}

namespace {
/// Returns the formula of a key such as "kinetic" or "invariants.L"; null if the key has none.
std::string* formula_at(FormulaTexts& texts, const std::string& key) {
  using Keys = FormulaKeys;
  if (key == Keys::hamiltonian) return &texts.hamiltonian;
  if (key == Keys::kinetic) return &texts.kinetic;
  if (key == Keys::potential) return &texts.potential;
  for (auto& [name, text] : texts.invariants) {
    if (key == std::string(Keys::invariants) + "." + name) return &text;
  }
  return nullptr;
}
}  // namespace

/// Complains about further wrong formulas. It replaces each wrong formula by "0" and checks again, until none is wrong.
void ScenarioReader::report_other_formulas(TomlTable& table, FormulaTexts texts, std::string wrong) {
  const std::string right = "0";
  for (;;) {
    std::string* const formula = formula_at(texts, wrong);
    if (formula == nullptr || *formula == right) return;
    *formula = right;
    try {
      (void)formula_choices(texts);
      return;
    } catch (const FormulaError& next) {
      wrong = next.key;
      const std::string* const other = formula_at(texts, wrong);
      if (other != nullptr && *other != right) table.complain_in(wrong, next.what());
    }
  }
}

/// Makes the catalogue entry of a typed problem.
void ScenarioReader::read_typed_problem(TomlTable& table, const ProblemEntry& listed) {
  Request& request = scenario_.request;
  const std::string& name = listed.info.name;
  const bool whole = listed.structure.has_value();
  std::optional<FormulaTexts> texts;
  try {
    if (whole) {
      texts = read_formula_texts(table);
      if (!texts) return;
      request.parameters = texts->parameters;
      request.variant = remembered_choices(*texts);
    } else {
      (void)table.plain_string(listed.info.typed_choice);
      const auto potential = table.text(*find_option(central_formula_options(), FormulaKeys::central_potential));
      request.parameters = read_typed_parameters(table);
      const std::vector<std::string> words = choices_of_key(name, FormulaKeys::coordinates);
      const auto chart = table.text(
          {.name = FormulaKeys::coordinates, .default_value = "cartesian", .type = OptionType::word, .words = words});
      if (!potential || (table.has(FormulaKeys::coordinates) && !chart)) return;
      request.variant = central_formula_choices(*potential, request.parameters, chart.value_or("cartesian"));
      FormulaTexts typed;
      typed.potential = *potential;
      typed.parameters = request.parameters;
      texts = typed;
    }
    scenario_.problem = find_problem(name, request.variant);
    if (texts) check_invariant_names(table, *texts);
    if (texts) refuse_unused_parameters(table, *texts);
    if (whole) note_constant_coordinates(*texts);
    if (whole && scenario_.problem->structure->time) {
      driven_hamiltonian_ =
          !texts->hamiltonian.empty() ? texts->hamiltonian : "(" + texts->kinetic + ") + (" + texts->potential + ")";
    }
  } catch (const FormulaError& error) {
    table.complain_in(error.key, error.what());
    if (texts) report_other_formulas(table, *texts, error.key);
  } catch (const Error& error) {
    table.complain("name", error.what());
  }
}

}  // namespace hamflow
