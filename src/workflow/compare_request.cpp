// Reads and checks a request for a comparison: the methods and step sizes that are given with a scenario.
#include <algorithm>
#include <cmath>

#include "engine/large_steps.hpp"
#include "gas_checks.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/detail/core/option_names.hpp"
#include "hamflow/detail/run/fitting_methods.hpp"
#include "hamflow/methods/step_control.hpp"
#include "hamflow/scenario/rejection.hpp"
#include "hamflow/workflow/compare.hpp"
#include "method_keys.hpp"
#include "run_keys.hpp"
#include "unused_keys.hpp"
#include "wall_checks.hpp"

namespace hamflow {

namespace {

/// Reads methods and steps into a request and collects notes and complaints.
class RequestReader {
 public:
  RequestReader(const Scenario& scenario, const ComparisonInput& input)
      : scenario_(scenario), varies_by_file_(describe(scenario.request.method).varies_steps) {
    SharedMethodKeys shared(input.text, input.sets);
    read_methods(input.methods, shared);
    if (varies_by_file_) {
      const std::string key = std::string("method.") + step_control_option;
      complain_of(key, "found \"" + std::string(reversible_steps) + "\"; allowed " + fixed_steps + ", e.g. by " +
                           set_option(key, fixed_steps) +
                           ": all runs of a comparison must end at the same time, which steps of varying size do not");
    }
    request.request = scenario.request;
    request.t_end = scenario.dt * static_cast<double>(scenario.steps);
    request.t_end_text = "(" + scenario.request.dt + ")*" + std::to_string(scenario.steps);
    if (!(std::abs(request.t_end) > 0)) {
      const std::string t_end = run_path(run_keys().t_end);
      complain_of(scenario.settings.contains(t_end) ? t_end : run_path(run_keys().steps),
                  "found a run of length 0; allowed a run with at least one step");
    } else {
      read_steps(input.dts);
    }
    const std::vector<std::string> unused = shared.notes(request.steps.size() == 1);
    notes.insert(notes.begin(), unused.begin(), unused.end());
  }

  ComparisonRequest request;
  std::vector<std::string> notes;
  std::vector<Complaint> complaints;

 private:
  void complain(const std::string& key, const std::string& message) {
    complaints.push_back({scenario_.file, 0, 0, key, message});
  }
  /// Complains about a key of the file, with its line and column if the key is in the file.
  void complain_of(const std::string& key, const std::string& message) {
    const auto set = scenario_.settings.find(key);
    const bool in_file = set != scenario_.settings.end();
    complaints.push_back(
        {scenario_.file, in_file ? set->second.line : 0, in_file ? set->second.column : 0, key, message});
  }

  void read_methods(const std::vector<std::string>& all, SharedMethodKeys& shared) {
    if (all.empty()) complain(option_name("methods"), "missing; allowed at least one, such as cg(1,5)");
    for (const std::string& name : all) {
      try {
        MethodSpec method = parse_method(name);
        if (!varies_by_file_) shared.add_to(method, name);
        std::string why_not;
        auto refused = refused_option(method);
        if (!refused) refused = refused_option(method, scenario_.start_q.size());
        if (refused) why_not = "method." + refused->name + ": " + refused->message;
        if (why_not.empty())
          why_not = refusal_with_advice(method, scenario_.problem.get(), scenario_.request.arithmetic);
        if (why_not.empty()) why_not = refusal(method, *scenario_.problem);
        Request one = scenario_.request;
        one.method = method;
        if (why_not.empty()) why_not = refused_walls(one);
        if (why_not.empty()) why_not = refused_by_size(one, scenario_.start_q.size());
        if (why_not.empty() && describe(method).varies_steps) {
          why_not = "allowed step_control=fixed, because steps of varying size do not end at the same time";
        }
        if (why_not.empty()) {
          request.methods.push_back(method);
          for (const ReplacedOption& replaced : replaced_options(method, scenario_.start_q.size())) {
            notes.push_back("'" + name + "': " + replaced.name + " = " + replaced.message);
          }
        } else {
          complain(option_name("methods"), "found '" + name + "'; " + why_not);
        }
      } catch (const Error& error) {
        const std::string what = error.what();
        complain(option_name("methods"), what.starts_with("found") ? what : "found '" + name + "'; " + what);
      }
    }
    if (complaints.empty()) refuse_duplicate_methods(all);
  }

