#include "sweep_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>

#include "figure.hpp"
#include "figure_data.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/detail/core/option_names.hpp"
#include "hamflow/run/state_names.hpp"
#include "parameter_map.hpp"
#include "run_keys.hpp"
#include "section_text.hpp"
#include "sweep_table.hpp"
#include "terminal.hpp"
#include "text.hpp"

namespace hamflow {

namespace {
constexpr std::size_t few = 8;  // a list with at most this many values is drawn as lines
constexpr const char* usual_colour = "energy/max_error";

bool draws_section(const Sweep& sweep, const std::string& colour) { return colour.empty() && sweep.common().section; }

bool is_few(const Vary& vary) { return !vary.is_number() || (vary.is_list() && vary.count() <= few); }

/// Keys over which a column is drawn: all keys except those given by formulas of others.
struct FigureKeys {
  std::vector<std::size_t> free;
  std::size_t over = 0;  // key of the horizontal axis
  bool map = false;      // a colour map with the key `above` on the vertical axis
  std::size_t above = 0;
  bool has_lines = false;  // one line for each value of the key `lines`
  std::size_t lines = 0;
};

/// Chooses how two keys are drawn. A key of words gets one line for each value; otherwise a short list of numbers does.
/// If there is neither, a colour map is drawn.
FigureKeys figure_keys(const Varied& varied) {
  FigureKeys keys{.free = varied.free_keys()};
  if (keys.free.empty()) return keys;
  keys.over = keys.free[0];
  if (keys.free.size() < 2) return keys;
  const auto rank = [&](std::size_t key) {
    const Vary& vary = varied.keys()[key];
    return !vary.is_number() ? 0 : is_few(vary) ? vary.count() : std::numeric_limits<std::size_t>::max();
  };
  const bool first = rank(keys.free[0]) <= rank(keys.free[1]);
  keys.lines = keys.free[first ? 0 : 1];
  keys.has_lines = is_few(varied.keys()[keys.lines]);
  keys.map = !keys.has_lines;
  keys.above = keys.free[1];
  if (keys.has_lines) keys.over = keys.free[first ? 1 : 0];
  return keys;
}

/// A column of numbers with its name in sweep.csv. A column of width 1 also appears under its name in sweep.h5.
struct DrawnColumn {
  std::string name;
  std::vector<double> numbers;
};
std::vector<double> as_numbers(const Column& column, std::size_t i) {
  if (column.info().type == ValueType::number) return column.part(i);
  const std::span<const std::int64_t> counts = column.integers();
  return {counts.begin(), counts.end()};
}
std::vector<DrawnColumn> drawn_columns(const Sweep& sweep) {
  std::vector<DrawnColumn> all;
  const Table members = members_of(sweep);
  for (const Column& column : members.columns()) {
    const ColumnInfo& info = column.info();
    if (info.type == ValueType::text) continue;
    for (std::size_t i = 0; i < info.width; ++i) {
      all.push_back({info.scalar ? info.name : csv_name(column, i), as_numbers(column, i)});
    }
    if (info.width == 1 && !info.scalar) all.push_back({info.name, as_numbers(column, 0)});
  }
  return all;
}

/// Returns the values of a key of words, as labels of an axis or a legend.
std::vector<std::string> words_of(const Vary& vary, std::size_t longest = 28) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < vary.count(); ++i) words.push_back(without_quotes(vary.text(i)));
  words = figures::shortened(words, longest);
  for (std::string& word : words) word = figures::escaped(word);
  return words;
}

/// Returns the labels of an axis. Two labels fit horizontally and are shortened; more are printed vertically.
std::vector<std::string> axis_words(const Vary& vary) { return vary.count() > 2 ? words_of(vary) : words_of(vary, 18); }

/// Returns the label of a list entry. Entries are counted from 0 in scenarios and from 1 in figures.
std::string entry_label(const std::string& key) {
  const std::size_t open = key.find('[');
  const std::string number = open == std::string::npos ? "" : key.substr(open + 1, key.size() - open - 2);
  const bool is_entry = !number.empty() && key.back() == ']' && number.size() < 9 &&
                        number.find_first_not_of("0123456789") == std::string::npos;
  return figures::symbol(is_entry ? key.substr(0, open) + "_" + std::to_string(std::stoi(number) + 1) : key);
}

