#include "choices.hpp"

#include <algorithm>
#include <set>

#include "core/text_place.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/detail/core/syntax.hpp"
#include "hamflow/detail/formula/model.hpp"
#include "names.hpp"

namespace hamflow {

namespace formula {

namespace {

using Keys = FormulaKeys;

std::string listed(const std::vector<std::string>& words) { return "[" + joined(words) + "]"; }
/// Writes "name = text; name = text".
template <class Pairs>
std::string named(const Pairs& pairs) {
  return joined(
      pairs, [](const auto& pair) { return pair.first + " = " + pair.second; }, "; ");
}
std::vector<std::pair<std::string, std::string>> pairs_of(const std::string& text) {
  std::vector<std::pair<std::string, std::string>> all;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find("; ", begin), text.size());
    const std::size_t sign = text.find(" = ", begin);
    if (sign >= end) throw Error("found \"" + text.substr(begin, end - begin) + "\"; allowed name = text");
    all.emplace_back(text.substr(begin, sign - begin), text.substr(sign + 3, end - sign - 3));
    begin = end + 2;
  }
  return all;
}

/// Removes the values of parameters that do not determine a name, an index or a sum.
Texts without_values(const Texts& parameters, const FormulaSymbols& symbols) {
  Texts all;
  for (const auto& [name, text] : parameters) {
    const bool list = !text.empty() && text.front() == '[';
    const std::string& own = name;
    const bool needed = std::any_of(symbols.known.begin(), symbols.known.end(), [&](const auto& known) {
      return known.first == own || known.first.starts_with(own + "[");
    });
    if (needed) {
      all[name] = text;
    } else if (list) {
      all[name] = listed(std::vector<std::string>(list_parts(text).size(), Keys::unknown));
    } else {
      all[name] = Keys::unknown;
    }
  }
  return all;
}

}  // namespace

Choices choices_of(const FormulaTexts& texts) {
  Choices all;
  const auto put = [&](const char* key, const std::string& text) {
    if (!text.empty()) all[key] = text;
  };
  put(Keys::coordinates, listed(texts.coordinates));
  if (!texts.momenta.empty()) put(Keys::momenta, listed(texts.momenta));
  put(Keys::hamiltonian, texts.hamiltonian);
  put(Keys::kinetic, texts.kinetic);
  put(Keys::potential, texts.potential);
  put(Keys::parameters, named(texts.parameters));
  put(Keys::invariants, named(texts.invariants));
  if (texts.constraints.empty()) return all;
  put(Keys::constraints, joined(texts.constraints, "; "));
  put(Keys::constraint_form, texts.constraint_form.empty() ? Keys::manifold : texts.constraint_form);
  return all;
}

}  // namespace formula

Choices formula_choices(const FormulaTexts& texts) {
  for (const auto& [name, text] : texts.invariants) {
    if (text.find(';') == std::string::npos && name.find_first_of(";=") == std::string::npos) continue;
    throw FormulaError(std::string(FormulaKeys::invariants) + "." + name,
                       "found ';' or '=' in an invariant; allowed a name and a formula");
  }
  for (std::size_t k = 0; k < texts.constraints.size(); ++k) {
    if (texts.constraints[k].find(';') == std::string::npos) continue;
    throw FormulaError(std::string(FormulaKeys::constraints) + "[" + std::to_string(k) + "]",
                       "found ';' in a constraint; allowed a formula that the motion keeps at 0");
  }
  const formula::Model model(texts);  // throws if a text is wrong
  FormulaTexts kept = texts;
  kept.parameters = formula::without_values(texts.parameters, model.symbols());
  return formula::choices_of(kept);
}

Choices central_formula_choices(const std::string& potential, const Texts& parameters, const std::string& coordinates,
                                const CentralUse& use) {
  for (const char* taken : {"r", "x", "y", "phi", "p_r", "p_x", "p_y", "p_phi", CentralKeys::mass}) {
    if (!parameters.contains(taken)) continue;
    throw FormulaError(
        std::string(FormulaKeys::parameters) + "." + taken,
        std::string("found the name ") + taken + ", which " + use.owner + " has itself; allowed another name");
  }
  // V is checked first, so that errors point into the typed text.
  const formula::ProblemNames names = formula::names_of({.coordinates = {"r"}, .parameters = parameters});
  FormulaSymbols symbols = formula::symbols_of(names);
  symbols.names[1] = "t";  // V contains no momentum
  symbols.names.erase(symbols.names.begin() + (use.has_time ? 2 : 1), symbols.names.begin() + 3);
  symbols.what = "names of V(r)";
  std::set<std::string> needed;
  try {
    formula::Graph graph;
    (void)formula::read_into(graph, potential, symbols, &needed);
  } catch (const Error& error) {
    throw FormulaError(FormulaKeys::central_potential, error.what());
  }
  std::erase_if(symbols.known, [&](const auto& known) { return !needed.contains(known.first); });
  const Choices all{{CentralKeys::key, FormulaKeys::problem},
                    {FormulaKeys::coordinates, coordinates},
                    {FormulaKeys::central_potential, potential},
                    {FormulaKeys::parameters, formula::named(formula::without_values(parameters, symbols))}};
  FormulaTexts texts = central_formula_texts(all);
  try {
    (void)formula::Model(texts);
  } catch (const FormulaError& error) {
    throw FormulaError(FormulaKeys::central_potential, error.what());
  }
  return all;
}