  /// Refuses a method that is given twice, because rows are identified by the names of their methods.
  void refuse_duplicate_methods(const std::vector<std::string>& typed) {
    const std::vector<std::string> names = comparison_names(request.methods);
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto first = static_cast<std::size_t>(std::find(names.begin(), names.end(), names[i]) - names.begin());
      if (first < i)
        complain(option_name("methods"), "found '" + typed[i] + "' and '" + typed[first] +
                                             "', the same method with the same options; allowed once");
    }
  }

  std::string refused_walls(const Request& one) const {
    const std::string why_not = refused_by_walls(one, *scenario_.problem, scenario_.start_q);
    return why_not.empty() ? "" : "problem.wall_rule = \"" + rule_of_walls(one) + "\" " + why_not;
  }

  /// Keeps the text of dt if it divides the time exactly. Then the run is bit for bit a single run with this dt.
  void keep_dt(std::int64_t steps, const std::string& dt) {
    if (divides_exactly(dt, steps, request.t_end_text, request.request.arithmetic)) request.dts.emplace(steps, dt);
  }

  /// Finds for each dt the nearest number of steps that ends at t_end.
  void read_steps(const std::vector<std::string>& dts) {
    if (dts.empty()) {
      request.steps = usual_step_counts(scenario_.steps);
      for (const std::int64_t steps : request.steps) {  // dt times a power of 2 is exact in every arithmetic
        if (steps % scenario_.steps == 0) {
          keep_dt(steps, "(" + scenario_.request.dt + ")/" + std::to_string(steps / scenario_.steps));
        } else if (scenario_.steps % steps == 0) {
          keep_dt(steps, "(" + scenario_.request.dt + ")*" + std::to_string(scenario_.steps / steps));
        }
      }
      return;
    }
    for (const std::string& part : dts) {
      double dt = 0;
      bool backwards = false;
      try {
        const double given = evaluate_number<double>(part);
        backwards = given * request.t_end < 0;
        dt = std::abs(given);
      } catch (const Error& error) {
        complain(option_name("dt"), "found '" + part + "'; allowed numbers (" + error.what() + ")");
        continue;
      }
      const double count = std::round(std::abs(request.t_end) / dt);
      if (!(dt > 0) || !(count < 0x1p53)) {
        complain(option_name("dt"), "found '" + part +
                                        "'; allowed a number other than 0 with fewer than 2^53 steps to " +
                                        "t_end = " + shortest(request.t_end));
        continue;
      }
      if (backwards && part.find('-') != std::string::npos) {
        notes.push_back("dt = " + part + " leads away from t_end = " + shortest(request.t_end) +
                        "; dt = " + shortest(dt) + " is used");
      }
      const auto steps = std::max<std::int64_t>(1, static_cast<std::int64_t>(count));
      const double fitting = std::abs(request.t_end) / static_cast<double>(steps);
      if (std::abs(fitting - dt) > 1e-9 * dt) {
        notes.push_back("dt = " + part + " does not divide t_end = " + shortest(request.t_end) +
                        "; dt = " + shortest(fitting) + " is used");
      }
      request.steps.push_back(steps);
      keep_dt(steps, (evaluate_number<double>(part) * request.t_end < 0 ? "-(" : "(") + part + ")");
    }
    std::sort(request.steps.begin(), request.steps.end());
    request.steps.erase(std::unique(request.steps.begin(), request.steps.end()), request.steps.end());
  }