/// Returns the velocity of a coordinate: v_2 for q2, v_x for x.
std::string velocity_label(const std::string& coordinate) {
  const std::string name = figures::without_brackets(coordinate);
  const bool is_q = name.size() > 1 && name[0] == 'q' && name.find_first_not_of("0123456789", 1) == std::string::npos;
  return figures::symbol("v_" + (is_q ? name.substr(1) : name));
}

/// Returns the label of a varied key: the name of the coordinate for an entry of the start, otherwise the last part of
/// the key.
std::string key_label(const Sweep& sweep, const std::string& path) {
  const StateNames& names = sweep.names().state();
  for (const auto& [key, list] : {std::pair{"problem.initial.q", &names.q}, {"problem.initial.p", &names.p}}) {
    for (std::size_t i = 0; i < list->size(); ++i) {
      if (path == fmt::format("{}[{}]", key, i)) return figures::symbol((*list)[i]) + "(0)";
    }
  }
  for (std::size_t i = 0; i < names.q.size(); ++i) {
    if (path == fmt::format("problem.initial.v[{}]", i)) return velocity_label(names.q[i]) + "(0)";
  }
  if (path == "method.name") return "method";
  const std::string last = path.substr(path.rfind('.') + 1);
  return last == "dt" ? "d{/:Italic t}" : entry_label(last);
}

/// Returns the label of an invariant: NAME/final becomes "angular momentum at the end"; NAME/final2 is its second
/// number, NAME_2.
std::string invariant_label(const std::string& name) {
  const std::size_t slash = name.rfind('/');
  const std::size_t digits = name.find_last_not_of("0123456789") + 1;
  if (slash == std::string::npos || digits <= slash) return figures::quantity(name);
  const std::string what = name.substr(slash + 1, digits - slash - 1);
  const std::string label =
      figures::quantity(name.substr(0, slash) + (digits < name.size() ? "_" + name.substr(digits) : ""));
  if (what == "initial") return label + " at the start";
  if (what == "final") return label + " at the end";
  return what == "max_error" ? "largest error of " + label : figures::escaped(name);
}

/// Returns the label of an observable: kin_1_final becomes "kin_1 at the end". Empty for other columns.
std::string observable_label(const Sweep& sweep, const std::string& name) {
  for (const NamedExpression& observable : sweep.common().observables) {
    for (const auto& [end, words] :
         {std::pair{"_initial", " at the start"}, {"_mean", ", mean over time"}, {"_final", " at the end"}}) {
      if (name == observable.name + end) return figures::quantity(observable.name) + words;
    }
  }
  return {};
}

/// Returns the coordinate of a column: "x" for final/q1, or for final/q of a single coordinate. Empty for other
/// columns.
std::string name_at_the_end(const Sweep& sweep, const std::string& column) {
  const StateNames& names = sweep.names().state();
  for (const auto& [table, list] : {std::pair{"final/q", &names.q}, {"final/p", &names.p}}) {
    for (std::size_t i = 0; i < list->size(); ++i) {
      if (column == fmt::format("{}{}", table, i + 1) || column == table) return figures::symbol((*list)[i]);
    }
  }
  return {};
}

std::string value_label(const Sweep& sweep, const std::string& column) {
  static const std::map<std::string, std::string> known{{"energy/initial", "{/:Italic H}_0"},
                                                        {"energy/final", "{/:Italic H} at the end"},
                                                        {"energy/max_error", "max |{/:Italic H} − {/:Italic H}_0|"},
                                                        {"energy/scale", "energy scale"},
                                                        {"final/t", "{/:Italic t} at the end"}};
  const auto found = known.find(column);
  if (found != known.end()) return found->second;
  if (const std::string name = name_at_the_end(sweep, column); !name.empty()) return name + " at the end";
  const std::size_t slash = column.find('/');
  const std::string name = slash == std::string::npos ? column : column.substr(slash + 1);
  if (column.starts_with("invariants/")) return invariant_label(name);
  if (name.starts_with("lyapunov")) return "Lyapunov exponent " + figures::symbol("lambda" + name.substr(8));
  if (const std::string label = observable_label(sweep, name); !label.empty()) return label;
  std::string words = name;
  std::replace(words.begin(), words.end(), '/', ' ');
  return figures::escaped(words);
}

