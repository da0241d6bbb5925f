// hamflow convert: states, scenarios and runs in the other coordinates of their problem.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>

#include "commands.hpp"
#include "coordinates.hpp"
#include "figure_kinds.hpp"
#include "hamflow/core/text.hpp"
#include "run_copy.hpp"
#include "run_file.hpp"
#include "run_folder.hpp"
#include "run_keys.hpp"
#include "scenario_edit.hpp"
#include "summary.hpp"

namespace hamflow::app {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// A scenario that is not accepted; each complaint is a line.
class Rejection : public Error {
 public:
  explicit Rejection(std::vector<Complaint> all) : Error("the scenario is not accepted"), complaints(std::move(all)) {}
  std::vector<Complaint> complaints;
};

const Scenario& accepted(const Reading& reading) {
  if (!reading.scenario) throw Rejection(reading.complaints);
  return *reading.scenario;
}

void print(const std::string& text, const std::string& output) {
  if (output.empty()) {
    std::cout << text;
  } else {
    write_text(output, text);
  }
}

Json state_json(const std::string& system, const CanonicalState& state) {
  return {{"coordinates", system}, {"q", state.q}, {"p", state.p}};
}

std::string row(const std::vector<double>& numbers) {
  return "[" + joined(numbers, [](double x) { return fmt::format("{:.17g}", x); }) + "]";
}

std::vector<double> numbers_of(const std::string& option, const std::string& text) {
  std::vector<double> numbers;
  try {
    for (const std::string& part : list_parts("[" + text + "]")) numbers.push_back(evaluate_number<double>(part));
  } catch (const Error& error) {
    throw Error(option + ": found '" + text + "'; allowed numbers with commas between, e.g. 1,0 (" + error.what() +
                ")");
  }
  return numbers;
}

int convert_given_state(const ConvertOptions& options) {
  if (!options.input.empty()) throw Error("found both INPUT and --from; allowed one of them");
  if (options.from.empty() || options.q.empty() || options.p.empty()) {
    throw Error(
        "found neither INPUT nor a whole state; allowed INPUT --to ..., or --from ... --to ... --q ... --p ...");
  }
  if (!options.sets.empty()) throw Error("found --set beside a state; allowed with a scenario");
  StateConverter convert(options.from, options.to);
  const CanonicalState state = convert({numbers_of("--q", options.q), numbers_of("--p", options.p)});
  print(
      options.json ? json_text(state_json(options.to, state)) : "q = " + row(state.q) + "\np = " + row(state.p) + "\n",
      options.output);
  return exit_done;
}

/// The text of a scenario with its coordinates changed. An orbit or two bodies mean the same in both.
std::string converted_text(const Scenario& scenario, const std::string& to, const CanonicalState& start) {
  std::vector<ScenarioEdit> edits{{"problem." + scenario.problem->info.chart_key, "\"" + to + "\""}};
  if (!scenario.request.start.geometric() && !scenario.bodies) {
    edits.push_back({"problem.initial", "{ q = " + toml_list(start.q) + ", p = " + toml_list(start.p) + " }"});
  }
  if (scenario.section) {  // of a coordinate that is there no more
    edits.push_back({run_path(run_keys().section), {}});
    std::vector<std::string> others = scenario.figures;
    const FigureFacts without_section{.diagnostics = true, .section = false};
    std::erase_if(others, [&](const std::string& kind) { return !refused_figure(kind, without_section).empty(); });
    const std::string list = joined(others, [](const std::string& kind) { return "\"" + kind + "\""; });
    if (!scenario.figures.empty()) edits.push_back({output_path(output_keys().figures), "[" + list + "]"});
  }
  return edited_scenario(scenario.text, edits);
}

/// Why the scenario's method cannot run in the new coordinates; empty if it can.
std::string refused_method(const Scenario& scenario, const std::string& to) {
  return refusal(scenario.request.method, in_coordinates(*scenario.problem, to));
}

int convert_scenario(const ConvertOptions& options) {
  const Reading reading = read_scenario(options.input, options.sets);
  const Scenario& scenario = accepted(reading);
  const ProblemEntry& target = in_coordinates(*scenario.problem, options.to);
  const std::string from = coordinates_of(*scenario.problem);
  const CanonicalState start = StateConverter(*scenario.problem, target)({scenario.start_q, scenario.start_p});
  if (options.json) {
    print(json_text(state_json(options.to, start)), options.output);
    return exit_done;
  }
  const std::string why_not = refused_method(scenario, options.to);
  if (!why_not.empty()) {
    throw Error("in " + options.to + " coordinates " + why_not + "; give one of them with --set method.name=...");
  }
  const std::string text = converted_text(scenario, options.to, start);
  (void)accepted(read_scenario_text(text, "the converted scenario", {}));
  print("# Converted by hamflow convert from " + from + " to " + options.to + " coordinates.\n" + text, options.output);
  if (scenario.text.find('#') != std::string::npos) {
    std::cerr << "note: comments of " << options.input << " are not in the converted text\n";
  }
  return exit_done;
}

/// Every sample of a run, converted.
class ConvertedRun {
 public:
  ConvertedRun(const fs::path& file, const std::string& to) : file_(file), to_(to), samples_(read_run_file(file)) {
    const std::string& text = samples_.description.scenario;
    reading_ = read_scenario_text(text, file.string(), sets_of(text));
    if (!reading_.scenario) {
      throw FileError("the scenario in " + file.string() + " is damaged: " + reading_.complaints.front().text());
    }
    target_ = &in_coordinates(*scenario().problem, to);
    from_ = coordinates_of(*scenario().problem);
    StateConverter convert(*scenario().problem, *target_);
    for (std::size_t k = 0; k < samples_.t.size(); ++k) {
      try {
        const CanonicalState state = convert(state_at(k));
        for (std::size_t i = 0; i < state.q.size(); ++i) {
          samples_.q[i][k] = state.q[i];
          samples_.p[i][k] = state.p[i];
        }
      } catch (const Error& error) {
        throw Error(fmt::format("sample {}, t = {}: {}", k, shortest(samples_.t[k]), error.what()));
      }
    }
    turn_ = std::max(convert.largest_turn(), fastest_turn(convert.turning()));
    for (const std::size_t i : convert.turning()) {
      turning_ += (turning_.empty() ? "" : ", ") + target_->info.coordinates[i];
    }
  }

