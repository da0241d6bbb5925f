// [method], [run] and [output].
#include <algorithm>
#include <cmath>

#include "figure_kinds.hpp"
#include "scenario_reader.hpp"

namespace hamflow {

namespace {
std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const MethodEntry& entry : methods()) names.push_back(entry.name);
  return names;
}
const std::vector<std::string> cg_keys{"degree",         "quadrature", "tolerance",     "criterion",
                                       "max_iterations", "iteration",  "on_divergence", "diagnostics"};
}  // namespace

void ScenarioReader::read_method(TomlTable& table) {
  if (!table.has("name")) {
    table.missing("name", joined(method_names()));
    table.know_all(cg_keys);
  } else if (const auto name = table.choice("name", method_names()); !name) {
    table.know_all(cg_keys);  // it may have been meant to be cg
  } else {
    scenario_.request.method.name = *name;
    if (*name == "cg") {
      read_cg(table);
    } else if (*name == "dop853" || *name == "taylor") {
      read_adaptive(table);
    } else if (table.from_set("name")) {
      // Another method from the command line: the options of the one in the file do not apply.
      for (const std::string& key : cg_keys) {
        if (!table.has(key) || table.from_set(key)) continue;
        table.know(key);
        scenario_.notes.push_back("method." + key + " of the file is not used: " + *name + " has no such option");
      }
    }
    if (scenario_.problem != nullptr) {
      const std::string why_not = refusal(scenario_.request.method, *scenario_.problem);
      if (!why_not.empty()) table.complain("name", table.found("name") + "; " + why_not);
    }
  }
  table.finish();
}

void ScenarioReader::read_cg(TomlTable& table) {
  CgOptions& cg = scenario_.request.method.cg;
  if (const auto degree = table.whole("degree", 1, 1)) cg.degree = static_cast<int>(*degree);
  if (table.has("quadrature") && table.found("quadrature") == "found \"auto\" (a string)") {
    table.know("quadrature");
  } else if (table.has("quadrature")) {
    if (const auto points = table.whole("quadrature", cg.degree, 64)) {
      cg.quadrature = static_cast<int>(*points);
    } else {
      complaints_.back().message += ", or \"auto\"";
    }
  } else {
    table.know("quadrature");
  }
  if (const auto tolerance = table.number("tolerance")) {
    if (tolerance->value > 0) {
      cg.tolerance = tolerance->value;
    } else {
      table.complain("tolerance", table.found("tolerance") + "; allowed a positive number");
    }
  }
  if (const auto criterion = table.choice("criterion", {"stagnation", "seed"}); criterion == "seed") {
    cg.seed_criterion = true;
    if (!cg.tolerance) cg.tolerance = 1e-13;  // the listings' own
  }
  if (const auto most = table.whole("max_iterations", 1, 1000)) cg.max_iterations = static_cast<int>(*most);
  (void)table.choice("iteration", {"newton"});
  if (const auto remedy = table.choice("on_divergence", {"error", "halve"})) cg.halve = *remedy == "halve";
  cg.diagnostics = table.boolean("diagnostics").value_or(false);
}

void ScenarioReader::read_adaptive(TomlTable& table) {
  AdaptiveOptions& options = scenario_.request.method.adaptive;
  if (const auto tolerance = table.number("tolerance")) {
    if (tolerance->value > 0 && tolerance->value < 1) {
      options.tolerance = tolerance->value;
      options.tolerance_given = true;
    } else {
      table.complain("tolerance", table.found("tolerance") + "; allowed a number between 0 and 1");
    }
  }
  if (scenario_.request.method.name == "taylor") {
    if (const auto order = table.whole("order", least_taylor_order, most_taylor_order)) {
      options.order = static_cast<int>(*order);
    }
  }
  if (const auto control = table.choice("step_control", {"adaptive", "fixed"})) options.fixed = *control == "fixed";
}