std::string title_of(const Sweep& sweep) {
  const Request& request = sweep.common().request;
  const auto is_varied = [&](const std::string& path) {
    const std::vector<Vary>& keys = sweep.varied().keys();
    return std::any_of(keys.begin(), keys.end(),
                       [&](const Vary& vary) { return vary.path == path || path.starts_with(vary.path + "."); });
  };
  std::string title = problem_text(sweep.common());
  if (!is_varied("method.name")) title += ", " + describe(request.method).name;
  if (!is_varied(run_path(run_keys().dt))) title += ", dt = " + request.dt;
  return title;
}

bool is_done(const MemberRow& row) { return row.status == Outcome::done; }
/// Returns whether the section points of a member are drawn. Those of an interrupted member are valid; a failed member
/// may have points that are far away from all others.
bool has_a_section(const MemberRow& row) { return !row.no_start && !is_failure(row.status); }

/// Returns the note about members that are not drawn.
/// @param drawn whether a member is drawn   @param without_value number of drawn members whose value is inf or nan
std::string note_of(const Sweep& sweep, bool map, bool (*drawn)(const MemberRow&), std::size_t without_value = 0) {
  std::map<std::string, std::size_t> failed;
  std::size_t count = without_value;
  for (const MemberRow& row : sweep.own_rows()) {
    if (drawn(row)) continue;
    ++failed[row.status_name()];
    ++count;
  }
  if (count == 0) return {};
  std::vector<std::string> parts;
  for (const auto& [status, members] : failed) parts.push_back(fmt::format("{} {}", members, status));
  if (without_value > 0) parts.push_back(fmt::format("{} without a finite value", without_value));
  return figures::escaped(
      fmt::format("{}: {} of {} members ({})", map ? "white" : "not drawn", count, sweep.own_members(), joined(parts)));
}

/// Returns the section points of all members that did not fail. Every member has its own colour while there are enough
/// colours.
Figure section_figure_of(const Sweep& sweep) {
  const Scenario& common = sweep.common();
  const std::size_t n = common.start_q.size();
  const StateNames& names = sweep.names().state();
  const std::size_t shown = coordinate_shown(*common.section, n);
  Figure figure;
  for (const MemberRow& row : sweep.own_rows()) {
    if (row.section.empty() || !has_a_section(row)) continue;
    FigureData data;
    data.title = title_of(sweep);
    data.coordinates = names.q;
    data.momenta = names.p;
    data.q.resize(n);
    data.p.resize(n);
    data.section_coordinate = names.q[shown];
    data.section_momentum = names.p[shown];
    data.section_text = section_text(*common.section, names);
    for (std::size_t at = 0; at < row.section.size(); at += 1 + 2 * n) {
      data.section_q.push_back(row.section[at + 1 + shown]);
      data.section_p.push_back(row.section[at + 1 + n + shown]);
    }
    figure.runs.push_back(std::move(data));
  }
  if (const std::string note = note_of(sweep, false, has_a_section); !note.empty()) figure.notes.push_back(note);
  return figure;
}

/// Returns the column of a coordinate or momentum by its name, "final/q1" for "final/x"; empty for other names.
std::string column_of_state(const Sweep& sweep, const std::vector<DrawnColumn>& all, const std::string& name) {
  const std::string table = "final/";
  if (!name.starts_with(table)) return {};
  const StateNames& names = sweep.names().state();
  for (const auto& [letter, list] : {std::pair{"q", &names.q}, {"p", &names.p}}) {
    const auto at = std::find(list->begin(), list->end(), name.substr(table.size()));
    if (at == list->end()) continue;
    const std::string numbered = fmt::format("{}{}{}", table, letter, at - list->begin() + 1);
    const auto is_numbered = [&](const DrawnColumn& column) { return column.name == numbered; };
    return std::any_of(all.begin(), all.end(), is_numbered) ? numbered : table + letter;
  }
  return {};
}

/// Returns the column for a name: the column itself, the column of a coordinate or momentum, or the only column that
/// ends with a slash and the name. Otherwise the name is returned.
std::string whole_name(const Sweep& sweep, const std::vector<DrawnColumn>& all, const std::string& name) {
  if (const std::string column = column_of_state(sweep, all, name); !column.empty()) return column;
  std::string found = name;
  int ends = 0;
  for (const DrawnColumn& column : all) {
    if (column.name == name) return name;
    if (!column.name.ends_with("/" + name)) continue;
    found = column.name;
    ++ends;
  }
  return ends == 1 ? found : name;
}

