#include "scenario_template.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>

#include "core/text_place.hpp"
#include "figure_kinds.hpp"
#include "hamflow/core/error.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/detail/run/formula_options.hpp"
#include "hamflow/formula/problem_texts.hpp"
#include "hamflow/run/walls.hpp"
#include "hamflow/scenario/scenario.hpp"
#include "option_text.hpp"
#include "run_keys.hpp"

namespace hamflow {

namespace {

std::string toml_numbers(const std::vector<std::string>& texts) {
  return toml_text({.name = "", .type = OptionType::list}, "[" + joined(texts) + "]");
}

/// Rounds to few digits, because the states of an example are arbitrary.
std::string rounded(double x) {
  char buffer[32];
  (void)std::snprintf(buffer, sizeof buffer, "%.3g", x);
  return buffer;
}
std::string rounded_list(const std::vector<double>& numbers) { return "[" + joined(numbers, rounded) + "]"; }

/// Writes lines of TOML with comments at their ends, which are aligned within a block.
class Page {
 public:
  /// @param all false: write only keys that are set, without explanations
  explicit Page(bool all) : all_(all) {}
  void line(const std::string& code, const std::string& comment = "") { block_.emplace_back(code, comment); }
  /// Writes a key that is not set, as a comment.
  void off(const std::string& code, const std::string& comment) {
    if (all_) line("# " + code, comment);
  }
  /// A comment on lines of its own, broken between words.
  void prose(const std::string& text) {
    if (all_) heading(text);
  }
  /// The same, also in the short form.
  void heading(const std::string& text) {
    end_block();
    write_prose(text);
  }
  bool all() const { return all_; }
  void section(const std::string& name) {
    end_block();
    text_ += (text_.empty() ? "" : "\n") + ("[" + name + "]\n");
  }
  std::string text() {
    end_block();
    return text_;
  }

 private:
  static constexpr std::size_t widest = 110;
  static constexpr std::size_t widest_code = 44;

  void write_prose(const std::string& text) {
    std::string row = "#";
    std::size_t at = 0;
    while (at < text.size()) {
      const std::size_t end = std::min(text.find(' ', at), text.size());
      if (row.size() + 1 + end - at > widest && row != "#") {
        text_ += row + "\n";
        row = "#";
      }
      row += " " + text.substr(at, end - at);
      at = end + 1;
    }
    text_ += row + "\n";
  }
  void end_block() {
    std::size_t width = 0;
    for (const auto& [code, comment] : block_) {
      if (!comment.empty() && code.size() <= widest_code) width = std::max(width, code.size());
    }
    for (const auto& [code, comment] : block_) {
      std::string beside;
      if (!comment.empty()) beside = std::string(code.size() < width ? width - code.size() : 0, ' ') + "  # " + comment;
      if (code.size() + beside.size() > widest + 8) {
        write_prose(comment + ":");
        beside.clear();
      }
      text_ += code + beside + "\n";
    }
    block_.clear();
  }
  bool all_;
  std::string text_;
  std::vector<std::pair<std::string, std::string>> block_;
};

/// A geometric start with example values of its keys, and the parameters of this example.
struct StartExample {
  const StartInfo* info;
  Texts orbit;
  Texts parameters;
};

/// Returns the example that the problem declares, with its parameters.
StartExample example_of(const ProblemEntry& problem, const Texts& parameters, const StartInfo& info) {
  const bool own = !info.example_parameters.empty();
  return {&info, info.example, own ? complete(problem.info, info.example_parameters) : parameters};
}

std::string orbit_table(const StartInfo& info, const Texts& values) {
  std::vector<std::string> parts;
  if (!info.kind.empty()) parts.push_back("kind = \"" + info.kind + "\"");
  for (const std::string& key : info.keys) parts.push_back(key + " = " + values.at(key));
  return "{ " + joined(parts) + " }";
}

bool derives(const StartExample& start, const std::string& parameter) {
  const auto& derived = start.info->derives;
  return std::find(derived.begin(), derived.end(), parameter) != derived.end();
}

/// Returns the differences between the parameters of a start and the active ones: "with k = -1, without alpha".
std::string difference(const StartExample& start, const Texts& active) {
  std::string with;
  std::string without;
  for (const auto& [name, text] : active) {
    const auto other = start.parameters.find(name);
    const bool given = other != start.parameters.end() && !other->second.empty() && !derives(start, name);
    if (given && other->second != text) with += (with.empty() ? "with " : ", ") + name + " = " + other->second;
    if (!given && !text.empty()) without += (without.empty() ? "without " : ", ") + name;
  }
  return with + (with.empty() || without.empty() ? "" : ", ") + without;
}

class TemplateWriter {
 public:
  TemplateWriter(const ProblemEntry& problem, const ExampleInfo& example, MethodSpec method, bool all)
      : problem_(problem),
        info_(problem.info),
        example_(example),
        parameters_(complete(problem.info, example.parameters)),
        method_(std::move(method)),
        page_(all) {
    if (method_.name.empty()) choose_method();
    find_starts();
  }

