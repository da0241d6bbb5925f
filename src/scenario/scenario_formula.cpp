// [problem] with a typed Hamiltonian: `formula`, and `central-force` with potential = "formula". The texts are checked and
// become an entry of the catalogue; everything after that is as for any problem.
#include <algorithm>

#include "formula_keys.hpp"
#include "scenario_reader.hpp"

namespace hamflow {

namespace {

/// The texts of a table of formulas, { L = "x*p_y - y*p_x" }, in the order of the file.
std::vector<std::pair<std::string, std::string>> named_texts(TomlTable table) {
  std::vector<std::pair<std::string, std::string>> all;
  for (const std::string& name : table.keys()) {
    if (const auto text = table.text({.name = name, .type = OptionType::text})) all.emplace_back(name, *text);
  }
  table.finish();
  return all;
}

}  // namespace

bool is_typed_problem(TomlTable& table, const std::string& name) {
  if (name == FormulaKeys::problem) return true;
  return name == central_formula().problem && table.plain_string(central_formula().key) == FormulaKeys::problem;
}

/// Parameters with names of the user.
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

/// The keys of `formula`; nothing where they are incomplete, which is complained about.
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
  const std::string allowed = std::string("either ") + Keys::hamiltonian + ", or " + Keys::kinetic + " and " +
                              Keys::potential;
  if (whole && parts) {
    const char* const part = table.has(Keys::kinetic) ? Keys::kinetic : Keys::potential;
    table.complain(part, std::string("found ") + part + " beside " + Keys::hamiltonian + "; allowed " + allowed);
  } else if (!whole && table.has(Keys::kinetic) != table.has(Keys::potential)) {
    const char* const other = table.has(Keys::kinetic) ? Keys::potential : Keys::kinetic;
    table.missing(other, allowed);
  } else if (!whole && !parts) {
    table.missing(Keys::hamiltonian, allowed);
  }
  table.know_all({Keys::invariants, Keys::constraints});
  if (table.has(Keys::invariants)) texts.invariants = named_texts(table.table(Keys::invariants));
  texts.constraints = table.texts(Keys::constraints).value_or(texts.constraints);
  if (complaints_.size() != before) return std::nullopt;
  return texts;
}

/// The entry of what was typed.
void ScenarioReader::read_typed_problem(TomlTable& table, const std::string& name) {
  Request& request = scenario_.request;
  try {
    if (name == FormulaKeys::problem) {
      const auto texts = read_formula_texts(table);
      if (!texts) return;
      request.parameters = texts->parameters;
      request.variant = formula_choices(*texts);
    } else {
      (void)table.plain_string(central_formula().key);
      const auto potential = table.text({.name = FormulaKeys::central_potential, .type = OptionType::text, .required = true});
      request.parameters = read_typed_parameters(table);
      const std::vector<std::string> words = choices_of_key(name, FormulaKeys::coordinates);
      const auto chart = table.text(
          {.name = FormulaKeys::coordinates, .default_value = "cartesian", .type = OptionType::word, .words = words});
      if (!potential || (table.has(FormulaKeys::coordinates) && !chart)) return;
      request.variant = central_formula_choices(*potential, request.parameters, chart.value_or("cartesian"));
    }
    scenario_.problem = &find_problem(name, request.variant);
  } catch (const FormulaError& error) {
    table.complain_in(error.key, error.what());
  } catch (const Error& error) {
    table.complain("name", error.what());
  }
}

}  // namespace hamflow
