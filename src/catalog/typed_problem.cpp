#include "typed_problem.hpp"

#include <deque>
#include <mutex>

namespace hamflow {

namespace {

using Keys = FormulaKeys;

ParameterInfo parameter_info(const std::string& name, const std::string& text) {
  const bool list = !text.empty() && text.front() == '[';
  ParameterInfo info{.name = name, .meaning = list ? "a list" : "a number", .required = true};
  if (list) {
    info.type = OptionType::list;
    info.length = list_parts(text).size();
  }
  return info;
}

/// Of the problem `formula`.
ProblemEntry formula_entry(const Choices& choices) {
  const FormulaTexts texts = formula_texts(choices);
  const auto model = std::make_shared<const formula::Model>(texts);
  ProblemEntry entry = entry_of_model(model);
  entry.info.name = Keys::problem;
  entry.info.formula =
      "H = " + (texts.hamiltonian.empty() ? texts.kinetic + " + " + texts.potential : texts.hamiltonian);
  entry.info.reference = "typed";
  for (const auto& [key, text] : choices) {
    entry.info.variant.emplace_back(key, text);
    entry.info.example_choices.push_back(key);
  }
  entry.info.coordinates = model->coordinates();
  for (const auto& [name, text] : texts.parameters) entry.info.parameters.push_back(parameter_info(name, text));
  for (const auto& [name, text] : texts.invariants) entry.info.invariants.push_back({name, text});
  return entry;
}

}  // namespace

bool is_typed(const std::string& name, const Choices& choices) { return name == Keys::problem && !choices.empty(); }

const ProblemEntry& typed_problem(const std::string& name, const Choices& choices) {
  static std::mutex mutex;
  static std::map<Choices, std::shared_ptr<const ProblemEntry>> known;
  Choices key = choices;
  key["problem"] = name;
  const std::scoped_lock lock(mutex);
  std::shared_ptr<const ProblemEntry>& entry = known[key];
  if (!entry) entry = std::make_shared<const ProblemEntry>(formula_entry(choices));
  return *entry;
}

ProblemEntry formula_example() {
  FormulaTexts texts;
  texts.coordinates = {"x", "y"};
  texts.hamiltonian = "(p_x^2 + p_y^2)/(2*m) + k*(x^2 + y^2)/2 + x^2*y";
  texts.parameters = {{"k", "1"}, {"m", "1"}};
  ProblemEntry entry = formula_entry(formula_choices(texts));
  for (ParameterInfo& parameter : entry.info.parameters) {
    parameter.required = false;
    parameter.default_value = texts.parameters.at(parameter.name);
  }
  entry.info.region = {.centre = {0.1, -0.15, 0.2, 0.15}, .spread = 0.05};
  return entry;
}

}  // namespace hamflow
