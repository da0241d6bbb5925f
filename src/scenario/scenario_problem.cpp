// Reads [problem]: the choice of the problem and its parameters.
#include <algorithm>

#include "hamflow/detail/problems/body_keys.hpp"
#include "hamflow/formula/problem_texts.hpp"
#include "hamflow/run/socket.hpp"
#include "scenario_reader.hpp"
#include "start_keys.hpp"
#include "suggested_names.hpp"

namespace hamflow {

namespace {
std::vector<std::string> problem_names() {
  std::vector<std::string> names;
  for (const ProblemEntry& entry : problems()) {
    if (std::find(names.begin(), names.end(), entry.info.name) == names.end()) names.push_back(entry.info.name);
  }
  return names;
}
const OptionInfo& problem_name_key() {
  static const OptionInfo key{.name = "name",
                              .meaning = "name of the problem",
                              .type = OptionType::word,
                              .required = true,
                              .words = problem_names()};
  return key;
}

/// Returns whether an entry of the catalogue has this key, apart from the keys that select the entry.
bool has_key(const ProblemInfo& info, const std::string& key) {
  if (find_option(keys_of(info), key) != nullptr) return true;
  if (!info.frame.name.empty() && key == info.frame.name) return true;
  if (!info.start_key.empty()) {
    return key == info.start_key || std::any_of(info.starts.begin(), info.starts.end(), [&](const StartInfo& start) {
             return std::find(start.keys.begin(), start.keys.end(), key) != start.keys.end();
           });
  }
  return (key == "orbit" && !info.starts.empty()) || (key == "bodies" && info.two_bodies);
}

/// Returns whether any problem has this key in [problem].
bool is_problem_key(const std::string& key) {
  const WallKeys& walls = wall_keys();
  for (const std::string& each :
       {std::string("initial"), walls.walls.name, walls.wall_rule.name, walls.strength.name, walls.exponent.name}) {
    if (key == each) return true;
  }
  const auto has = [&](const ProblemEntry& entry) {
    return has_key(entry.info, key) || !choice_of(entry.info, key).empty();
  };
  return std::any_of(problems().begin(), problems().end(), has) ||
         std::any_of(typed_examples().begin(), typed_examples().end(), has);
}

/// Returns the choices of a problem that allow a key which the chosen ones do not allow: 'with potential = "power"';
/// empty if there are none.
std::string other_choices_with(const std::string& name, const Choices& chosen, const std::string& key) {
  for (const auto& entries : {problems(), typed_examples()}) {
    for (const ProblemEntry& entry : entries) {
      const OptionInfo* const option = entry.info.name == name ? find_option(entry.info.keys, key) : nullptr;
      if (option != nullptr && !option->condition.empty()) return option->condition;
    }
  }
  std::vector<std::string> selecting;
  std::map<std::string, std::vector<std::string>> values;  // values of each selecting key that allow the key
  for (const ProblemEntry& entry : problems()) {
    if (entry.info.name != name || !has_key(entry.info, key)) continue;
    for (const auto& [choice, value] : entry.info.variant) {
      std::vector<std::string>& list = values[choice];
      if (list.empty()) selecting.push_back(choice);
      const std::string text = "\"" + value + "\"";
      if (std::find(list.begin(), list.end(), text) == list.end()) list.push_back(text);
    }
  }
  for (const std::string& choice : selecting) {
    const auto here = chosen.find(choice);
    const std::vector<std::string>& list = values[choice];
    const std::string text = here == chosen.end() ? "" : "\"" + here->second + "\"";
    if (std::find(list.begin(), list.end(), text) == list.end()) return "with " + choice + " = " + joined(list, " or ");
  }
  return "";
}
}  // namespace

void ScenarioReader::read_problem(TomlTable& table) {
  const OptionInfo& key = problem_name_key();
  const std::string given = table.plain_string(key.name).value_or("");
  if (!given.empty() && !refused_value(key, given).empty()) {
    const std::string meant = suggested_problem(given);
    table.complain(key.name, "found \"" + given + "\"; allowed " + allowed_text(key) + meant);
    const std::string near = nearest(given, problem_names());
    if (meant == "; did you mean " + near + "?") read_without_variant(table, near);
    return;
  }
  const auto name = table.text(key);
  if (!name) {
    for (const std::string& other : table.has(key.name) ? std::vector<std::string>() : table.keys()) {
      if (is_problem_key(other) || nearest(other, std::vector<std::string>{key.name}).empty()) continue;
      table.complain(other, "found an unknown key; allowed " + key.name +
                                " and the keys of that problem; did you mean " + key.name + "?");
    }
    return;
  }
  scenario_.request.problem = *name;
  const std::shared_ptr<const ProblemEntry> listed = find_problem(*name, {});
  const bool typed = listed->structure || has_typed_choice(table, listed->info);
  const bool particles = static_cast<bool>(listed->particles);
  if (particles) {
    read_gas(table);
  } else if (typed) {
    read_typed_problem(table, *listed);
  } else if (*name == SocketKeys::problem) {
    read_address(table);
  } else {
    read_variant(table, *name);
  }
  if (scenario_.problem == nullptr) {
    if (!particles) read_without_variant(table, *name);  // read_gas() has reported all errors of a gas
    return;
  }
  const std::size_t before = complaints_.size();
  const ProblemInfo& info = scenario_.problem->info;
  if (takes_body_list(info)) read_body_list(table);
  for (const ParameterInfo& parameter : info.parameters) {
    if (scenario_.request.parameters.contains(parameter.name)) continue;  // already read together with the entry
    if (const auto text = table.text(parameter, " (" + parameter.meaning + ")")) {
      scenario_.request.parameters[parameter.name] = *text;
    }
  }
  scenario_.request.parameters = complete(info, scenario_.request.parameters);
  if (!info.start_key.empty()) {
    read_numbered_start(table);
  } else if (!info.starts.empty()) {
    read_orbit(table);
  } else if (typed && table.has("orbit") && scenario_.problem->structure->time) {
    table.complain("orbit", table.found("orbit") + "; allowed with a " + FormulaKeys::central_potential +
                                " without t, because in a time-dependent field an orbit does not keep its energy");
    table.know("orbit");
  }
  if (info.two_bodies) read_bodies(table);
  read_initial(table);
  read_frame(table);
  read_walls(table);
  for (const std::string& other : table.unknown_keys()) {
    const std::string with = other_choices_with(*name, scenario_.request.variant, other);
    if (with.empty()) continue;
    table.complain(other, table.found(other) + "; allowed " + with);
    table.know(other);
  }
  table.finish();
  if (complaints_.size() == before) check_parameters(table, false);
  if (complaints_.size() == before) check_start(table);
}

/// Reads the address, which chooses the entry of the problem `socket`.
void ScenarioReader::read_address(TomlTable& table) {
  const OptionInfo& key = *find_option(socket_options(), SocketKeys::address);
  const auto address = table.text(key);
  if (!address) return;
  if (const std::string why_not = refused_address(*address); !why_not.empty()) {
    table.complain(key.name, why_not);
    return;
  }
  scenario_.request.variant[key.name] = *address;
  scenario_.problem = find_problem(scenario_.request.problem, scenario_.request.variant);
}

void ScenarioReader::check_parameters(TomlTable& table, bool start_is_known) {
  const ProblemEntry& problem = *scenario_.problem;
  const Texts& parameters = scenario_.request.parameters;
  // Parameters that follow from the start are not known yet.
  for (const StartInfo& start : problem.info.starts) {
    const bool this_one = scenario_.request.start.geometric() && start.kind == scenario_.request.start.kind;
    if (this_one && !start.derives.empty() && !start_is_known) return;
  }
  const auto [key, message] = problem.refused_parameters(parameters);
  if (message.empty()) return;
  if (key.empty()) {
    table.complain("name", "found parameters that do not fit together; allowed: " + message);
  } else if (key.find('.') != std::string::npos) {  // the message about a key of a subtable already says what was found
    table.complain_in(key, message);
  } else {
    table.complain(key, table.found(key) + "; " + message);
  }
}

/// Called if the variant or the name is wrong, which has been reported. Complains about all keys that are wrong for
/// every variant, so that the user sees all errors at once.
void ScenarioReader::read_without_variant(TomlTable& table, const std::string& name) {
  std::vector<std::string> seen;
  std::vector<std::string> kinds;
  std::vector<std::string> orbit_keys{"direction"};
  for (const ProblemEntry& entry : problems()) {
    if (entry.info.name != name) continue;
    for (const auto& choice : entry.info.variant) table.know(choice.first);
    for (const ParameterInfo& parameter : entry.info.parameters) {
      if (std::find(seen.begin(), seen.end(), parameter.name) != seen.end()) continue;
      seen.push_back(parameter.name);
      OptionInfo optional = parameter;  // whether it is required is unknown
      optional.required = false;
      (void)table.text(optional, " (" + parameter.meaning + ")");
    }
    if (!entry.info.frame.name.empty()) (void)table.text(entry.info.frame);
    for (const StartInfo& start : entry.info.starts) {
      if (std::find(kinds.begin(), kinds.end(), start.kind) == kinds.end()) kinds.push_back(start.kind);
      orbit_keys.insert(orbit_keys.end(), start.keys.begin(), start.keys.end());
    }
  }
  table.know_all({"name", "initial"});
  const WallKeys& walls = wall_keys();
  table.know_all({walls.walls.name, walls.wall_rule.name, walls.strength.name, walls.exponent.name});
  if (!kinds.empty() && table.has("orbit")) {
    TomlTable orbit = table.table("orbit");
    (void)orbit.text(kind_key(kinds));
    for (const std::string& key : orbit_keys) {
      if (orbit.has(key)) (void)orbit.text(number_key(key));
    }
    orbit.know_all(orbit_keys);
    orbit.finish();
  }
  table.know("orbit");
  table.finish();
}

namespace {
/// Returns the other choice that allows a selecting key: 'with coordinates = "cartesian"'.
std::string where_allowed(const std::string& name, const std::string& key) {
  for (const ProblemEntry& entry : problems()) {
    if (entry.info.name != name || choice_of(entry.info, key).empty()) continue;
    const std::string chart = choice_of(entry.info, FormulaKeys::coordinates);
    if (!chart.empty()) return std::string("with ") + FormulaKeys::coordinates + " = \"" + chart + "\"";
  }
  return "for other problems";
}

/// Returns the keys that select among the entries of one name, with their words and defaults. A key without a default
/// is required.
const std::vector<OptionInfo>& selecting_keys(const std::string& name) {
  static const std::map<std::string, std::vector<OptionInfo>> all = [] {
    std::map<std::string, std::vector<OptionInfo>> found;
    for (const ProblemEntry& entry : problems()) {
      std::vector<OptionInfo>& keys = found[entry.info.name];
      for (const auto& [key, value] : entry.info.variant) {
        const auto named = [&key = key](const OptionInfo& option) { return option.name == key; };
        const auto at = std::find_if(keys.begin(), keys.end(), named);
        OptionInfo& option =
            at != keys.end() ? *at : keys.emplace_back(OptionInfo{.name = key, .type = OptionType::word});
        if (std::find(option.words.begin(), option.words.end(), value) == option.words.end()) {
          option.words.push_back(value);
        }
        const auto& usual = entry.info.default_choices;
        if (std::find(usual.begin(), usual.end(), key) != usual.end()) option.default_value = value;
      }
    }
    for (auto& [name_of_keys, keys] : found) {
      const std::string& typed = find_problem(name_of_keys, {})->info.typed_choice;
      for (OptionInfo& option : keys) {
        if (option.name == typed) option.words.emplace_back(FormulaKeys::problem);
      }
    }
    return found;
  }();
  return all.at(name);
}
}  // namespace

/// Returns the values of a selecting key.
std::vector<std::string> ScenarioReader::choices_of_key(const std::string& name, const std::string& key) {
  return find_option(selecting_keys(name), key)->words;
}

void ScenarioReader::read_variant(TomlTable& table, const std::string& name) {
  bool complete_choice = true;
  for (const OptionInfo& option : selecting_keys(name)) {
    const std::string& key = option.name;
    if (!table.has(key)) {
      table.know(key);
      if (!option.default_value.empty()) {
        scenario_.request.variant[key] = option.default_value;
      } else {
        table.missing(key, joined(option.words));
        complete_choice = false;
      }
      continue;
    }
    const auto chosen = table.text(option);
    if (chosen) {
      scenario_.request.variant[key] = *chosen;
    } else {
      complete_choice = false;
    }
  }
  if (!complete_choice) return;
  try {
    scenario_.problem = find_problem(name, scenario_.request.variant);
  } catch (const Error& error) {
    table.complain("name", error.what());
    return;
  }
  // Not every entry has every selecting key. A key without effect is refused.
  Choices chosen;
  for (const OptionInfo& option : selecting_keys(name)) {
    const std::string& key = option.name;
    const std::string value = choice_of(scenario_.problem->info, key);
    if (!value.empty()) {
      chosen[key] = value;
    } else if (table.has(key)) {
      table.complain(key, table.found(key) + "; allowed " + where_allowed(name, key));
    }
  }
  scenario_.request.variant = chosen;
}

}  // namespace hamflow