void ScenarioReader::read_run(TomlTable& table) {
  if (!table.has("dt")) {
    table.know("dt");
    table.missing("dt", "a number other than 0");
  } else if (const auto dt = table.number("dt")) {
    if (dt->value == 0) table.complain("dt", table.found("dt") + "; allowed a number other than 0");
    scenario_.dt = dt->value;
    scenario_.request.dt = dt->text;
  }
  read_length(table);
  if (!std::isfinite(scenario_.dt * static_cast<double>(scenario_.steps))) {
    table.complain("dt", table.found("dt") + "; allowed a dt whose product with the number of steps is finite");
  }
  read_samples(table);
  if (const auto every = table.whole("checkpoint_every", 1, most_steps)) scenario_.checkpoint_every = *every;
  read_arithmetic(table);
  read_measures(table);
  if (const auto kernel = table.choice("kernel", {"exact", "fast"})) {
    scenario_.request.kernel = *kernel;
    if (*kernel == "fast" && scenario_.problem != nullptr && !scenario_.request.method.name.empty()) {
      const std::string why_not = refused_fast_kernel(scenario_.request, *scenario_.problem);
      if (!why_not.empty()) table.complain("kernel", table.found("kernel") + "; " + why_not);
    }
  }
  if (const auto threads = table.whole("threads", 1, most_threads)) {
    scenario_.request.threads = static_cast<int>(*threads);
    if (scenario_.problem != nullptr) {
      const std::string why_not = refused_threads(scenario_.request, *scenario_.problem);
      if (!why_not.empty()) table.complain("threads", table.found("threads") + "; " + why_not);
    }
  }
  read_lattice(table);
  table.finish();
}

void ScenarioReader::read_arithmetic(TomlTable& table) {
  const auto arithmetic = table.string("arithmetic");
  if (!arithmetic) return;
  try {
    check_arithmetic(*arithmetic);
  } catch (const Error& error) {
    // "found ...; allowed ...": the name itself is in what was found.
    const std::string why = error.what();
    const std::size_t allowed = why.find("allowed: ");
    table.complain("arithmetic", table.found("arithmetic") + "; " +
                                     (allowed == std::string::npos ? why : "allowed " + why.substr(allowed + 9)));
    return;
  }
  scenario_.request.arithmetic = *arithmetic;
  const std::string why_not =
      scenario_.request.method.name.empty() ? "" : refusal(scenario_.request.method, *arithmetic);
  if (!why_not.empty()) table.complain("arithmetic", table.found("arithmetic") + "; " + why_not);
}

void ScenarioReader::read_length(TomlTable& table) {
  const bool by_steps = table.has("steps");
  const bool by_time = table.has("t_end");
  const auto steps = table.whole("steps", 0, most_steps);
  const auto t_end = table.number("t_end");
  if (by_steps && by_time) {
    table.complain("t_end", "found steps and t_end together; allowed exactly one of them");
  } else if (!by_steps && !by_time) {
    table.missing("steps", "exactly one of steps, t_end");
  } else if (steps) {
    scenario_.steps = *steps;
  } else if (t_end && scenario_.dt != 0) {
    const double ratio = t_end->value / scenario_.dt;
    const double whole = std::round(ratio);
    if (ratio < 0) {
      table.complain("t_end",
                     table.found("t_end") + " with dt = " + shortest(scenario_.dt) + "; allowed the sign of dt");
    } else if (whole > static_cast<double>(most_steps)) {
      table.complain("t_end", table.found("t_end") + "; allowed at most 2^53 steps of dt");
    } else if (std::abs(ratio - whole) > std::max(1e-9, 4 * whole * 0x1p-52)) {  // the quotient itself rounds
      const double fitting = std::max(whole, 1.0);
      table.complain(
          "t_end", table.found("t_end") + ", which is " + shortest(ratio) + " steps of dt = " + shortest(scenario_.dt) +
                       "; allowed a whole number of steps, nearest dt = " + shortest(t_end->value / fitting) +
                       " or t_end = " + shortest(whole * scenario_.dt));
    } else {
      scenario_.steps = static_cast<std::int64_t>(whole);
    }
  }
}