  std::string write() {
    page_.prose("A scenario for hamflow run. hamflow show " + info_.name + " describes the problem.");
    page_.heading(info_.formula);
    page_.prose("Source: " + info_.reference);
    page_.prose(
        "Numbers may also be texts such as \"1/3\" or \"2*pi/100\". Lines that start with # are optional settings.");
    write_problem();
    write_method();
    write_run();
    write_output();
    if (!page_.all()) {
      page_.heading("All keys: hamflow new " + info_.name + " --all. About the method: hamflow show " + method_.name +
                    ". Others: hamflow list methods");
    }
    return page_.text();
  }

 private:
  void choose_method() {
    const bool charged = problem_.accepts(MethodSpec{.name = "boris"});
    for (const char* name : {"boris", "stv4", "cg"}) {
      if (!problem_.accepts(MethodSpec{.name = name})) continue;
      if (!charged || std::string(name) == "boris") {
        method_.name = name;
        return;
      }
    }
    for (const MethodEntry& entry : methods()) {
      if (!problem_.accepts(MethodSpec{.name = entry.name})) continue;
      method_.name = entry.name;
      return;
    }
  }

  void find_starts() {
    for (const StartInfo& info : info_.starts) {
      if (!info.example.empty()) starts_.push_back(example_of(problem_, parameters_, info));
    }
    for (const StartExample& start : starts_) {
      if (!example_.start.empty() && start.info->kind == example_.start) active_ = &start;
    }
  }

  void write_problem() {
    page_.section("problem");
    page_.line("name = \"" + info_.name + "\"");
    for (const auto& [key, value] : info_.variant) {
      if (find_option(info_.keys, key) != nullptr) continue;  // written below together with the other keys
      std::vector<std::string> all;
      for (const ProblemEntry& entry : problems()) {
        for (const auto& [other_key, other] : entry.info.variant) {
          const bool is_new = std::find(all.begin(), all.end(), other) == all.end();
          if (entry.info.name == info_.name && other_key == key && is_new) all.push_back(other);
        }
      }
      if (key == info_.typed_choice) all.emplace_back(FormulaKeys::problem);
      std::string code = key;
      // as in dimension = 3
      const bool is_number = !value.empty() && std::all_of(value.begin(), value.end(), is_digit);
      const char* const mark = is_number ? "" : "\"";
      code.append(" = ").append(mark).append(value).append(mark);
      page_.line(code, joined(all));
    }
    if (info_.keys.empty()) {
      for (const ParameterInfo& parameter : info_.parameters) write_parameter(parameter);
    }
    for (OptionInfo option : info_.keys) {
      const auto set = example_.keys.find(option.name);
      if (set != example_.keys.end() && !set->second.empty()) option.example = set->second;
      write_option(option, set != example_.keys.end());
    }
    if (problem_.structure) {
      for (const std::string& sentence : formula_language()) page_.prose(sentence);
    }
    if (!problem_.particles) return write_starts();
    page_.off("initial = { q = [...], p = [...] }", "q = [" + joined(info_.coordinates) + "], in place of start");
    write_walls();
  }

  /// The short form gives only the meaning of a key.
  std::string comment_on(const OptionInfo& option) const {
    return page_.all() ? explained_with_default(option) : option.meaning;
  }

  void write_parameter(const ParameterInfo& parameter) {
    const std::string comment = comment_on(parameter);
    const std::string value = parameters_.at(parameter.name);
    if (active_ != nullptr && derives(*active_, parameter.name)) {
      page_.off(parameter.name + " = " + toml_text(parameter, value), comment + "; here it follows from the orbit");
    } else if (value.empty()) {
      page_.off(parameter.name + " = " + example_text(parameter), comment);
    } else {
      page_.line(parameter.name + " = " + toml_text(parameter, value), comment);
    }
  }