  const Scenario& scenario_;
  const bool varies_by_file_;
};

/// Returns a method as a TOML table, including the options that it takes from [method] of the scenario.
std::string as_table(const std::string& name, SharedMethodKeys& shared) {
  std::string table = "{ " + method_name_key().name + " = \"" + name + "\"";
  try {
    const MethodSpec own = parse_method(name);
    MethodSpec method = own;
    shared.add_to(method, name);
    for (const OptionInfo& option : find_method(method.name).family->options) {
      if (own.options.contains(option.name) || !method.options.contains(option.name)) continue;
      table += ", " + option.name + " = " + toml_text(option, method.options.at(option.name));
    }
  } catch (const Error&) {  // the reader of scenarios reports this error
  }
  for (const std::string& key : shared.unknown()) table += ", \"" + key + "\" = 0";
  return table + " }";
}

/// Reads the scenario with any method of the comparison that it allows, because the file's own method is not run and
/// may be wrong. An error that occurs with every method is an error of the scenario; an error that occurs with only one
/// method is an error of that method.
Scenario scenario_with_any(const ComparisonInput& input, std::vector<std::string>& notes) {
  const Reading own = read_scenario_text(input.text, input.name, input.sets);
  if (own.scenario) return *own.scenario;
  std::vector<Complaint> of_all = own.complaints;
  std::vector<Complaint> of_methods;
  SharedMethodKeys shared(input.text, input.sets);
  for (const std::string& name : input.methods) {
    // the text is not a name
    if (name.empty() || name.find_first_of("\"\\\n") != std::string::npos) return accepted(own);
    std::vector<std::string> sets = input.sets;
    sets.push_back("method=" + as_table(name, shared));
    const Reading with = read_scenario_text(input.text, input.name, sets);
    if (with.scenario) {
      const Complaint& first = own.complaints.front();
      notes.push_back("the comparison does not run the method of the file, which would be refused: " + first.key +
                      ": " + first.message);
      return *with.scenario;
    }
    const auto is_there = [](const std::vector<Complaint>& all, const Complaint& one) {
      return std::any_of(all.begin(), all.end(), [&](const Complaint& other) { return other.text() == one.text(); });
    };
    std::erase_if(of_all, [&](const Complaint& one) { return !is_there(with.complaints, one); });
    for (const Complaint& one : with.complaints) {
      if (is_there(own.complaints, one)) continue;
      const bool names_it = one.key == "method." + method_name_key().name;
      const std::size_t behind = one.message.find("; ");
      const std::string why = names_it && one.message.starts_with("found") && behind != std::string::npos
                                  ? one.message.substr(behind + 2)
                                  : (names_it ? "" : one.key + ": ") + one.message;
      of_methods.push_back({one.file, 0, 0, option_name("methods"), "found '" + name + "'; " + why});
    }
  }
  of_all.insert(of_all.end(), of_methods.begin(), of_methods.end());
  throw Rejection(of_all.empty() ? own.complaints : of_all);
}

}  // namespace

ComparisonReading read_comparison(const ComparisonInput& input) {
  ComparisonReading reading;
  std::vector<std::string>& notes = reading.notes;
  const auto add = [&](const std::vector<std::string>& more) { notes.insert(notes.end(), more.begin(), more.end()); };
  const Scenario scenario = scenario_with_any(input, notes);
  RequestReader reader(scenario, input);
  // The reader below reports unused keys of [method] for the methods that are compared.
  std::vector<std::string> of_scenario = scenario.notes;
  std::erase_if(of_scenario, [](const std::string& note) { return note.starts_with("method."); });
  add(of_scenario);
  add(unused_measures(scenario, "a comparison only measures energies and final states"));
  add(unused_figures(scenario, "a comparison draws its figure with " + option_name("figure")));
  add(reader.notes);
  reading.complaints = std::move(reader.complaints);
  if (!reading.complaints.empty()) return reading;
  add(comparison_notes(reader.request));
  reading.request = std::move(reader.request);
  return reading;
}

}  // namespace hamflow