/// By steps, or at given times. A time belongs to the step before it, one that is a step's up to rounding to that step.
void ScenarioReader::read_samples(TomlTable& table) {
  const auto every = table.whole("record_every", 1, most_steps);
  scenario_.record_every = every ? *every : default_record_every(scenario_.steps);
  const auto times = table.numbers("record", 0);
  if (!times) return;
  if (table.has("record_every")) {
    table.complain("record", "found record and record_every together; allowed one of them");
    return;
  }
  if (scenario_.dt == 0) return;  // told
  const auto steps = static_cast<double>(scenario_.steps);
  double before = 0;
  for (const Number& time : *times) {
    const double ratio = time.value / scenario_.dt;
    const double whole = std::round(ratio);
    const bool at_step = std::abs(ratio - whole) <= 4 * 0x1p-52 * whole;  // time, dt and their quotient are rounded
    const double step = at_step ? whole : std::floor(ratio);
    if (!(step >= 0 && (at_step ? whole <= steps : ratio < steps))) {
      table.complain("record",
                     "found the time " + time.text + "; allowed from 0 to the end, " + shortest(steps * scenario_.dt));
      return;
    }
    if (!scenario_.record.empty() && !((time.value - before) * scenario_.dt > 0)) {
      table.complain("record", "found the time " + time.text + " after " + scenario_.record.back() +
                                   "; allowed times in the order of the run, " +
                                   (scenario_.dt > 0 ? "each later" : "with dt < 0 each earlier") +
                                   " than the one before");
      return;
    }
    before = time.value;
    scenario_.record.push_back(time.text);
    scenario_.record_steps.push_back(static_cast<std::int64_t>(step));
  }
}

/// 2^-52 of the largest number of the start, hence a range of 1024 times it. For most problems 2^-52 for numbers from
/// 1/512 to 2 too, because a start near rest says little about what follows. Of bodies that attract each other the
/// momenta to come are known: those with which the kinetic energy would be as large as the potential energy is now.
void ScenarioReader::usual_units() {
  const auto largest = [](const std::vector<double>& values) {
    double most = 0;
    for (const double x : values) most = std::max(most, std::abs(x));
    return most;
  };
  const auto unit_for = [](double most, int coarsest) {
    const int exponent = most > 0 && std::isfinite(most) ? std::clamp(std::ilogb(most), -900, 900) : 0;
    return std::ldexp(1.0, -52 + (exponent < coarsest || exponent > 0 ? exponent : 0));
  };
  Request& request = scenario_.request;
  if (scenario_.problem == nullptr || !scenario_.problem->has_pairwise_forces || scenario_.start_q.empty()) {
    request.position_unit = unit_for(largest(scenario_.start_q), -9);
    request.momentum_unit = unit_for(largest(scenario_.start_p), -9);
    return;
  }
  // The start's momenta, or equal ones, times as much as makes T = |V|.
  const double most = largest(scenario_.start_p);
  const auto energy_with = [&](double factor) {
    std::vector<double> p = scenario_.start_p;
    for (double& x : p) x = factor * (most > 0 ? x / most : 1.0);
    return scenario_.problem->energy(request.parameters, scenario_.start_q, p);
  };
  const double potential = energy_with(0);
  double factor = 1;
  while (energy_with(factor) - potential < 0x1p-20 * std::abs(potential) && factor < 0x1p400) factor *= 0x1p30;
  const double to_come = factor * std::sqrt(std::abs(potential) / (energy_with(factor) - potential));
  request.position_unit = unit_for(largest(scenario_.start_q), 0);
  request.momentum_unit = unit_for(std::isfinite(to_come) ? std::max(most, to_come) : most, 0);
}

