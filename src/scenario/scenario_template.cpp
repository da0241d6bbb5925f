#include "scenario_template.hpp"

#include <toml++/toml.h>

#include <algorithm>

#include "hamflow/core/error.hpp"
#include "hamflow/scenario/scenario.hpp"
#include "scenario_edit.hpp"
#include "toml_table.hpp"

namespace hamflow {

namespace {

/// A number expression as a TOML value: itself where it is one, else a string.
std::string toml_number(const std::string& text) {
  try {
    const toml::table parsed = toml::parse("value = " + text);
    if (parsed.size() == 1 && parsed.get("value")->is_number()) return text;
  } catch (const toml::parse_error&) {  // NOLINT: then it is an expression
  }
  return "\"" + text + "\"";
}
std::string toml_numbers(const std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& text : texts) all += (all.empty() ? "" : ", ") + toml_number(text);
  return "[" + all + "]";
}
std::string toml_value(const std::string& text) {
  return text.starts_with("[") ? toml_numbers(list_parts(text)) : toml_number(text);
}

/// Few digits: the states of an example are arbitrary.
std::string rounded(double x) {
  char buffer[32];
  (void)std::snprintf(buffer, sizeof buffer, "%.3g", x);
  return buffer;
}
std::string rounded_list(const std::vector<double>& numbers) {
  std::string all;
  for (const double x : numbers) all += (all.empty() ? "" : ", ") + rounded(x);
  return "[" + all + "]";
}

/// Lines of code with comments beside them, aligned within a block.
class Page {
 public:
  void line(const std::string& code, const std::string& comment = "") { block_.emplace_back(code, comment); }
  /// A key that is not set.
  void off(const std::string& code, const std::string& comment) { line("# " + code, comment); }
  /// Full lines of comment, broken between words.
  void prose(const std::string& text) {
    end_block();
    write_prose(text);
  }
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
  std::string text_;
  std::vector<std::pair<std::string, std::string>> block_;
};

/// A geometric start with the example values of its keys, and the parameters that go with them.
struct StartExample {
  const StartInfo* info;
  Texts orbit;
  Texts parameters;
};

/// What the problem declares, with the parameters that go with it.
StartExample example_of(const ProblemEntry& problem, const Texts& parameters, const StartInfo& info) {
  const bool own = !info.example_parameters.empty();
  return {&info, info.example, own ? complete(problem.info, info.example_parameters) : parameters};
}

std::string orbit_table(const StartInfo& info, const Texts& values) {
  std::string text = info.kind.empty() ? "" : "kind = \"" + info.kind + "\"";
  for (const std::string& key : info.keys) text += (text.empty() ? "" : ", ") + key + " = " + values.at(key);
  return "{ " + text + " }";
}

bool derives(const StartExample& start, const std::string& parameter) {
  const auto& derived = start.info->derives;
  return std::find(derived.begin(), derived.end(), parameter) != derived.end();
}

/// How the parameters of a start differ from those that are active: "with k = -1, without alpha".
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

const char* words(Range range) {
  switch (range) {
    case Range::positive:
      return "positive";
    case Range::not_negative:
      return "not negative";
    case Range::count:
      return "a whole number from 1";
    case Range::any:
      break;
  }
  return "any number";
}

class TemplateWriter {
 public:
  TemplateWriter(const ProblemEntry& problem, const ExampleInfo& example)
      : problem_(problem),
        info_(problem.info),
        example_(example),
        parameters_(complete(problem.info, example.parameters)) {
    choose_method();
    find_starts();
  }

  std::string write() {
    page_.prose("A scenario for hamflow run. hamflow show " + info_.name + " says the same in other words.");
    page_.prose(info_.formula);
    page_.prose("Source: " + info_.reference);
    page_.prose("Numbers may also be texts such as \"1/3\" or \"2*pi/100\". What stands behind # is not set.");
    write_problem();
    write_method();
    write_run();
    page_.section("output");
    page_.off("folder = \"my.run\"", "default: the name of this file with .run");
    page_.line("formats = [\"h5\"]", "h5, csv; default [\"h5\"]");
    page_.off("figures = [\"energy-error\"]",
              std::string(problem_.dimension == 1 ? "" : "orbit, ") + "phase, energy, energy-error; default none");
    return page_.text();
  }