/// @throws Rejection if there is no such column
void check_column(const Sweep& sweep, const std::string& colour) {
  const std::vector<DrawnColumn> all = drawn_columns(sweep);
  const std::string name = whole_name(sweep, all, colour);
  std::vector<std::string> columns;
  for (const DrawnColumn& column : all) columns.push_back(column.name);
  if (colour.empty() || std::find(columns.begin(), columns.end(), name) != columns.end()) return;
  const auto whole = std::find_if(columns.begin(), columns.end(),
                                  [&](const std::string& column) { return column.ends_with("/" + colour); });
  const std::string meant = whole == columns.end() ? suggestion(colour, columns) : "; did you mean " + *whole + "?";
  const bool exponent = colour.find("lyapunov") != std::string::npos && meant.empty();
  throw Rejection(option_name("colour"), "found " + colour + "; allowed " + joined(columns) + meant +
                                             (exponent ? "; run.lyapunov = 1 adds observables/lyapunov1" : ""));
}

std::vector<std::string> columns_to_average(const std::string& columns) {
  return columns.empty() ? std::vector<std::string>{usual_colour} : split_list(columns);
}

/// Mean and standard error of independent numbers. Without numbers both are 0; for one number the error is 0.
struct MeanOfMembers {
  std::size_t count = 0;
  double mean = 0;
  double squares = 0;  // sum of squared distances from the mean, updated with each number
  void add(double x) {
    ++count;
    const double before = x - mean;
    mean += before / static_cast<double>(count);
    squares += before * (x - mean);
  }
  double standard_error() const {
    const auto n = static_cast<double>(count);
    return count < 2 ? 0 : std::sqrt(squares / (n - 1) / n);
  }
};

}  // namespace

void check_mean_figure(const Sweep& sweep, const std::filesystem::path& file, const std::string& columns) {
  if (const std::string wrong = refused_figure_file(file); !wrong.empty())
    throw Rejection(option_name("figure"), wrong);
  const std::vector<std::size_t> free = sweep.varied().free_keys();
  if (free.size() < 2) {
    throw Rejection(option_name("mean"),
                    "found one independent key; allowed two or more, since the mean is over all keys except the first");
  }
  for (const std::string& column : columns_to_average(columns)) check_column(sweep, column);
}

void draw_mean_figure(const Sweep& sweep, const std::filesystem::path& file, const std::string& columns) {
  const Varied& varied = sweep.varied();
  const std::size_t over = varied.free_keys().front();
  const Vary& key = varied.keys()[over];
  const std::vector<DrawnColumn> all = drawn_columns(sweep);
  std::vector<std::string> names = columns_to_average(columns);
  for (std::string& name : names) name = whole_name(sweep, all, name);
  ParameterMap figure;
  figure.title = title_of(sweep);
  figure.x_label = key_label(sweep, key.path);
  figure.value_label = names.size() == 1 ? "mean of " + value_label(sweep, names[0]) : "mean";
  if (!key.is_number()) figure.x_words = axis_words(key);
  std::vector<std::size_t> done(key.count());  // number of finished members for each value of the first key
  for (std::size_t member = 0; member < sweep.members(); ++member) {
    if (sweep.row(member).status == Outcome::done) ++done[varied.place(member, over)];
  }
  std::size_t without_value = 0;
  for (const std::string& name : names) {
    const auto column = std::find_if(all.begin(), all.end(), [&](const DrawnColumn& one) { return one.name == name; });
    std::vector<MeanOfMembers> means(key.count());
    std::vector<double> x(means.size());
    for (std::size_t member = 0; member < sweep.members(); ++member) {
      const std::size_t place = varied.place(member, over);
      x[place] = key.is_number() ? varied.number(member, over) : static_cast<double>(place);
      // The values of an unfinished member belong to an earlier time than those of the others.
      if (sweep.row(member).status == Outcome::done) means[place].add(column->numbers[member]);
    }
    for (std::size_t k = 0; k < means.size(); ++k) {
      const bool known = means[k].count > 0;
      figure.x.push_back(x[k]);
      figure.value.push_back(known ? means[k].mean : std::numeric_limits<double>::quiet_NaN());
      figure.error.push_back(known ? means[k].standard_error() : 0);
      if (known && !std::isfinite(means[k].mean)) ++without_value;
      if (names.size() > 1) figure.line.push_back(value_label(sweep, name));
    }
  }
  std::erase(done, 0U);  // values without finished members are not drawn
  if (!done.empty()) {
    const auto [fewest, most] = std::minmax_element(done.begin(), done.end());
    figure.notes.push_back("bars: standard error of the mean over " +
                           (*fewest == *most ? "" : std::to_string(*fewest) + " to ") + std::to_string(*most) +
                           " members");
  }
  if (without_value > 0) {
    figure.notes.push_back(
        fmt::format("not drawn: {} of {} means, which are not finite", without_value, figure.value.size()));
  }
  const std::string note = note_of(sweep, false, is_done);
  if (!note.empty()) figure.notes.push_back(note);
  write_parameter_map(figure, file);
}