  std::string csv() const {
    std::string text = "t";
    for (const char* name : {"q", "p"}) {
      for (std::size_t i = 1; i <= samples_.q.size(); ++i) text += fmt::format(",{}{}", name, i);
    }
    text += ",energy\n";
    for (std::size_t k = 0; k < samples_.t.size(); ++k) {
      const CanonicalState s = state_at(k);
      text += fmt::format("{:.17g}", samples_.t[k]);
      for (const double x : s.q) text += fmt::format(",{:.17g}", x);
      for (const double x : s.p) text += fmt::format(",{:.17g}", x);
      text += fmt::format(",{:.17g}\n", samples_.energy[k]);
    }
    return text;
  }
  std::string json() const {
    Json all{{"coordinates", to_}, {"t", samples_.t}, {"q", Json::array()}, {"p", Json::array()}};
    for (std::size_t k = 0; k < samples_.t.size(); ++k) {
      all["q"].push_back(state_at(k).q);
      all["p"].push_back(state_at(k).p);
    }
    all["energy"] = samples_.energy;
    return json_text(all);
  }
  void write_h5(const fs::path& target) const {
    const CanonicalState start =
        StateConverter(*scenario().problem, *target_)({scenario().start_q, scenario().start_p});
    std::string text =
        "# Samples of a run in " + from_ + " coordinates, converted by hamflow convert to " + to_ + ".\n";
    const std::string same_settings = converted_text(scenario(), to_, start);
    if (read_scenario_text(same_settings, "the converted scenario", {}).scenario) {
      text += same_settings;
    } else {
      const std::string method = samples_.description.method;
      text += "# They were computed by " + method + ", with settings that these coordinates do not allow.\n";
      std::cerr << "note: the samples were computed by " << method << " with settings that " << to_
                << " coordinates do not allow; the scenario in " << target.string() << " names cg in double instead\n";
      Scenario changed = scenario();
      changed.text = edited_scenario(
          changed.text,
          {{"method", "{ name = \"cg\" }"},
           {run_path(run_keys().arithmetic), {}},
           {run_path(run_keys().lattice), {}},
           {run_path(run_keys().kernel), {}}});
      text += converted_text(changed, to_, start);
    }
    (void)accepted(read_scenario_text(text, "the converted scenario", {}));
    copy_run_file(file_, target, text, samples_.q, samples_.p);
  }
  /// The largest change between two samples of an angle whose whole turns they do not show.
  double turn() const { return turn_; }
  const std::string& turning() const { return turning_; }

