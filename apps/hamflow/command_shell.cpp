// hamflow shell: controls a run by commands read line by line.   [Gross1999, appendix: step, dt, tol, quit]
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "guarded.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/detail/run/digits.hpp"
#include "hamflow/scenario/rejection.hpp"
#include "hamflow/workflow/session.hpp"
#include "progress.hpp"
#include "run_keys.hpp"
#include "unused_keys.hpp"

namespace hamflow::app {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* help_text =
    "step [n]        take n steps [1]\n"
    "dt x            change the step size; state and time are kept\n"
    "tol x, tol off  set the tolerance of the method; off: its default\n"
    "method m        change the method, e.g. method cg(1,5); state and time are kept\n"
    "show [what]     print the state, or one of: step, t, q, p, energy, error (energy error since the start),\n"
    "                invariants, solver, settings, changes, all\n"
    "save FOLDER     write the samples so far to a folder, as hamflow run does; save! replaces an existing run\n"
    "reset           return to the start; the settings are kept\n"
    "reverse         negate the momenta\n"
    "help            print this list\n"
    "quit            end the session; the end of the input does the same\n";
const std::vector<std::string> words{"step",  "dt",      "tol",   "method", "show", "save",
                                     "save!", "reverse", "reset", "help",   "quit"};
const std::vector<std::string> topics{"step",       "t",      "q",        "p",       "energy", "error",
                                      "invariants", "solver", "settings", "changes", "all"};

class Shell {
 public:
  Shell(const Scenario& scenario, const ShellOptions& options)
      : session_(scenario),
        samples_(scenario.record_every, scenario.start_q.size()),
        options_(options),
        interactive_(isatty(STDIN_FILENO) == 1),
        prompts_(interactive_ && isatty(STDOUT_FILENO) == 1) {}

  int read_commands() {
    if (prompts_ && !options_.quiet) std::cout << greeting();
    catch_interrupts();
    std::string line;
    for (std::int64_t number = 1; next_line(line); ++number) {
      if (interrupted() && !interactive_) return exit_interrupted;
      const int status = obey(line);
      std::cout.flush();
      if (quit_) return exit_done;
      if (status == exit_done || interactive_) continue;
      if (status == exit_interrupted) return status;
      std::cerr << fmt::format("error: stopped at line {}: {}\n", number, line);
      return status;
    }
    if (prompts_) std::cout << '\n';
    return interrupted() && !interactive_ ? exit_interrupted : exit_done;
  }

 private:
  std::string greeting() const {
    return fmt::format("{}, {}, dt = {}; help lists the commands\n", session_.request().problem, session_.method().name,
                       session_.request().dt);
  }

  /// Reads a line; returns false at the end of the input. Ctrl-C at the prompt discards the line.
  bool next_line(std::string& line) {
    for (;;) {
      if (prompts_) {
        std::cout << "hamflow> ";
        std::cout.flush();
      }
      char* text = nullptr;
      std::size_t room = 0;
      errno = 0;
      const ssize_t length = ::getline(&text, &room, stdin);
      const bool was_interrupted = length < 0 && errno == EINTR;
      line.assign(text == nullptr || length < 0 ? "" : text, length < 0 ? 0 : static_cast<std::size_t>(length));
      std::free(text);
      while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.pop_back();
      if (length >= 0) return true;
      if (!was_interrupted || !interactive_) return false;
      std::clearerr(stdin);
      catch_interrupts();
      if (prompts_) std::cout << '\n';
    }
  }