void check_sweep_figure(const Sweep& sweep, const std::filesystem::path& file, const std::string& colour) {
  if (const std::string wrong = refused_figure_file(file); !wrong.empty())
    throw Rejection(option_name("figure"), wrong);
  if (draws_section(sweep, colour)) {
    if (!sweep.names().have_same_state()) {
      throw Rejection(option_name("figure"),
                      "found a section of members with different coordinates; allowed if all members have the same "
                      "coordinates, or with " +
                          option_name("colour") + " COLUMN");
    }
    const FigureFacts facts{.degrees_of_freedom = sweep.common().start_q.size(),
                            .section = true,
                            .stroboscopic = sweep.common().section->is_stroboscopic};
    const std::string refused = refused_figure("section", facts);
    if (!refused.empty()) throw Rejection(option_name("figure"), refused);
    return;
  }
  const FigureKeys keys = figure_keys(sweep.varied());
  if (keys.free.size() > 2) {
    throw Rejection(option_name("figure"),
                    "found " + std::to_string(keys.free.size()) + " varied keys; allowed one or two");
  }
  if (keys.has_lines && sweep.varied().keys()[keys.lines].count() > most_map_lines) {
    const Vary& lines = sweep.varied().keys()[keys.lines];
    throw Rejection(option_name("figure"),
                    fmt::format("found {} values of {}, which need one line each; allowed up to {}", lines.count(),
                                lines.path, most_map_lines));
  }
  check_column(sweep, colour);
}

void draw_sweep_figure(const Sweep& sweep, const std::filesystem::path& file, const std::string& column) {
  if (draws_section(sweep, column)) {
    const Figure figure = section_figure_of(sweep);
    if (figure.runs.empty()) {
      throw FileError("cannot draw " + file.string() + ": no member has a point of the section" +
                      (figure.notes.empty() ? "" : " (failed members are not drawn)"));
    }
    write_figure(figure, "section", file);
    return;
  }
  std::vector<DrawnColumn> all = drawn_columns(sweep);
  const std::string colour = column.empty() ? usual_colour : whole_name(sweep, all, column);
  const Varied& varied = sweep.varied();
  const FigureKeys keys = figure_keys(varied);
  ParameterMap figure;
  figure.title = title_of(sweep);
  figure.value_label = value_label(sweep, colour);
  figure.x_label = key_label(sweep, varied.keys()[keys.over].path);
  if (keys.map) figure.y_label = key_label(sweep, varied.keys()[keys.above].path);
  for (DrawnColumn& one : all) {
    if (one.name == colour) figure.value = std::move(one.numbers);
  }
  const Vary& x = varied.keys()[keys.over];
  if (!x.is_number()) figure.x_words = axis_words(x);
  const std::vector<std::string> lines =
      keys.has_lines ? words_of(varied.keys()[keys.lines]) : std::vector<std::string>();
  std::size_t without_value = 0;
  for (std::size_t member = 0; member < sweep.members(); ++member) {
    figure.x.push_back(x.is_number() ? varied.number(member, keys.over)
                                     : static_cast<double>(varied.place(member, keys.over)));
    if (keys.map) figure.y.push_back(varied.number(member, keys.above));
    if (keys.has_lines) {
      const Vary& line = varied.keys()[keys.lines];
      const std::string& text = lines.at(varied.place(member, keys.lines));
      figure.line.push_back(line.is_number() ? key_label(sweep, line.path) + " = " + text : text);
    }
    // The values of an unfinished member belong to an earlier time than those of the others.
    if (!is_done(sweep.row(member))) {
      figure.value[member] = std::numeric_limits<double>::quiet_NaN();
    } else if (!std::isfinite(figure.value[member])) {
      ++without_value;
    }
  }
  const std::string note = note_of(sweep, keys.map, is_done, without_value);
  if (!note.empty()) figure.notes.push_back(note);
  write_parameter_map(figure, file);
}

}  // namespace hamflow