 private:
  void choose_method() {
    const bool charged = problem_.accepts(MethodSpec{"boris", {}});
    for (const char* name : {"boris", "stv4", "cg"}) {
      if (!problem_.accepts(MethodSpec{name, {}})) continue;
      if (!charged || std::string(name) == "boris") {
        method_.name = name;
        return;
      }
    }
    for (const MethodEntry& entry : methods()) {
      if (!problem_.accepts(MethodSpec{entry.name, {}})) continue;
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
      std::vector<std::string> all;
      for (const ProblemEntry& entry : problems()) {
        for (const auto& [other_key, other] : entry.info.variant) {
          const bool is_new = std::find(all.begin(), all.end(), other) == all.end();
          if (entry.info.name == info_.name && other_key == key && is_new) all.push_back(other);
        }
      }
      std::string code = key;
      code.append(" = \"").append(value).append("\"");
      page_.line(code, joined(all));
    }
    for (const ParameterInfo& parameter : info_.parameters) write_parameter(parameter);
    write_starts();
  }

  void write_parameter(const ParameterInfo& parameter) {
    std::string comment = parameter.meaning + "; ";
    comment += parameter.kind == ParameterKind::number
                   ? ""
                   : "a list" + (parameter.length > 0 ? " of " + std::to_string(parameter.length) : std::string());
    if (parameter.kind == ParameterKind::number_or_list) comment += " or a number";
    comment += std::string(parameter.kind == ParameterKind::number ? "" : ", each ") + words(parameter.range);
    comment += parameter.required                ? "; required"
               : parameter.default_value.empty() ? "; not given by default"
                                                 : "; default " + parameter.default_value;
    const std::string value = parameters_.at(parameter.name);
    if (active_ != nullptr && derives(*active_, parameter.name)) {
      page_.off(parameter.name + " = " + toml_value(value), comment + "; here it follows from the orbit");
    } else if (value.empty()) {
      page_.off(parameter.name + " = " + (parameter.kind == ParameterKind::list ? "[1]" : "1"), comment);
    } else {
      page_.line(parameter.name + " = " + toml_value(value), comment);
    }
  }

