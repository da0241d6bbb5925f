// Reads [run]: length, step size, arithmetic and samples.
#include <algorithm>
#include <cmath>

#include "hamflow/detail/run/fitting_methods.hpp"
#include "hamflow/run/socket.hpp"
#include "run_keys.hpp"
#include "scenario_reader.hpp"

namespace hamflow {

namespace {

/// Returns the number of values in a sample: positions and momenta, and velocities for particles.
std::size_t numbers_of_sample(const Scenario& scenario) {
  return scenario.start_q.size() * (scenario.problem != nullptr && scenario.problem->particles ? 3 : 2);
}

}  // namespace

void ScenarioReader::read_run(TomlTable& table) {
  const RunKeys& keys = run_keys();
  if (const auto dt = table.text(keys.dt)) {
    scenario_.dt = number_value(*dt);
    scenario_.request.dt = *dt;
  }
  read_map(table);
  scenario_.certificate = table.yes_no(keys.certificate).value_or(true);
  read_length(table);
  if (!std::isfinite(scenario_.dt * static_cast<double>(scenario_.steps))) {
    table.complain(keys.dt.name,
                   table.found(keys.dt.name) + "; allowed a dt whose product with the number of steps is finite");
  }
  read_samples(table);
  if (const auto every = table.whole(keys.checkpoint_every)) scenario_.checkpoint_every = *every;
  read_arithmetic(table);
  read_measures(table);
  read_threads(table);
  read_lattice(table);
  table.finish(scenario_.problem.get(), scenario_.request.method.name);
}

void ScenarioReader::read_map(TomlTable& table) {
  const RunKeys& keys = run_keys();
  scenario_.map = table.yes_no(keys.map).value_or(false);
  if (!scenario_.map) return;
  if (has_method() && describe(scenario_.request.method).varies_steps) {
    table.complain(keys.map.name, table.found(keys.map.name) + " with steps of varying size; allowed with " +
                                      "step_control = \"fixed\", because all steps of a map are equal");
  }
  if (table.has(keys.record.name)) {
    table.complain(keys.record.name, table.found(keys.record.name) + " with " + keys.map.name + "; allowed " +
                                         keys.record_every.name + ", because a map has no states between its steps");
  }
}

void ScenarioReader::read_threads(TomlTable& table) {
  const RunKeys& keys = run_keys();
  if (const auto threads = table.whole(keys.threads)) {
    scenario_.request.threads = static_cast<int>(*threads);
    if (scenario_.problem != nullptr) {
      const std::string why_not = refused_threads(scenario_.request, *scenario_.problem);
      if (!why_not.empty()) table.complain(keys.threads.name, table.found(keys.threads.name) + "; " + why_not);
    }
  }
}

/// Before everything else, because numbers of a scenario may call functions.
void ScenarioReader::read_functions(TomlTable& table) {
  const OptionInfo& key = run_keys().functions;
  const auto name = table.text(key);
  const FunctionSet wanted = name == "portable" ? FunctionSet::portable : FunctionSet::system;
  scenario_.request.functions = wanted;
  try {
    functions_.emplace(wanted);
  } catch (const Error& error) {
    table.complain(key.name, table.found(key.name) + "; " + error.what());
  }
}

void ScenarioReader::read_arithmetic(TomlTable& table) {
  const OptionInfo& key = run_keys().arithmetic;
  const auto name = table.plain_string(key.name);
  if (!name) {
    (void)table.text(key);  // complains if the value has another type
    return;
  }
  try {
    check_arithmetic(*name);
  } catch (const Error& error) {
    table.complain(key.name, error.what());
    return;
  }
  scenario_.request.arithmetic = *name;
  if (scenario_.request.functions == FunctionSet::portable && digits_beyond_double(*name) > 0) {
    table.complain(run_keys().functions.name, table.found(run_keys().functions.name) + " with " + key.name + " = \"" +
                                                  *name + "\"; allowed with double, compensated, lattice");
  }
  if (scenario_.request.problem == SocketKeys::problem && digits_beyond_double(*name) > 0) {
    table.complain(key.name,
                   table.found(key.name) +
                       "; allowed double, compensated or lattice, because a client sends its forces in double");
  }
  if (scenario_.bodies && digits_beyond_double(*name) > 0) {
    scenario_.request.start.q = start_of_bodies_.q;
    scenario_.request.start.p = start_of_bodies_.p;
  }
  if (digits_beyond_double(*name) > 0) place_bodies(table, *name);
  const std::string why_not =
      has_method() ? refusal_with_advice(scenario_.request.method, scenario_.problem.get(), *name) : "";
  if (!why_not.empty()) table.complain(key.name, table.found(key.name) + "; " + why_not);
}

/// Refuses a key of times if the steps have varying lengths, because t is then a part of the state, and no step ends at
/// a given time. Returns true if it complained.
bool ScenarioReader::refuse_time(TomlTable& table, const std::string& key, const std::string& allowed) {
  if (!table.has(key) || !has_method() || !describe(scenario_.request.method).varies_steps) return false;
  table.complain(key, table.found(key) + " with " + describe(scenario_.request.method).name + "; allowed " + allowed +
                          ", because steps of varying size do not end at a given time");
  return true;
}

void ScenarioReader::read_length(TomlTable& table) {
  const std::string& steps_key = run_keys().steps.name;
  const std::string& end_key = run_keys().t_end.name;
  const bool by_steps = table.has(steps_key);
  const bool by_time = table.has(end_key);
  const auto steps = table.whole(run_keys().steps);
  const auto t_end = table.number(run_keys().t_end);
  if (refuse_time(table, end_key, steps_key)) return;
  if (by_steps && by_time) {
    table.complain(end_key, "found " + steps_key + " and " + end_key + " together; allowed exactly one of them");
  } else if (!by_steps && !by_time) {
    table.missing(steps_key, "exactly one of " + steps_key + ", " + end_key);
  } else if (steps) {
    scenario_.steps = *steps;
  } else if (t_end && scenario_.dt != 0) {
    const double ratio = *t_end / scenario_.dt;
    const double whole = std::round(ratio);
    if (ratio < 0) {
      table.complain(end_key,
                     table.found(end_key) + " with dt = " + shortest(scenario_.dt) + "; allowed the sign of dt");
    } else if (whole > static_cast<double>(most_steps)) {
      table.complain(end_key, table.found(end_key) + "; allowed at most 2^53 steps of dt");
    } else if (std::abs(ratio - whole) > std::max(1e-9, 4 * whole * 0x1p-52) ||  // the quotient is rounded
               (whole == 0 && *t_end != 0)) {
      const double fitting = std::max(whole, 1.0);
      table.complain(end_key, table.found(end_key) + ", which is " + shortest(ratio) +
                                  " steps of dt = " + shortest(scenario_.dt) +
                                  "; allowed a whole number of steps, nearest dt = " + shortest(*t_end / fitting) +
                                  " or " + end_key + " = " + shortest(fitting * scenario_.dt));
    } else {
      scenario_.steps = static_cast<std::int64_t>(whole);
      if (whole == 0) scenario_.notes.push_back(table.full(end_key) + " = 0, so no step is taken");
    }
  }
}

/// Reads the samples: by steps, or at given times. A time belongs to the step before it; a time that equals the time of
/// a step up to rounding belongs to that step.
void ScenarioReader::read_samples(TomlTable& table) {
  const RunKeys& keys = run_keys();
  const auto every = table.whole(keys.record_every);
  scenario_.record_every = every ? *every : default_record_every(scenario_.steps, numbers_of_sample(scenario_) / 2);
  const auto times = table.numbers(keys.record);
  if (!times || refuse_time(table, keys.record.name, keys.record_every.name)) return;
  if (table.has(keys.record_every.name)) {
    table.complain(keys.record.name,
                   "found " + keys.record.name + " and " + keys.record_every.name + " together; allowed one of them");
    return;
  }
  if (scenario_.dt == 0) return;  // another check reports this
  const auto steps = static_cast<double>(scenario_.steps);
  double before = 0;
  for (const std::string& time : *times) {
    const double t = number_value(time);
    const double ratio = t / scenario_.dt;
    const double whole = std::round(ratio);
    const bool at_step = std::abs(ratio - whole) <= 4 * 0x1p-52 * whole;  // time, dt and their quotient are rounded
    const double step = at_step ? whole : std::floor(ratio);
    if (!(step >= 0 && (at_step ? whole <= steps : ratio < steps))) {
      table.complain(keys.record.name,
                     "found the time " + time + "; allowed times from 0 to the end, " + shortest(steps * scenario_.dt));
      return;
    }
    if (!scenario_.record.empty() && !((t - before) * scenario_.dt > 0)) {
      table.complain(keys.record.name,
                     "found the time " + time + " after " + scenario_.record.back() +
                         "; allowed times in the order of the run, " +
                         (scenario_.dt > 0 ? "strictly increasing" : "strictly decreasing for dt < 0"));
      return;
    }
    before = t;
    scenario_.record.push_back(time);
    scenario_.record_steps.push_back(static_cast<std::int64_t>(step));
  }
}

}  // namespace hamflow