  void write_starts() {
    if (!info_.start_key.empty() && !starts_.empty()) {
      page_.prose("The start is a state, as here, or a numbered case with exactly its keys:");
      for (const StartExample& start : starts_) {
        std::string keys = info_.start_key + " = " + std::to_string(start.info - info_.starts.data() + 1);
        for (const std::string& key : start.info->keys) keys += "; " + key + " = " + start.orbit.at(key);
        const std::string changes = difference(start, parameters_);
        page_.prose("  " + keys + ": " + start.info->meaning + (changes.empty() ? "" : " (" + changes + ")"));
      }
    } else if (!info_.starts.empty()) {
      page_.prose(
          "The start: choose exactly one of these. In an orbit, direction = -1 reverses the sense of rotation:");
    } else {
      page_.prose("The start:");
    }
    for (const StartExample& start : starts_) {
      if (!info_.start_key.empty()) break;
      const std::string code = "orbit = " + orbit_table(*start.info, start.orbit);
      if (&start == active_) {
        page_.line(code, start.info->meaning);
      } else {
        Texts given = parameters_;
        if (active_ != nullptr) {
          for (const std::string& name : active_->info->derives) given[name] = "";
        }
        const std::string changes = difference(start, given);
        page_.off(code, (changes.empty() ? "" : changes + "; ") + start.info->meaning);
      }
    }
    write_state();
    if (!info_.velocities.name.empty()) write_option(info_.velocities, false);
    if (!info_.frame.name.empty()) write_option(info_.frame, false);
    write_walls();
    if (info_.two_bodies) {
      page_.prose("Or two bodies in space, which are reduced to the plane; leave out mass, which follows from them:");
      page_.off("bodies = [{ mass = 1, position = [0, 0, 0], velocity = [0, 0, 0] },", "");
      page_.off("          { mass = 2, position = [1, 0, 0], velocity = [0, 1, 0] }]", "");
    }
  }

  void write_state() {
    constexpr std::size_t longest = 12;
    std::string comment = "q = [" + joined(info_.coordinates) +
                          "] with canonical momenta p, or { q, v } with velocities; with energy = E one component of p "
                          "or v is \"+\" or \"-\", the largest or the smallest root of H = E";
    std::string q;
    std::string p;
    if (!example_.q.empty()) {
      q = rounded_list(example_.q);
      p = rounded_list(example_.p);
    } else if (info_.default_q.size() <= longest && !info_.default_q.empty()) {
      q = toml_numbers(info_.default_q);
      p = toml_numbers(info_.default_p);
    }
    if (!info_.default_q.empty())
      comment += "; default: " + std::string(info_.default_q.size() <= longest ? "this" : "declared by the problem");
    if (q.empty()) {
      page_.off("initial = { q = [...], p = [...] }", comment);
    } else if (active_ != nullptr) {
      page_.off("initial = { q = " + q + ", p = " + p + " }", comment);
    } else {
      page_.line("initial = { q = " + q + ", p = " + p + " }", comment);
    }
  }

  void write_walls() {
    const WallKeys& keys = wall_keys();
    const bool fixed = !info_.walls.empty();
    if (!fixed && !problem_.constraint_form.empty()) return;  // walls and constraints exclude each other
    if (!fixed) {
      const double start = first_of_start();
      const double min = start > -1 ? -1 : std::floor(start) - 1;
      const double max = start < 1 ? 1 : std::ceil(start) + 1;
      page_.off(keys.walls.name + " = [{ " + keys.coordinate.name + " = \"" + first_coordinate() + "\", " +
                    keys.min.name + " = " + shortest(min) + ", " + keys.max.name + " = " + shortest(max) + " }]",
                "hard or soft walls; a hard wall needs only one of min and max");
    }
    write_option(keys.wall_rule, fixed);
    write_option(keys.strength, false);
    write_option(keys.exponent, false);
  }

  void write_method() {
    page_.section("method");
    std::vector<std::string> names;
    for (const MethodEntry& entry : methods()) {
      const MethodSpec spec{.name = entry.name};
      const bool copy_meets_walls_separately = !info_.walls.empty() && describe(spec).carries_copy;
      if (problem_.accepts(spec) && !copy_meets_walls_separately) names.push_back(entry.name);
    }
    page_.prose("Allowed methods: " + joined(names) + ". hamflow show NAME describes one.");
    page_.line("name = \"" + method_.name + "\"", describe(method_).summary);
    const MethodFamily* const chosen = find_method(method_.name).family;
    for (OptionInfo option : chosen->options) {
      const auto given = method_.options.find(option.name);
      if (given != method_.options.end()) option.example = option.default_value = given->second;
      write_option(option, given != method_.options.end() || (option.position > 0 && !option.default_value.empty()));
      explained_options_.insert(explained_with_default(option));
    }
    for (const MethodFamily& family : method_families()) {
      if (&family != chosen) write_options_of_others(family, names);
    }
  }