FormulaTexts central_formula_texts(const Choices& choices) {
  const std::string potential = "let r = sqrt(x^2 + y^2) in " + choices.at(FormulaKeys::central_potential);
  FormulaTexts texts;
  if (choices.at(FormulaKeys::coordinates) == CentralKeys::polar) {
    texts = {.coordinates = {"r", "phi"},
             .hamiltonian = "(p_r^2 + p_phi^2/r^2)/(2*mass) + (" + choices.at(FormulaKeys::central_potential) + ")",
             .invariants = {{"angular_momentum", "p_phi"}}};
  } else {
    texts = {.coordinates = {"x", "y"},
             .kinetic = "(p_x^2 + p_y^2)/(2*mass)",
             .potential = potential,
             .invariants = {{"angular_momentum", "x*p_y - y*p_x"}}};
  }
  texts.parameters = {{CentralKeys::mass, FormulaKeys::unknown}};
  for (const auto& [name, text] : formula::pairs_of(choices.at(FormulaKeys::parameters))) texts.parameters[name] = text;
  return texts;
}

FormulaTexts radial_formula_texts(const Choices& choices) {
  FormulaTexts texts = central_formula_texts(choices);
  texts.coordinates = {"r"};
  texts.hamiltonian.clear();
  texts.kinetic = "p_r^2/2";
  texts.potential = choices.at(FormulaKeys::central_potential);
  texts.invariants.clear();
  return texts;
}

FormulaTexts formula_texts(const Choices& choices) {
  const auto of = [&](const char* key) {
    const auto found = choices.find(key);
    return found == choices.end() ? std::string() : found->second;
  };
  FormulaTexts texts;
  texts.coordinates = list_parts(of(FormulaKeys::coordinates));
  if (const std::string momenta = of(FormulaKeys::momenta); !momenta.empty()) texts.momenta = list_parts(momenta);
  texts.hamiltonian = of(FormulaKeys::hamiltonian);
  texts.kinetic = of(FormulaKeys::kinetic);
  texts.potential = of(FormulaKeys::potential);
  for (const auto& [name, text] : formula::pairs_of(of(FormulaKeys::parameters))) texts.parameters[name] = text;
  texts.invariants = formula::pairs_of(of(FormulaKeys::invariants));
  const std::string constraints = of(FormulaKeys::constraints);
  for (std::size_t begin = 0; begin < constraints.size();) {
    const std::size_t end = std::min(constraints.find("; ", begin), constraints.size());
    texts.constraints.push_back(constraints.substr(begin, end - begin));
    begin = end + 2;
  }
  texts.constraint_form = of(FormulaKeys::constraint_form);
  return texts;
}

FormulaTexts texts_of_hamiltonian(const std::string& hamiltonian, const Texts& parameters) {
  Syntax syntax;
  try {
    syntax = read_syntax(hamiltonian, {.characters = FormulaLimits::characters, .operations = FormulaLimits::terms});
  } catch (const Error& error) {
    throw FormulaError(FormulaKeys::hamiltonian, error.what());
  }
  FormulaTexts texts;
  texts.hamiltonian = hamiltonian;
  texts.parameters = parameters;
  std::set<std::string> locals;
  for (const SyntaxPart& part : syntax.parts) {
    if (part.kind == SyntaxPart::Kind::let || part.kind == SyntaxPart::Kind::sum) locals.emplace(part.word);
  }
  // The words are sorted by their place in the text, because in the syntax operands come before their operation.
  std::vector<std::pair<std::size_t, std::string>> words;
  for (const SyntaxPart& part : syntax.parts) {
    if (part.kind == SyntaxPart::Kind::name && !locals.contains(std::string(part.word))) {
      words.emplace_back(part.at, std::string(part.word));
    }
  }
  std::sort(words.begin(), words.end());
  std::set<std::string> all;
  for (const auto& [at, word] : words) all.insert(word);
  const auto coordinate_of = [&](const std::string& word) -> std::string {
    if (parameters.contains(word)) return {};
    if (word.starts_with("p_")) return word.substr(2);
    const bool numbered = std::all_of(word.begin() + 1, word.end(), is_digit);
    return word.starts_with('p') && numbered ? "q" + word.substr(1) : std::string();
  };
  std::map<std::string, std::string> momenta;  // by coordinate
  for (const std::string& word : all) {
    if (const std::string q = coordinate_of(word); !q.empty()) momenta[q] = word;
  }
  if (momenta.empty()) {
    throw FormulaError(
        FormulaKeys::hamiltonian,
        "found \"" + shown(hamiltonian) + "\" without a momentum; allowed names such as p, p1, p_x for them");
  }
  std::set<std::string> taken;
  for (const auto& [at, word] : words) {
    const std::string q = momenta.contains(word) ? word : coordinate_of(word);
    if (q.empty() || !taken.insert(q).second) continue;
    texts.coordinates.push_back(q);
    texts.momenta.push_back(momenta.at(q));
  }
  return texts;
}

}  // namespace hamflow
