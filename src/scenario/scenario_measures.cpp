// Reads the measured quantities of [run]: Lyapunov exponents, eigenvalues, section and events.
#include <algorithm>

#include "hamflow/detail/run/fitting_methods.hpp"
#include "hamflow/run/socket.hpp"
#include "hamflow/run/state_names.hpp"
#include "run_keys.hpp"
#include "scenario_reader.hpp"

namespace hamflow {

namespace {

/// Returns the names that a section may use: coordinates, then momenta. For bodies the numbered names q1, ..., pn are
/// added.
std::vector<std::vector<std::string>> section_names(const ProblemEntry& problem, const Texts& parameters,
                                                    std::size_t size) {
  const auto row = [](const StateNames& names) {
    std::vector<std::string> all = names.q;
    all.insert(all.end(), names.p.begin(), names.p.end());
    return all;
  };
  std::vector<std::vector<std::string>> spellings{row(state_names(problem, parameters, size))};
  if (problem.dimension == 0 && spellings[0] != row(numbered_names(size))) {
    spellings.push_back(row(numbered_names(size)));
  }
  return spellings;
}

}  // namespace

void ScenarioReader::read_measures(TomlTable& table) {
  const RunKeys& keys = run_keys();
  const std::size_t dimension = scenario_.start_q.size();
  OptionInfo lyapunov = keys.lyapunov;
  if (dimension > 0) lyapunov.range.most = static_cast<double>(2 * dimension);
  if (const auto count = table.text(lyapunov)) {
    scenario_.lyapunov = *count == "true"    ? 2 * dimension
                         : *count == "false" ? 0
                                             : static_cast<std::size_t>(number_value(*count));
  }
  scenario_.eigenvalues = table.yes_no(keys.eigenvalues).value_or(false);
  if (scenario_.lyapunov > 0) refuse_derivative(table, keys.lyapunov.name);
  if (scenario_.eigenvalues) refuse_derivative(table, keys.eigenvalues.name);
  read_section(table);
  read_events(table);
  if (const auto most = table.whole(keys.record_events)) {
    scenario_.record_events = *most;
  } else if (const auto size = static_cast<std::int64_t>(scenario_.start_q.size()); size > 10000) {
    // A row contains the whole state. For very many particles the table is limited to 1 GiB.
    scenario_.record_events = std::min<std::int64_t>(scenario_.record_events, (std::int64_t{1} << 30) / (16 * size));
  }
}

/// Refuses a key that needs derivatives of steps if these do not exist. Steps are differentiated only in double, and
/// only if each is one step of a fixed map.
void ScenarioReader::refuse_derivative(TomlTable& table, const std::string& key) {
  const OptionInfo& arithmetic = run_keys().arithmetic;
  if (scenario_.request.arithmetic != arithmetic.default_value) {
    table.complain(key, table.found(key) + " with " + arithmetic.name + " \"" + scenario_.request.arithmetic +
                            "\"; allowed with " + arithmetic.name + " = \"" + arithmetic.default_value +
                            "\", because steps are differentiated only in double");
  }
  if (scenario_.request.problem == SocketKeys::problem) {
    table.complain(key, table.found(key) + "; allowed for problems other than " + SocketKeys::problem +
                            ", because a client sends no second derivatives");
  }
  if (has_method() && describe(scenario_.request.method).halves_steps) {
    table.complain(key, table.found(key) +
                            " with a method that halves steps which do not converge; allowed without halving, because "
                            "halved steps are not differentiated");
  }
  if (has_method() && describe(scenario_.request.method).carries_copy) {
    table.complain(key, table.found(key) + " with a method that carries a second copy of the state; allowed with " +
                            or_fitting_method("", "another method", {"stv4", "cg", "rk4"}, scenario_.problem.get(),
                                              arithmetic.default_value) +
                            ", because the steps of this one are not a map of (q, p)");
  }
  if (has_method() && describe(scenario_.request.method).varies_steps) {
    table.complain(key, table.found(key) +
                            " with steps of varying size; allowed with step_control = \"fixed\", because step "
                            "lengths that depend on the state are not differentiated");
  }
  if (scenario_.problem != nullptr && !scenario_.problem->constraint_form.empty()) {
    table.complain(key,
                   table.found(key) +
                       " with constraints; allowed in coordinates without constraints, because steps on a manifold "
                       "have derivatives only along it");
  }
  const auto& structure = scenario_.problem != nullptr ? scenario_.problem->structure : std::nullopt;
  if (structure && structure->time) {
    table.complain(key, table.found(key) + " with an H that depends on t; allowed with H(q, p), because steps of " +
                            "H(q, p, t) are not differentiated");
  }
}

void ScenarioReader::read_events(TomlTable& table) {
  const std::string& list = run_keys().events.name;
  if (!table.has(list)) {
    table.know(list);
    return;
  }
  auto entries = table.tables(list, 0);
  if (!entries) return;
  const EventKeys& keys = event_keys();
  for (TomlTable& entry : *entries) {
    UserEvent event;
    event.name = entry.text(keys.name).value_or("event" + std::to_string(scenario_.events.size() + 1));
    constexpr const char* letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789";
    if (event.name.find_first_not_of(letters) != std::string::npos) {
      entry.complain(keys.name.name, "found the name \"" + event.name + "\"; allowed letters, digits and _");
    }
    const bool again = std::any_of(scenario_.events.begin(), scenario_.events.end(),
                                   [&](const UserEvent& other) { return other.name == event.name; });
    if (again) entry.complain(keys.name.name, "found the name " + event.name + " a second time; allowed another name");
    if (const auto direction = entry.whole(keys.direction)) event.zero.direction = static_cast<int>(*direction);
    event.stops = entry.text(keys.action).value_or("") == keys.action.words.back();
    event.zero.expression = read_changing_expression(entry, keys.expression);
    if (event.zero.expression) event.zero.in_digits = in_digits(*event.zero.expression);
    event.zero.by_steps = scenario_.map;
    entry.finish();
    scenario_.events.push_back(std::move(event));
  }
}

void ScenarioReader::read_section(TomlTable& table) {
  const std::string& key = run_keys().section.name;
  if (!table.has(key)) {
    table.know(key);
    return;
  }
  TomlTable section = table.table(key);
  if (!section.exists()) return;  // another check reports this
  const SectionKeys& keys = section_keys();
  Section wanted;
  if (const auto value = section.text(keys.value)) {
    wanted.value = number_value(*value);
    wanted.value_text = *value;
  }
  if (const auto direction = section.whole(keys.direction)) wanted.direction = static_cast<int>(*direction);
  wanted.by_steps = scenario_.map;
  section.know_all({keys.coordinate.name, keys.expression.name});
  if (scenario_.map && !section.has(keys.coordinate.name) && !section.has(keys.expression.name)) {
    for (const std::string& other : {keys.value.name, keys.direction.name}) {
      if (section.has(other)) {
        section.complain(other, section.found(other) + " without " + keys.coordinate.name + " or " +
                                    keys.expression.name + "; allowed with one of them");
      }
    }
    wanted.every_step = wanted.is_stroboscopic = true;
    scenario_.section = wanted;
    section.finish();
    return;
  }
  const bool by_coordinate = section.has(keys.coordinate.name);
  if (by_coordinate == section.has(keys.expression.name)) {
    const std::string names =
        scenario_.problem == nullptr || scenario_.start_q.empty()
            ? std::string()
            : " (" +
                  joined(section_names(*scenario_.problem, scenario_.request.parameters, scenario_.start_q.size())
                             .back()) +
                  ")";
    section.complain(by_coordinate ? keys.expression.name : keys.coordinate.name,
                     (by_coordinate ? "found " + keys.coordinate.name + " and " + keys.expression.name + " together"
                                    : "found neither " + keys.coordinate.name + " nor " + keys.expression.name) +
                         "; allowed one of them: a coordinate or momentum" + names + ", or an expression of them");
  } else if (scenario_.problem != nullptr && !scenario_.start_q.empty()) {
    by_coordinate ? read_section_coordinate(section, wanted) : read_section_expression(section, wanted);
  }
  section.finish();
}

void ScenarioReader::read_section_coordinate(TomlTable& section, Section wanted) {
  OptionInfo coordinate = section_keys().coordinate;
  const std::size_t dimension = scenario_.start_q.size();
  for (const auto& names : section_names(*scenario_.problem, scenario_.request.parameters, dimension)) {
    coordinate.words.insert(coordinate.words.end(), names.begin(), names.end());
  }
  const auto name = section.text(coordinate);
  if (!name) return;
  const auto place = std::find(coordinate.words.begin(), coordinate.words.end(), *name);
  const std::size_t at = static_cast<std::size_t>(place - coordinate.words.begin()) % (2 * dimension);
  wanted.coordinate = at % dimension;
  wanted.momentum = at >= dimension;
  scenario_.section = wanted;
}

namespace {
/// Returns the index in (q, p) of the first number of the state that an expression uses; `all` if it uses none.
std::size_t first_used(const StateExpression& expression, std::size_t all) {
  std::size_t first = 0;
  while (first < all && !expression.uses(first)) ++first;
  return first;
}
}  // namespace

/// Reads an expression whose zeros are located. It must not be constant.
std::optional<StateExpression> ScenarioReader::read_changing_expression(TomlTable& table, const OptionInfo& key) {
  auto expression = read_expression(table, key);
  const std::size_t all = 2 * scenario_.start_q.size();
  if (!expression || expression->uses_time() || first_used(*expression, all) < all) return expression;
  table.complain(key.name, table.found(key.name) + ", which is the same for every state; allowed an expression " +
                               "with a coordinate, a momentum or t");
  return std::nullopt;
}

void ScenarioReader::read_section_expression(TomlTable& section, Section wanted) {
  const OptionInfo& key = section_keys().expression;
  const auto expression = read_changing_expression(section, key);
  if (!expression) return;
  const std::size_t dimension = scenario_.start_q.size();
  const std::size_t first = first_used(*expression, 2 * dimension);
  wanted.is_stroboscopic = first == 2 * dimension;
  if (!wanted.is_stroboscopic) {
    wanted.coordinate = first % dimension;
    wanted.momentum = first >= dimension;
  }
  wanted.expression = expression;
  wanted.in_digits = in_digits(*expression);
  scenario_.section = wanted;
}

/// Returns the expression in arithmetic with more digits than double; empty in double.
ExpressionInDigits ScenarioReader::in_digits(const StateExpression& expression) const {
  if (digits_beyond_double(scenario_.request.arithmetic) == 0) return {};
  return expression_in_digits(expression.text(), *scenario_.problem, scenario_.request.parameters,
                              scenario_.start_q.size());
}

/// Reads an expression of the state. If it is wrong, the complaint names the column in the expression.
std::optional<StateExpression> ScenarioReader::read_expression(TomlTable& table, const OptionInfo& key) {
  const auto text = table.text(key);
  if (!text || scenario_.problem == nullptr || scenario_.start_q.empty()) return std::nullopt;
  try {
    return StateExpression(*text, *scenario_.problem, scenario_.request.parameters, scenario_.start_q.size());
  } catch (const Error& error) {
    table.complain(key.name, error.what());
    return std::nullopt;
  }
}

}  // namespace hamflow