void ScenarioReader::read_lattice(TomlTable& table) {
  const bool on_lattice = scenario_.request.arithmetic == "lattice";
  if (table.has("lattice")) {
    TomlTable lattice = table.table("lattice");
    const auto unit = [&](const char* key, double& out) {
      const auto value = lattice.number(key);
      if (!value) return;
      int exponent = 0;
      if (std::frexp(value->value, &exponent) != 0.5 || std::abs(exponent) > 1000) {
        lattice.complain(key, lattice.found(key) + "; allowed a power of two from 2^-1000 to 2^999, such as \"2^-52\"");
        return;
      }
      out = value->value;
    };
    unit("position", scenario_.request.position_unit);
    unit("momentum", scenario_.request.momentum_unit);
    lattice.finish();
    if (!on_lattice) {
      table.complain("lattice", "found units for arithmetic \"" + scenario_.request.arithmetic +
                                    "\"; allowed with arithmetic = \"lattice\"");
    }
  } else {
    table.know("lattice");
    if (on_lattice) usual_units();
  }
  if (!on_lattice) return;
  const auto rounding = [](const std::vector<double>& values, double unit) {
    double most = 0;
    for (const double x : values) most = std::max(most, std::abs(std::remainder(x, unit)));
    return most;
  };
  const double lost = std::max(rounding(scenario_.start_q, scenario_.request.position_unit),
                               rounding(scenario_.start_p, scenario_.request.momentum_unit));
  if (lost > 1e-12) scenario_.notes.push_back("the start is rounded to the lattice by up to " + shortest(lost));
  const auto reach = [](const std::vector<double>& values) {
    double most = 0;
    for (const double x : values) most = std::max(most, std::abs(x));
    return most;
  };
  const auto check = [&](const char* what, double largest, double unit) {
    if (largest > 0 && largest < unit) {
      table.complain("lattice", std::string("found ") + what + " of at most " + shortest(largest) +
                                    " at the start, with a unit of " + shortest(unit) +
                                    "; allowed units far below them");
      return;
    }
    if (largest < unit * 0x1p62) return;
    table.complain("lattice", std::string("found ") + what + " up to " + shortest(largest) +
                                  " at the start, with a unit of " + shortest(unit) +
                                  "; allowed below 2^62 units: choose a larger power of two");
  };
  check("positions", reach(scenario_.start_q), scenario_.request.position_unit);
  check("momenta", reach(scenario_.start_p), scenario_.request.momentum_unit);
}

void ScenarioReader::read_output(TomlTable& table) {
  if (const auto folder = table.string("folder")) {
    if (folder->empty()) table.complain("folder", "found an empty name; allowed a folder");
    scenario_.folder = *folder;
  }
  if (const auto formats = table.choices("formats", {"h5", "csv"})) scenario_.formats = *formats;
  if (const auto figures = table.choices("figures", figure_names())) scenario_.figures = *figures;
  const auto wants = [&](const std::vector<std::string>& list, const char* word) {
    return std::find(list.begin(), list.end(), word) != list.end();
  };
  if (!scenario_.figures.empty() && !wants(scenario_.formats, "h5")) {
    table.complain("figures",
                   "found figures without the format h5, from which they are drawn; allowed formats = [\"h5\", ...]");
  }
  const std::size_t dimension = scenario_.start_q.size();
  FigureFacts facts{.degrees_of_freedom = dimension,
                    .diagnostics = scenario_.request.method.cg.diagnostics,
                    .section = scenario_.section.has_value()};
  if (scenario_.problem != nullptr) {
    const auto& invariants = scenario_.problem->info.invariants;
    facts.bodies_in_space = scenario_.problem->dimension == 0 &&
                            std::any_of(invariants.begin(), invariants.end(), [](const InvariantInfo& invariant) {
                              return invariant.components == Components::space;
                            });
  }
  for (const std::string& kind : scenario_.figures) {
    const std::string why_not = refused_figure(kind, facts);
    if (!why_not.empty()) table.complain("figures", why_not);
  }
  table.finish();
}

}  // namespace hamflow