  /// Executes a line and returns its exit status.
  int obey(const std::string& line) {
    // The thesis writes commands as step,,10.
    std::string text = line;
    for (auto at = text.find(",,"); at != std::string::npos; at = text.find(",,")) text.replace(at, 2, " ");
    const auto begin = text.find_first_not_of(" \t");
    if (begin == std::string::npos || text[begin] == '#') return exit_done;
    const auto end = std::min(text.find_first_of(" \t", begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    const auto rest_begin = text.find_first_not_of(" \t", end);
    std::string rest = rest_begin == std::string::npos ? "" : text.substr(rest_begin);
    while (!rest.empty() && (rest.back() == ' ' || rest.back() == '\t')) rest.pop_back();
    return guarded(false, [&] { return carry_out(word, rest); });
  }

  int carry_out(const std::string& word, const std::string& rest) {
    const auto alone = [&] {
      if (!rest.empty()) throw Error(word + ": found '" + rest + "'; allowed no argument");
    };
    const auto with = [&](const char* what) {
      if (rest.empty()) throw Error(word + ": found no argument; allowed " + what);
    };
    if (word == "step") return step(rest);
    if (word == "dt") {
      with("a number other than 0");
      session_.set_step_size(rest);
      outcome_ = Outcome::done;
    } else if (word == "tol") {
      with("a positive number, or off");
      session_.set_tolerance(rest);
      outcome_ = Outcome::done;
    } else if (word == "method") {
      with("a method, e.g. stv4, cg(1,5)");
      session_.set_method(parse_method(rest));
      outcome_ = Outcome::done;
    } else if (word == "show") {
      show(rest);
    } else if (word == "save" || word == "save!") {
      with("a folder");
      save(rest, word == "save!");
    } else if (word == "reset") {
      alone();
      session_.restart();
      samples_.clear();
      warned_.clear();
      outcome_ = Outcome::done;
      seconds_ = 0;
    } else if (word == "reverse") {
      alone();
      session_.negate_momenta();
      outcome_ = Outcome::done;
    } else if (word == "help") {
      std::cout << help_text;
    } else if (word == "quit") {
      alone();
      quit_ = true;
    } else {
      unknown("command", word, words);
    }
    return exit_done;
  }

  [[noreturn]] static void unknown(const std::string& what, const std::string& word,
                                   const std::vector<std::string>& allowed) {
    throw Error("found " + what + " '" + word + "'; allowed " + joined(allowed) + suggestion(word, allowed));
  }

  int step(const std::string& text) {
    std::int64_t count = 1;
    if (!text.empty()) {
      const auto left = static_cast<double>(most_steps - session_.step());
      const OptionInfo steps{.name = "step", .range = Range::whole_from(0, left)};
      if (const std::string refused = refused_value(steps, text); !refused.empty()) throw Error("step: " + refused);
      count = static_cast<std::int64_t>(number_value(text));
    }
    catch_interrupts();
    const std::int64_t first = session_.step();
    const auto began = std::chrono::steady_clock::now();
    Observer* const observers[] = {&samples_, &session_.turns()};
    Outcome outcome = Outcome::done;
    const std::int64_t spacing = samples_.every();
    {
      Progress progress(0, count, options_.quiet || !interactive_);
      outcome = run(session_, first + count, observers, [&](std::int64_t now) {
        progress.show(now - first);
        return !interrupted();
      });
    }
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    if (samples_.every() != spacing && !options_.quiet) {
      std::cerr << "note: the samples exceed the limit; from now on only every " << samples_.every()
                << "th step is kept\n";
    }
    outcome_ = Outcome::done;
    warn();
    if (outcome == Outcome::done) return exit_done;
    if (outcome == Outcome::stopped) {
      std::cerr << fmt::format("stopped by Ctrl-C at step {}\n", session_.step());
      catch_interrupts();
      return exit_interrupted;
    }
    outcome_ = outcome;
    if (const auto error = session_summary(session_, last()).error) print_error(error->message, error->hint);
    return exit_failed;
  }

  /// Prints new warnings. A warning of one kind is printed once until reset.
  void warn() {
    std::vector<Warning> fresh;
    const Summary summary = session_summary(session_, last());
    for (const Warning& warning : summary.warnings) {
      if (std::find(warned_.begin(), warned_.end(), warning.kind) != warned_.end()) continue;
      warned_.push_back(warning.kind);
      fresh.push_back(warning);
    }
    print_warnings(warning_lines(fresh));
  }

  SessionOutcome last() const { return {outcome_, seconds_}; }

  Json shown(const std::string& topic) const {
    Frame now;
    session_.look(now);
    const Excursion energy = session_.energy();
    // With more digits than double, doubles would show a difference of 0 and an inexact state. So the texts are used.
    const bool in_digits = !now.digits.q.empty();
    const double error =
        in_digits ? static_cast<double>(differences_from_first({now.digits.initial_energy, now.digits.energy}).back())
                  : now.energy - energy.initial;
    const auto number = [&](double x, const std::string& text) { return in_digits ? Json(text) : Json(x); };
    const auto list = [&](const std::vector<double>& x, const std::vector<std::string>& texts) {
      return in_digits ? Json(texts) : Json(x);
    };
    Json all = Json::object();
    const auto wants = [&](const char* name) { return topic == name || topic == "all"; };
    if (wants("step")) all["step"] = now.step;
    if (wants("t") || topic.empty()) all["t"] = number(now.time, now.digits.time);
    if (wants("q") || topic.empty()) all["q"] = list(now.q, now.digits.q);
    if (wants("p") || topic.empty()) all["p"] = list(now.p, now.digits.p);
    if (wants("energy") || topic.empty()) all["energy"] = number(now.energy, now.digits.energy);
    if (wants("error") || topic.empty()) all["energy_error"] = error;
    if (wants("error")) {
      all["max_energy_error"] = energy.max_error;
      all["energy_scale"] = session_.energy_scale();
    }
    if (wants("invariants")) show_invariants(all);
    if (wants("solver")) show_solver(now.effort, all);
    if (wants("settings")) show_settings(all);
    if (wants("changes")) show_changes(all);
    return all;
  }

  void show_invariants(Json& all) const {
    const auto shown = [](double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); };
    const Summary summary = session_summary(session_, last());
    for (const InvariantSummary& each : summary.invariants) {
      Json numbers = each.seen.final_digits;
      if (numbers.empty()) std::ranges::transform(each.seen.final, std::back_inserter(numbers), shown);
      all[each.name] = each.is_list ? numbers : numbers.at(0);
      const std::optional<LongNumber> error = each.max_error();
      all["max_error_" + each.name] = !error ? Json(nullptr) : error->text.empty() ? shown(*error) : Json(error->text);
    }
  }

  void show_changes(Json& all) const {
    all["changes"] = Json::array();
    for (const SessionChange& c : session_.changes()) {
      all["changes"].push_back({{"step", c.step}, {"t", c.time}, {"what", c.what}});
    }
  }

  void show_solver(const Effort& effort, Json& all) const {
    all["force"] = effort.force;
    all["gradient"] = effort.gradient;
    all["hessian"] = effort.hessian;
    all["linear_solves"] = effort.linear_solves;
    if (session_.method().explicit_step) return;
    all["solves_min"] = effort.solves_min;
    all["solves_max"] = effort.solves_max;
    all["stagnated"] = effort.stagnated;
    all["halved"] = effort.halved;
  }

  void show_settings(Json& all) const {
    const Request& request = session_.request();
    all["problem"] = request.problem;
    all["method"] = session_.method().name;
    all["dt"] = evaluate_number<double>(request.dt);
    const std::vector<OptionInfo>& options = find_method(request.method.name).family->options;
    if (const OptionInfo* const tolerance = find_option(options, tolerance_option)) {
      const auto given = request.method.options.find(tolerance->name);
      const std::string text = given == request.method.options.end() ? tolerance->default_value : given->second;
      all[tolerance->name] = text.empty() ? Json("off") : Json(number_value(text));
    }
    all["arithmetic"] = request.arithmetic;
    all["record_every"] = samples_.every();
  }

  static std::string text_of(const Json& value) {
    if (value.is_null()) return "nan";
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number_float()) return fmt::format("{:.17g}", value.get<double>());
    if (value.is_object()) return "step " + text_of(value["step"]) + ": " + text_of(value["what"]);
    if (!value.is_array()) return value.dump();
    return "[" + joined(value, text_of) + "]";
  }

