#include "typed_problem.hpp"

#include <stdexcept>
#include <tuple>

#include "engine/made_entries.hpp"
#include "hamflow/detail/problems/potential.hpp"
#include "hamflow/detail/run/formula_options.hpp"
#include "hamflow/problems/support/polar.hpp"
#include "typed_potential.hpp"

namespace hamflow {

namespace {

ParameterInfo parameter_info(const std::string& name, const std::string& text) {
  const bool list = !text.empty() && text.front() == '[';
  ParameterInfo info{.name = name, .meaning = list ? "a list" : "a number", .required = true};
  if (list) {
    info.type = OptionType::list;
    info.length = list_parts(text).size();
  }
  return info;
}

/// The entry of the problem `formula`.
/// @param coordinates with x[n] expanded
ProblemEntry formula_entry(const Choices& choices, const FormulaTexts& texts, const EntryModel& model,
                           const std::vector<std::string>& coordinates) {
  ProblemEntry entry = entry_of_model(model);
  entry.info.name = FormulaKeys::problem;
  entry.info.formula =
      "H = " + (texts.hamiltonian.empty() ? texts.kinetic + " + " + texts.potential : texts.hamiltonian);
  entry.info.reference = "typed";
  for (const auto& [key, text] : choices) {
    entry.info.variant.emplace_back(key, text);
    entry.info.example_choices.push_back(key);
  }
  entry.info.coordinates = coordinates;
  for (const auto& [name, text] : texts.parameters) entry.info.parameters.push_back(parameter_info(name, text));
  for (const auto& [name, text] : texts.invariants) entry.info.invariants.push_back({name, text});
  return entry;
}

/// `central-force` with potential = "formula".
ProblemEntry central_entry(const Choices& choices) {
  const FormulaTexts texts = central_formula_texts(choices);
  const bool polar = choices.at(FormulaKeys::coordinates) == CentralKeys::polar;
  const auto model = std::make_shared<const formula::Model>(texts);
  std::optional<TypedField> field;
  if (!model->structure().time)
    field = TypedField{std::make_shared<const formula::Model>(radial_formula_texts(choices)), polar};
  ProblemEntry entry = entry_of_model(model, field);
  ProblemInfo& info = entry.info;
  info.name = CentralKeys::problem;
  for (const auto& [key, text] : choices) info.variant.emplace_back(key, text);
  info.chart_key = FormulaKeys::coordinates;
  info.typed_choice = CentralKeys::key;
  info.formula = std::string("H = ") + (polar ? "(p_r^2 + p_phi^2/r^2)" : "|p|^2") +
                 "/(2 mu) + V(r), V(r) = " + choices.at(FormulaKeys::central_potential);
  info.reference = "Gross1999, (2.45)-(2.60)";
  info.coordinates = texts.coordinates;
  if (polar) info.angles = {"phi"};
  info.parameters = {
      {.name = CentralKeys::mass, .default_value = "1", .meaning = "reduced mass mu", .range = Range::positive}};
  for (const auto& [name, text] : texts.parameters) {
    if (name != CentralKeys::mass) info.parameters.push_back(parameter_info(name, text));
  }
  info.invariants = {
      {"angular_momentum", texts.invariants[0].second, Components::one, polar ? Terms::momentum : Terms::moments}};
  info.two_bodies = true;
  if (field) info.starts = {start_by_energy({{"energy", "-0.4"}, {"angular_momentum", "1"}})};
  info.example = {.q = {1, 0}, .p = {0, 1}, .dt = 0.05};
  if (polar) {
    const auto changed = [](const auto& change) {
      return [change](const Texts&, const std::vector<double>& q, const std::vector<double>& p) {
        const Start<double, 2> s = change(Start<double, 2>{{q.at(0), q.at(1)}, {p.at(0), p.at(1)}});
        Frame frame;
        frame.q = {s.q[0], s.q[1]};
        frame.p = {s.p[0], s.p[1]};
        return frame;
      };
    };
    using Polar = PolarCentralForce<double, TypedPotential>;
    entry.to_reference = changed([](const Start<double, 2>& s) { return Polar::to_reference(s); });
    entry.from_reference = changed([](const Start<double, 2>& s) { return Polar::from_reference(s); });
  }
  return entry;
}

FormulaTexts example_texts() {
  FormulaTexts texts;
  texts.coordinates = {"x", "y"};
  texts.hamiltonian = "(p_x^2 + p_y^2)/(2*m) + k*(x^2 + y^2)/2 + x^2*y";
  texts.parameters = {{"k", "1"}, {"m", "1"}};
  return texts;
}

/// The entry of typed texts. If they are those of the example, it has the region on which `verify` measures.
ProblemEntry entry_of_choices(const std::string& name, const Choices& choices) {
  if (name != FormulaKeys::problem) return central_entry(choices);
  if (choices == formula_choices(example_texts())) return formula_example();
  const FormulaTexts texts = formula_texts(choices);
  const auto model = std::make_shared<const formula::Model>(texts);
  return formula_entry(choices, texts, model, model->coordinates());
}

auto all_of(const FormulaStructure& s) {
  return std::tuple(s.separable, s.quadratic_kinetic, s.time, s.constraints, s.multiplier);
}

}  // namespace

EntryModel::EntryModel(std::shared_ptr<const formula::Model> made) {
  late_->momenta = made->momenta();
  late_->structure = made->structure();
  std::call_once(late_->once, [&] { late_->model = std::move(made); });
}

EntryModel::EntryModel(const FormulaTexts& texts, const FormulaStructure& structure) {
  late_->texts = texts;
  late_->structure = structure;
  for (const std::string& coordinate : texts.coordinates) late_->momenta.push_back("p_" + coordinate);
}

const std::shared_ptr<const formula::Model>& EntryModel::made() const {
  std::call_once(late_->once, [this] {
    auto model = std::make_shared<const formula::Model>(late_->texts);
    if (all_of(model->structure()) != all_of(structure()) || model->momenta() != momenta()) {
      throw std::logic_error("hamflow: " + model->label() + " does not have its declared structure");
    }
    late_->model = std::move(model);
  });
  return late_->model;
}

bool is_typed(const std::string& name, const Choices& choices) {
  if (name == FormulaKeys::problem) return !choices.empty();
  const auto potential = choices.find(CentralKeys::key);
  return name == CentralKeys::problem && potential != choices.end() && potential->second == FormulaKeys::problem &&
         choices.contains(FormulaKeys::central_potential);
}

std::shared_ptr<const ProblemEntry> typed_problem(const std::string& name, const Choices& choices) {
  static MadeEntries<Choices> made;
  Choices key = choices;
  key["problem"] = name;
  return made.find(key, [&] { return entry_of_choices(name, choices); });
}

ProblemEntry formula_example() {
  const FormulaTexts texts = example_texts();
  const Choices choices = formula_choices(texts);
  const FormulaTexts chosen = formula_texts(choices);
  const EntryModel model{chosen, {.separable = true, .quadratic_kinetic = true}};
  ProblemEntry entry = formula_entry(choices, chosen, model, texts.coordinates);
  for (ParameterInfo& parameter : entry.info.parameters) {
    parameter.required = false;
    parameter.default_value = texts.parameters.at(parameter.name);
  }
  entry.info.region = {.parameters = texts.parameters, .centre = {0.1, -0.15, 0.2, 0.15}, .spread = 0.05};
  entry.info.keys = formula_options();
  entry.info.example.keys = {
      {FormulaKeys::coordinates, ""}, {FormulaKeys::hamiltonian, ""}, {FormulaKeys::parameters, ""}};
  return entry;
}

std::span<const ProblemEntry> typed_examples() {
  static const std::vector<ProblemEntry> all = [] {
    const std::vector<OptionInfo>& keys = central_formula_options();
    const std::string& potential = find_option(keys, FormulaKeys::central_potential)->example;
    std::vector<ProblemEntry> entries;
    for (const char* const chart : {"cartesian", CentralKeys::polar}) {
      entries.push_back(central_entry(central_formula_choices(potential, {{"k", "1"}, {"a", "0.01"}}, chart)));
      entries.back().info.keys = keys;
      for (const OptionInfo& key : keys) entries.back().info.example.keys[key.name];
    }
    return entries;
  }();
  return all;
}

}  // namespace hamflow
