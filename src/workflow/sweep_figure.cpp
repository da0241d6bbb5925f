#include "sweep_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

#include "hamflow/core/text.hpp"
#include "hamflow/run/state_names.hpp"
#include "parameter_map.hpp"
#include "run_keys.hpp"
#include "sweep_table.hpp"
#include "terminal.hpp"
#include "text.hpp"

namespace hamflow {

namespace {
constexpr std::size_t few = 8;  // values of a list that are drawn as lines

bool is_few(const Vary& vary) { return vary.numbers.empty() || (vary.is_list && vary.texts.size() <= few); }

/// Which of two keys has a line for each value: one of words, else the list of fewer values; none: a map.
std::size_t key_of_lines(const std::vector<Vary>& varied) {
  if (varied.size() < 2) return varied.size();
  const auto rank = [](const Vary& vary) {
    return vary.numbers.empty() ? 0 : is_few(vary) ? vary.texts.size() : std::numeric_limits<std::size_t>::max();
  };
  const std::size_t key = rank(varied[0]) <= rank(varied[1]) ? 0 : 1;
  return is_few(varied[key]) ? key : varied.size();
}

/// The last part of a key, and the coordinate that an entry of a start belongs to.
std::string key_label(const Sweep& sweep, const std::string& path) {
  const Scenario& scenario = sweep.common();
  const StateNames names = state_names(*scenario.problem, scenario.request.parameters, scenario.start_q.size());
  for (const auto& [key, list] : {std::pair{"problem.initial.q", &names.q}, {"problem.initial.p", &names.p}}) {
    for (std::size_t i = 0; i < list->size(); ++i) {
      if (path == fmt::format("{}[{}]", key, i)) return figures::symbol((*list)[i]) + "(0)";
    }
  }
  if (path == "method.name") return "method";
  const std::string last = path.substr(path.rfind('.') + 1);
  return last == "dt" ? "d{/:Italic t}" : figures::symbol(last);
}

/// "angular momentum at the end".
std::string invariant_label(const std::string& name) {
  const std::size_t slash = name.rfind('/');
  std::string words = name.substr(0, slash);
  std::replace(words.begin(), words.end(), '_', ' ');
  const std::string what = slash == std::string::npos ? "" : name.substr(slash + 1);
  if (what == "initial") return figures::escaped(words) + " at the start";
  if (what == "final") return figures::escaped(words) + " at the end";
  return what == "max_error" ? "largest error of " + figures::escaped(words) : figures::escaped(name);
}

std::string value_label(const Sweep& sweep, const std::string& column) {
  static const std::map<std::string, std::string> known{{"energy/initial", "{/:Italic H}_0"},
                                                        {"energy/final", "{/:Italic H} at the end"},
                                                        {"energy/max_error", "max |{/:Italic H} − {/:Italic H}_0|"},
                                                        {"energy/scale", "energy scale"},
                                                        {"final/t", "{/:Italic t} at the end"}};
  const auto found = known.find(column);
  if (found != known.end()) return found->second;
  if (column == "final/q" || column == "final/p") {
    const Scenario& scenario = sweep.common();
    const StateNames names = state_names(*scenario.problem, scenario.request.parameters, scenario.start_q.size());
    return figures::symbol(column == "final/q" ? names.q.front() : names.p.front()) + " at the end";
  }
  const std::size_t slash = column.find('/');
  const std::string name = slash == std::string::npos ? column : column.substr(slash + 1);
  if (column.starts_with("invariants/")) return invariant_label(name);
  if (name.starts_with("lyapunov")) return "Lyapunov exponent " + figures::symbol("lambda" + name.substr(8));
  std::string words = name;
  std::replace(words.begin(), words.end(), '/', ' ');
  return figures::escaped(words);
}

std::string title_of(const Sweep& sweep) {
  const Request& request = sweep.common().request;
  const auto is_varied = [&](const std::string& path) {
    return std::any_of(sweep.varied().begin(), sweep.varied().end(),
                       [&](const Vary& vary) { return vary.path == path || path.starts_with(vary.path + "."); });
  };
  std::string title = request.problem;
  if (!is_varied("method.name")) title += ", " + describe(request.method).name;
  if (!is_varied(run_path(run_keys().dt))) title += ", dt = " + request.dt;
  return title;
}

/// What the paper shows where there is no colour, or no point.
std::string note_of(const Sweep& sweep, bool map) {
  std::map<std::string, std::size_t> failed;
  std::size_t count = 0;
  for (const MemberRow& row : sweep.rows()) {
    if (row.status == Outcome::done) continue;
    ++failed[std::string(name(row.status))];
    ++count;
  }
  if (count == 0) return {};
  std::vector<std::string> parts;
  for (const auto& [status, members] : failed) parts.push_back(fmt::format("{} {}", members, status));
  return figures::escaped(
      fmt::format("{}: {} of {} members ({})", map ? "white" : "not drawn", count, sweep.members(), joined(parts)));
}

}  // namespace

std::string refused_sweep_figure(const Sweep& sweep, const std::filesystem::path& file, const std::string& colour) {
  const std::string wrong = refused_figure_file(file);
  if (!wrong.empty()) return "--figure: error: " + wrong;
  const std::vector<Vary>& varied = sweep.varied();
  if (varied.size() > 2) {
    return "--figure: error: found " + std::to_string(varied.size()) + " varied keys; allowed one or two";
  }
  const std::size_t lines = key_of_lines(varied);
  if (lines < varied.size() && varied[lines].texts.size() > most_map_lines) {
    return fmt::format("--figure: error: found {} values of {}, a line each; allowed up to {}",
                       varied[lines].texts.size(), varied[lines].path, most_map_lines);
  }
  std::vector<std::string> columns;
  for (const SweepColumn& column : columns_of(sweep)) {
    if (!column.numbers.empty() && column.width == 1) columns.push_back(column.name);
  }
  if (std::find(columns.begin(), columns.end(), colour) == columns.end()) {
    const auto whole = std::find_if(columns.begin(), columns.end(),
                                    [&](const std::string& column) { return column.ends_with("/" + colour); });
    const std::string meant = whole == columns.end() ? suggestion(colour, columns) : "; did you mean " + *whole + "?";
    const bool exponent = colour.find("lyapunov") != std::string::npos && meant.empty();
    return "--colour: error: found " + colour + "; allowed " + joined(columns) + meant +
           (exponent ? "; with run.lyapunov = 1 there is observables/lyapunov1" : "");
  }
  return {};
}

void draw_sweep_figure(const Sweep& sweep, const std::filesystem::path& file, const std::string& colour) {
  const std::vector<Vary>& varied = sweep.varied();
  const std::size_t lines = key_of_lines(varied);
  const bool map = varied.size() == 2 && lines == varied.size();
  const std::size_t over = lines == 0 ? 1 : 0;
  ParameterMap figure;
  figure.title = title_of(sweep);
  figure.value_label = value_label(sweep, colour);
  figure.x_label = key_label(sweep, varied[over].path);
  if (map) figure.y_label = key_label(sweep, varied[1].path);
  for (const SweepColumn& column : columns_of(sweep)) {
    if (column.name == colour) figure.value = column.numbers;
  }
  if (varied[over].numbers.empty()) {
    for (const std::string& text : varied[over].texts) figure.x_words.push_back(figures::escaped(text));
  }
  for (std::size_t member = 0; member < sweep.members(); ++member) {
    const std::vector<std::size_t> at = values_of_member(varied, member);
    const Vary& x = varied[over];
    figure.x.push_back(x.numbers.empty() ? static_cast<double>(at[over]) : x.numbers[at[over]]);
    if (map) figure.y.push_back(varied[1].numbers[at[1]]);
    if (lines < varied.size()) {
      const Vary& line = varied[lines];
      const std::string text = figures::escaped(line.texts[at[lines]]);
      figure.line.push_back(line.numbers.empty() ? text : key_label(sweep, line.path) + " = " + text);
    }
    // What a member that broke off reached belongs to another time than the others.
    if (sweep.rows()[member].status != Outcome::done) {
      figure.value[member] = std::numeric_limits<double>::quiet_NaN();
    }
  }
  const std::string note = note_of(sweep, map);
  if (!note.empty()) figure.notes.push_back(note);
  write_parameter_map(figure, file);
}

}  // namespace hamflow