  void show(const std::string& topic) const {
    if (!topic.empty() && std::find(topics.begin(), topics.end(), topic) == topics.end()) {
      unknown("topic", topic, topics);
    }
    const Json all = shown(topic);
    if (options_.json) {
      std::cout << all.dump(-1, ' ', false, Json::error_handler_t::replace) << '\n';
      return;
    }
    const auto pair = [](const auto& item) { return item.key() + " = " + text_of(item.value()); };
    const std::string line = joined(all.items(), pair, "  ");
    std::cout << (line.empty() ? "none" : line) << '\n';
  }

  void save(const std::string& name, bool replace) {
    const std::filesystem::path folder = name;
    if (std::filesystem::exists(folder) && !replace) {
      throw FileError("the folder " + name + " exists; to replace the run in it, use save! " + name);
    }
    save_session(session_, samples_, last(), folder, replace);
    if (prompts_ && !options_.quiet) std::cout << "written to " << name << '\n';
  }

  Session session_;
  SampleKeeper samples_;
  const ShellOptions& options_;
  bool interactive_;  // input from a terminal: after an error the user can type another line
  bool prompts_;
  bool quit_ = false;
  Outcome outcome_ = Outcome::done;  // result of the last step command
  double seconds_ = 0;
  std::vector<std::string> warned_;  // kinds of the warnings that were printed
};

}  // namespace

int shell_command(const ShellOptions& options) {
  return guarded(options.json, [&] {
    const Scenario scenario = accepted(read_scenario(options.scenario, options.sets));
    print_notes(scenario.notes, options.quiet);
    print_notes(unused_measures(scenario, "a session only takes the steps that are typed"), options.quiet);
    print_notes(unused_figures(scenario, "a session draws no figures; use save and hamflow plot"), options.quiet);
    if (!scenario.record.empty())
      print_notes({run_path(run_keys().record) + " is not used: a session records by number of steps"}, options.quiet);
    return Shell(scenario, options).read_commands();
  });
}

}  // namespace hamflow::app