 private:
  const Scenario& scenario() const { return *reading_.scenario; }
  /// The rate of such an angle times the time to the next sample, at most: it shows whole turns.
  double fastest_turn(const std::vector<std::size_t>& angles) const {
    double most = 0;
    for (std::size_t k = 0; k + 1 < samples_.t.size() && !angles.empty(); ++k) {
      const CanonicalState s = state_at(k);
      const std::vector<double> rates = target_->rates(scenario().request.parameters, s.q, s.p);
      for (const std::size_t i : angles) {
        most = std::max(most, std::abs(rates[i] * (samples_.t[k + 1] - samples_.t[k])));
      }
    }
    return most;
  }
  CanonicalState state_at(std::size_t k) const {
    CanonicalState state;
    for (std::size_t i = 0; i < samples_.q.size(); ++i) {
      state.q.push_back(samples_.q[i][k]);
      state.p.push_back(samples_.p[i][k]);
    }
    return state;
  }

  fs::path file_;
  std::string to_;
  std::string from_;
  const ProblemEntry* target_ = nullptr;  // the problem in the coordinates `to`
  RunSamples samples_;
  Reading reading_;
  double turn_ = 0;
  std::string turning_;
};

int convert_run(const ConvertOptions& options) {
  if (!options.sets.empty()) throw Error("found --set beside a run; allowed with a scenario");
  const std::string extension = fs::path(options.output).extension().string();
  const bool known = extension == ".h5" || extension == ".csv" || (options.json && extension == ".json");
  if (!options.output.empty() && !known) {
    throw Error("-o: found '" + options.output + "'; allowed a file .h5 or .csv, or .json with --json");
  }
  const fs::path input = options.input;
  const fs::path file = fs::is_directory(input) ? input / "run.h5" : input;
  const ConvertedRun run(file, options.to);
  if (run.turn() > 2) {
    std::cerr << fmt::format(
        "note: {} changes by up to {:.3g} from one sample to the next; where that is more than half a turn, "
        "turns are missing\n",
        run.turning(), run.turn());
  }
  if (extension == ".h5") {
    run.write_h5(options.output);
  } else {
    print(options.json ? run.json() : run.csv(), options.output);
  }
  return exit_done;
}

/// A folder or an HDF5 file is a run, whatever it is called.
bool is_run(const fs::path& input) {
  if (fs::is_directory(input)) return true;
  std::ifstream in(input, std::ios::binary);
  char mark[4] = {};
  in.read(mark, sizeof mark);
  return std::string(mark, sizeof mark) == "\x89HDF";
}

int failed(const ConvertOptions& options, int status, const std::string& message) {
  std::cerr << "error: " << message << '\n';
  if (options.json) {
    const char* const word = status == exit_rejected ? "rejected" : "failed";
    std::cout << json_text({{"status", word}, {"errors", {{{"key", ""}, {"message", message}}}}});
  }
  return status;
}

}  // namespace

int convert_coordinates(const ConvertOptions& options) {
  try {
    check_coordinates(options.to);
    if (options.input.empty() || !options.from.empty()) return convert_given_state(options);
    if (!options.q.empty() || !options.p.empty()) throw Error("found --q or --p beside INPUT; allowed with --from");
    std::error_code none;
    if (!options.output.empty() && fs::equivalent(options.input, options.output, none)) {
      throw Error("-o: found the input itself; allowed another file");
    }
    return is_run(options.input) ? convert_run(options) : convert_scenario(options);
  } catch (const Rejection& rejection) {
    for (const Complaint& complaint : rejection.complaints) std::cerr << complaint.text() << '\n';
    if (options.json) std::cout << json_text(rejection_of(rejection.complaints));
    return exit_rejected;
  } catch (const FileError& error) {
    return failed(options, exit_file, error.what());
  } catch (const fs::filesystem_error& error) {
    return failed(options, exit_file, error.what());
  } catch (const Error& error) {
    return failed(options, exit_rejected, error.what());
  }
}

}  // namespace hamflow::app
