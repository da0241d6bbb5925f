#include "choices.hpp"

#include <algorithm>

#include "hamflow/core/text.hpp"
#include "hamflow/core/text_place.hpp"
#include "hamflow/formula/model.hpp"

namespace hamflow {

namespace formula {

namespace {

using Keys = FormulaKeys;

std::string listed(const std::vector<std::string>& words) { return "[" + joined(words) + "]"; }
/// name = text; name = text
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

/// The same parameters without the values that no name, index or sum needs.
Texts without_values(const Texts& parameters, const FormulaSymbols& symbols) {
  Texts all;
  for (const auto& [name, text] : parameters) {
    const bool list = !text.empty() && text.front() == '[';
    const bool needed = std::any_of(symbols.known.begin(), symbols.known.end(), [&](const auto& known) {
      return known.first == name || known.first.starts_with(name + "[");
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
  put(Keys::constraints, joined(texts.constraints, "; "));
  return all;
}

}  // namespace formula

Choices formula_choices(const FormulaTexts& texts) {
  for (const auto& [name, text] : texts.invariants) {
    if (text.find(';') == std::string::npos && name.find_first_of(";=") == std::string::npos) continue;
    throw FormulaError(std::string(FormulaKeys::invariants) + "." + name,
                       "found ';' or '=' in it; allowed a name and a formula");
  }
  const formula::Model model(texts);  // says what is wrong
  FormulaTexts kept = texts;
  kept.parameters = formula::without_values(texts.parameters, model.symbols());
  return formula::choices_of(kept);
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
  return texts;
}

}  // namespace hamflow