  void write_starts() {
    if (!info_.start_key.empty() && !starts_.empty()) {
      page_.prose("The start: a state, as here, or in its place a numbered case with exactly its keys:");
      for (const StartExample& start : starts_) {
        std::string keys = info_.start_key + " = " + std::to_string(start.info - info_.starts.data() + 1);
        for (const std::string& key : start.info->keys) keys += "; " + key + " = " + start.orbit.at(key);
        const std::string changes = difference(start, parameters_);
        page_.prose("  " + keys + ": " + start.info->meaning + (changes.empty() ? "" : " (" + changes + ")"));
      }
    } else if (!info_.starts.empty()) {
      page_.prose("The start, exactly one of these; in an orbit, direction = -1 turns it round:");
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
    if (info_.two_bodies) {
      page_.prose("Two bodies in space, reduced to the plane; without mass, which follows:");
      page_.line("# bodies = [{ mass = 1, position = [0, 0, 0], velocity = [0, 0, 0] },");
      page_.line("#           { mass = 2, position = [1, 0, 0], velocity = [0, 1, 0] }]");
    }
  }

  void write_state() {
    constexpr std::size_t longest = 12;
    std::string comment =
        "q = [" + joined(info_.coordinates) + "] with canonical momenta p, or { q, v } with velocities";
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
      comment += "; default: " + std::string(info_.default_q.size() <= longest ? "this" : "the problem's own");
    if (q.empty()) {
      page_.off("initial = { q = [...], p = [...] }", comment);
    } else if (active_ != nullptr) {
      page_.off("initial = { q = " + q + ", p = " + p + " }", comment);
    } else {
      page_.line("initial = { q = " + q + ", p = " + p + " }", comment);
    }
  }

  void write_method() {
    page_.section("method");
    std::vector<std::string> names;
    for (const MethodEntry& entry : methods()) {
      if (problem_.accepts(MethodSpec{entry.name, {}})) names.push_back(entry.name);
    }
    page_.prose("Allowed here: " + joined(names) + ". More about one: hamflow show NAME");
    page_.line("name = \"" + method_.name + "\"", describe(method_).summary);
    if (std::find(names.begin(), names.end(), "cg") == names.end()) return;
    if (method_.name != "cg") page_.prose("Options of cg:");
    const auto option = [&](const char* code, const char* comment) {
      method_.name == "cg" ? page_.line(code, comment) : page_.off(code, comment);
    };
    option("degree = 1", "polynomial degree in time; default 1");
    option("quadrature = \"auto\"",
           "Gauss points, from the degree to 64, or \"auto\": as many as keep H; default \"auto\"");
    page_.off("tolerance = 1e-13", "on the residual's 2-norm, positive; default: its rounding level");
    page_.off("criterion = \"stagnation\"",
              "stagnation, seed: stagnation above the tolerance is an error; default stagnation");
    page_.off("max_iterations = 15", "1 to 1000; default 15");
    page_.off("on_divergence = \"error\"", "error, halve: two half steps instead; default error");
    page_.off("diagnostics = false", "condition of each step's equations; default false");
  }

  void write_run() {
    page_.section("run");
    page_.line("dt = " + shortest(example_.dt), "step length, not 0; negative: backwards in time");
    page_.line("steps = " + std::to_string(example_.steps),
               "0 or more; or t_end, which has to be a whole number of dt");
    page_.off("t_end = " + shortest(example_.dt * static_cast<double>(example_.steps)), "in place of steps");
    page_.off("record_every = 1", "steps from one sample to the next; default: at most 10000 samples");
    page_.off("record = [0, " + shortest(example_.dt * 1.5) + "]",
              "in place of record_every: times, not only of steps");
    page_.off("lyapunov = true", "true for all exponents, or how many of the largest");
    page_.off("eigenvalues = true", "of the derivative of all steps");
    const std::string first = problem_.dimension > 0 ? problem_.info.coordinates[0] : "q1";
    page_.off("section = { coordinate = \"" + first + "\", value = 0, direction = 1 }",
              "a Poincare section; direction 1 upwards, -1 downwards, 0 both");
    page_.off("checkpoint_every = 1000000", "steps from one checkpoint to the next; default: every 10 seconds");
    std::vector<std::string> allowed;
    for (const std::string& arithmetic : arithmetics()) {
      if (refusal(method_, arithmetic).empty()) allowed.push_back(arithmetic);
    }
    page_.line("arithmetic = \"double\"", joined(allowed) + " with this method; default double");
    if (std::find(allowed.begin(), allowed.end(), "lattice") != allowed.end()) {
      page_.off("lattice = { position = \"2^-52\", momentum = \"2^-52\" }", "units with arithmetic = \"lattice\"");
      if (problem_.has_pairwise_forces) page_.off("threads = 2", "with arithmetic = \"lattice\"; default 1");
    }
    if (problem_.has_fast_kernel && method_.name != "cg")
      page_.line("kernel = \"exact\"", "exact, fast; default exact");
  }

  const ProblemEntry& problem_;
  const ProblemInfo& info_;
  const ExampleInfo& example_;
  Texts parameters_;
  MethodSpec method_;
  std::vector<StartExample> starts_;
  const StartExample* active_ = nullptr;
  Page page_;
};

}  // namespace

std::string scenario_template(const ProblemEntry& problem, const ExampleInfo& example) {
  return TemplateWriter(problem, example).write();
}

}  // namespace hamflow
