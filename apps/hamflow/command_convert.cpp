// hamflow convert: converts states, scenarios and runs to other coordinates of their problem.
#include <filesystem>
#include <iostream>

#include "commands.hpp"
#include "guarded.hpp"
#include "hamflow/core/number.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/workflow/convert.hpp"

namespace hamflow::app {

namespace {

namespace fs = std::filesystem;

void print(const std::string& text, const std::string& output) {
  if (output.empty()) {
    std::cout << text;
  } else {
    write_file(output, text);
  }
}

std::vector<double> numbers_of(const std::string& option, const std::string& text) {
  std::vector<double> numbers;
  try {
    for (const std::string& part : list_parts("[" + text + "]")) numbers.push_back(evaluate_number<double>(part));
  } catch (const Error& error) {
    throw Rejection(option,
                    "found '" + text + "'; allowed numbers separated by commas, e.g. 1,0 (" + error.what() + ")");
  }
  return numbers;
}

void convert_given_state(const ConvertOptions& options) {
  if (!options.input.empty()) throw Error("found both INPUT and --from; allowed one of them");
  if (options.from.empty() || options.q.empty() || options.p.empty()) {
    throw Error(
        "found neither INPUT nor a complete state; allowed INPUT --to ..., or --from ... --to ... --q ... --p ...");
  }
  if (!options.sets.empty()) throw Rejection("--set", "found --set with a state; allowed with a scenario");
  const CanonicalState given{numbers_of("--q", options.q), numbers_of("--p", options.p)};
  StateConverter convert(options.from, options.to, given.q.size());
  const CanonicalState state = convert(given);
  convert.require_on_constraints(given);
  print(options.json ? state_json(options.to, state) : state_text(state), options.output);
}

void note_left_out(const std::string& keys, const std::string& where) {
  if (!keys.empty()) print_notes({"left out of " + where + ": " + keys + " (written in the old coordinates)"}, false);
}

void convert_scenario(const ConvertOptions& options) {
  const std::string extension = fs::path(options.output).extension().string();
  if (extension == ".h5" || extension == ".csv") {
    throw Rejection("-o", "found '" + options.output +
                              "'; allowed a file .toml, or .json with --json: " + options.input + " is a scenario");
  }
  // method.* is set in the converted scenario. For problems with constraints no method is allowed in both coordinates,
  // so it must not be set in the original one.
  std::vector<std::string> of_problem = options.sets;
  std::vector<std::string> of_method;
  std::erase_if(of_problem, [&](const std::string& set) {
    const bool is_method = set.starts_with("method.") || set.starts_with("method=");
    if (is_method) of_method.push_back(set);
    return is_method;
  });
  const Scenario scenario = accepted(read_scenario(options.input, of_problem));
  if (options.json) {
    // The state that is printed has no method, but a wrong method.* has to be refused.
    if (!of_method.empty()) (void)converted_scenario(scenario, options.to, of_method);
    print(converted_start_json(scenario, options.to), options.output);
    return;
  }
  const ConvertedScenario converted = converted_scenario(scenario, options.to, of_method);
  print(converted.text, options.output);
  print_notes(converted.notes, false);
  if (scenario.text.find('#') != std::string::npos) {
    print_notes({"the comments of " + options.input + " were not copied"}, false);
  }
  note_left_out(left_out_of_converted(scenario, options.to), "the converted scenario");
}

void convert_run(const ConvertOptions& options) {
  if (!options.sets.empty()) throw Rejection("--set", "found --set with a run; allowed with a scenario");
  const std::string extension = fs::path(options.output).extension().string();
  const bool known = options.json ? extension == ".json" : extension == ".h5" || extension == ".csv";
  if (!options.output.empty() && !known) {
    throw Error(
        "-o: found '" + options.output + "'" +
        (options.json ? " with --json; allowed a file .json" : "; allowed a file .h5 or .csv, or .json with --json"));
  }
  const ConvertedRun run(options.input, options.to);
  if (!run.note().empty()) print_notes({run.note()}, false);
  if (extension == ".h5") {
    const std::string note = run.write_h5(options.output);
    if (!note.empty()) print_notes({note}, false);
    note_left_out(run.left_out(), "the scenario in " + options.output);
  } else {
    print(options.json ? run.json() : run.csv(), options.output);
    print_notes(
        {"the columns " + joined(run.columns_left_out()) + " of the run were left out; with -o FILE.h5 they are kept"},
        false);
  }
}

}  // namespace

int convert_command(const ConvertOptions& options) {
  return guarded(options.json, [&] {
    check_coordinates(options.to);
    if (options.input.empty() || !options.from.empty()) {
      convert_given_state(options);
      return exit_done;
    }
    if (!options.q.empty() || !options.p.empty())
      throw Rejection("--q", "found --q or --p together with INPUT; allowed with --from");
    require_folder_of(options.output);
    std::error_code none;
    if (!options.output.empty() && fs::equivalent(options.input, options.output, none)) {
      throw Rejection("-o", "found the input file itself; allowed another file");
    }
    if (is_run(options.input)) {
      convert_run(options);
    } else {
      convert_scenario(options);
    }
    return exit_done;
  });
}

}  // namespace hamflow::app