  /// Writes the options of other methods as comments. Options that were already explained are only named.
  void write_options_of_others(const MethodFamily& family, const std::vector<std::string>& allowed_here) {
    const bool allowed =
        std::find(allowed_here.begin(), allowed_here.end(), family.methods.front()) != allowed_here.end();
    std::vector<std::string> above;
    std::vector<OptionInfo> here;
    for (const OptionInfo& option : family.options) {
      const bool is_new = allowed && explained_options_.insert(explained_with_default(option)).second;
      is_new ? here.push_back(option) : above.push_back(option.name);
    }
    if (family.options.empty() || !allowed) return;
    const std::string shared = above.empty() ? "" : joined(above) + " as above";
    page_.prose("Options of " + joined(family.methods) + ": " + shared +
                (above.empty() || here.empty() ? "" : ", and") + (above.empty() && !here.empty() ? "these" : ""));
    for (const OptionInfo& option : here) write_option(option, false);
  }

  void write_option(const OptionInfo& option, bool set) {
    const std::string code = option.name + " = " + example_text(option);
    set ? page_.line(code, comment_on(option)) : page_.off(code, comment_on(option));
  }

  /// Writes [run] as declared, with the numbers of the example, without keys that this problem or its method refuses.
  void write_run() {
    page_.section("run");
    const RunKeys& keys = run_keys();
    std::vector<std::string> arithmetics_here;
    for (const std::string& arithmetic : arithmetics()) {
      if (refusal(method_, arithmetic).empty()) arithmetics_here.push_back(arithmetic);
    }
    const bool on_lattice =
        std::find(arithmetics_here.begin(), arithmetics_here.end(), "lattice") != arithmetics_here.end();
    for (OptionInfo key : declared_table(run_table).keys) {
      bool set = false;
      if (key.name == keys.dt.name) {
        key.example = shortest(example_.dt);
        set = true;
      } else if (key.name == keys.steps.name) {
        key.example = std::to_string(example_.steps);
        set = true;
      } else if (key.name == keys.t_end.name) {
        key.example = shortest(example_.dt * static_cast<double>(example_.steps));
      } else if (key.name == keys.record.name) {
        key.example = "[0, " + rounded(example_.dt * 1.5) + "]";
      } else if (key.name == keys.arithmetic.name) {
        key.words = arithmetics_here;
        set = true;
      } else if (key.name == keys.section.name) {
        key.keys.front().example = first_coordinate();
      } else if (key.name == keys.events.name) {
        for (OptionInfo& part : key.keys) {
          if (part.name == event_keys().expression.name) part.example = first_coordinate();
        }
        page_.off(key.name + " = [" + example_text(key) + "]", explained_with_default(key));
        continue;
      } else if (key.name == keys.lyapunov.name || key.name == keys.eigenvalues.name) {
        if (!problem_.constraint_form.empty()) continue;  // steps on a manifold are not differentiated
      } else if (key.name == keys.lattice.name && !on_lattice) {
        continue;
      } else if (key.name == keys.threads.name && !(on_lattice && problem_.has_pairwise_forces)) {
        continue;
      }
      write_option(key, set);
    }
  }

  void write_output() {
    page_.section("output");
    for (OptionInfo key : declared_table(output_table).keys) {
      if (key.name == output_keys().figures.name) {
        key.words = drawable_figures({.degrees_of_freedom = problem_.dimension});
      } else if (key.name == output_keys().observables.name && problem_.dimension > 0) {
        key.example = "{ square = \"" + problem_.info.coordinates[0] + "^2\" }";
      }
      write_option(key, key.name == output_keys().formats.name);
    }
  }

  /// Returns the first coordinate of the start.
  double first_of_start() const {
    Request request{.problem = info_.name};
    request.variant = {info_.variant.begin(), info_.variant.end()};
    request.parameters = parameters_;
    if (active_ != nullptr) {
      request.start.kind = active_->info->kind;
      request.start.orbit = active_->orbit;
      request.parameters = problem_.derived(active_->parameters, request.start);
    } else if (!example_.q.empty()) {
      return std::strtod(rounded(example_.q.front()).c_str(), nullptr);
    } else {
      return info_.default_q.empty() ? 0 : number_value(info_.default_q.front());
    }
    return problem_.start(request).q.front();
  }

  std::string first_coordinate() const { return problem_.dimension > 0 ? info_.coordinates[0] : "q1"; }

  const ProblemEntry& problem_;
  const ProblemInfo& info_;
  const ExampleInfo& example_;
  Texts parameters_;
  MethodSpec method_;
  std::vector<StartExample> starts_;
  const StartExample* active_ = nullptr;
  std::set<std::string> explained_options_;
  Page page_;
};

}  // namespace

std::string scenario_template(const ProblemEntry& problem, const ExampleInfo& example, const MethodSpec& method,
                              bool all) {
  return TemplateWriter(problem, example, method, all).write();
}

}  // namespace hamflow
