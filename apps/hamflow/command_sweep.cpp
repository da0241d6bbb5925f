// hamflow sweep: an ensemble over keys of a scenario, one row of a table for each member.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <iostream>

#include "commands.hpp"
#include "hamflow/core/text.hpp"
#include "measures.hpp"
#include "parameter_map.hpp"
#include "progress.hpp"
#include "run_folder.hpp"
#include "summary.hpp"
#include "sweep_table.hpp"
#include "terminal.hpp"

namespace hamflow::app {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
constexpr std::size_t most_rows_in_summary = 10000;
constexpr std::size_t most_failures_told = 10;

int rejected(const SweepCommandOptions& options, const std::vector<std::string>& lines) {
  Json errors = Json::array();
  for (const std::string& line : lines) {
    std::cerr << line << '\n';
    errors.push_back({{"message", line}});
  }
  if (options.json) std::cout << json_text({{"status", "rejected"}, {"errors", errors}});
  return exit_rejected;
}

int file_trouble(const SweepCommandOptions& options, const std::string& message) {
  std::cerr << "error: " << message << '\n';
  if (options.json) std::cout << json_text({{"status", "failed"}, {"error", {{"kind", "file"}, {"message", message}}}});
  return exit_file;
}

LaneSet lanes_named(const std::string& name) {
  for (const LaneSet set : {LaneSet::none, LaneSet::generic, LaneSet::avx2, LaneSet::avx512}) {
    if (name == hamflow::name(set) && set <= widest_lanes()) return set;
  }
  if (name.empty() || name == "auto") return widest_lanes();
  std::vector<std::string> allowed{"auto", "none", "generic"};
  if (widest_lanes() >= LaneSet::avx2) allowed.emplace_back("avx2");
  if (widest_lanes() >= LaneSet::avx512) allowed.emplace_back("avx512");
  throw Error("--lanes: found \"" + name + "\"; allowed on this machine: " + joined(allowed) +
              suggestion(name, allowed));
}

std::size_t count(const Sweep& sweep, Outcome status) {
  return static_cast<std::size_t>(std::count_if(sweep.rows().begin(), sweep.rows().end(),
                                                [&](const MemberRow& row) { return row.status == status; }));
}

Json varied_of(const Sweep& sweep) {
  Json varied = Json::object();
  for (const Vary& vary : sweep.varied()) {
    Json& entry = varied[vary.path];
    entry["count"] = vary.texts.size();
    if (vary.numbers.empty()) {
      entry["values"] = vary.texts;
    } else {
      entry["first"] = vary.numbers.front();
      entry["last"] = vary.numbers.back();
    }
  }
  return varied;
}

/// {"problem.mass": 1.0, ..., "status": ..., "final": {...}, "energy": {...}}
Json row_of(const Sweep& sweep, std::size_t member) {
  const MemberRow& row = sweep.rows()[member];
  Json json = Json::object();
  const std::vector<std::size_t> values = values_of_member(sweep.varied(), member);
  for (std::size_t k = 0; k < values.size(); ++k) {
    const Vary& vary = sweep.varied()[k];
    json[vary.path] = vary.numbers.empty() ? Json(vary.texts[values[k]]) : Json(vary.numbers[values[k]]);
  }
  json["status"] = std::string(name(row.status));
  json["steps"] = row.steps;
  if (row.status == Outcome::not_run) return json;
  json["final"] = {{"t", row.t}, {"q", row.q}, {"p", row.p}};
  json["energy"] = {{"initial", row.energy.initial},
                    {"final", row.energy.final},
                    {"max_error", row.energy.max_error},
                    {"scale", row.energy_scale}};
  json["invariants"] = Json::object();
  const std::vector<InvariantInfo>& declared = sweep.common().problem->info.invariants;
  for (std::size_t i = 0; i < row.invariants.size(); ++i) {
    json["invariants"][declared[i].name] = {{"initial", row.invariants[i].initial},
                                            {"final", row.invariants[i].final},
                                            {"max_error", row.invariants[i].max_error}};
  }
  for (std::size_t i = 0; i < row.observables.size(); ++i) {
    json[sweep.observables().names[i]] = row.observables[i];
  }
  if (!row.message.empty()) json["message"] = row.message;
  return json;
}

Json summary_of(const Sweep& sweep, double seconds, bool interrupted) {
  const std::size_t done = count(sweep, Outcome::done);
  const std::size_t unfinished = count(sweep, Outcome::stopped) + count(sweep, Outcome::not_run);
  const std::size_t failed = sweep.members() - done - unfinished;
  std::int64_t steps = 0;
  for (const MemberRow& row : sweep.rows()) steps += row.steps;
  Json s;
  s["status"] = interrupted && unfinished > 0 ? "interrupted" : done == 0 ? "failed" : "done";
  s["problem"] = sweep.common().request.problem;
  s["arithmetic"] = sweep.common().request.arithmetic;
  s["kernel"] = sweep.common().request.kernel;
  s["members"] = sweep.members();
  s["done"] = done;
  s["failed"] = failed;
  s["unfinished"] = unfinished;
  s["varied"] = varied_of(sweep);
  s["wall_seconds"] = seconds;
  s["member_steps_per_second"] = seconds > 0 ? static_cast<double>(steps) / seconds : 0.0;
  s["members_per_second"] = seconds > 0 ? static_cast<double>(done + failed) / seconds : 0.0;
  s["instruction_set"] = std::string(name(sweep.lanes()));
  s["lanes"] = sweep.members_in_lanes() > 0 ? sweep.lane_count() : 1;
  s["members_in_lanes"] = sweep.members_in_lanes();
  s["threads"] = sweep.threads();
  s["failures"] = Json::array();
  for (std::size_t member = 0; member < sweep.members() && s["failures"].size() < most_failures_told; ++member) {
    const MemberRow& row = sweep.rows()[member];
    if (row.message.empty()) continue;
    s["failures"].push_back({{"member", member},
                             {"kind", std::string(name(row.status))},
                             {"step", row.steps + 1},
                             {"t", row.t},
                             {"message", row.message}});
  }
  return s;
}

std::string readable_sweep(const Json& s) {
  std::string text;
  const auto line = [&](std::string_view label, const std::string& what) {
    text += fmt::format("{:<20}{}\n", label, what);
  };
  line("status", s["status"].get<std::string>());
  line("members",
       fmt::format("{} ({} done, {} failed, {} unfinished)", s["members"].get<std::size_t>(),
                   s["done"].get<std::size_t>(), s["failed"].get<std::size_t>(), s["unfinished"].get<std::size_t>()));
  for (const auto& [path, entry] : s["varied"].items()) {
    line("varied", entry.contains("first")
                       ? fmt::format("{}: {} values, {:g} .. {:g}", path, entry["count"].get<std::size_t>(),
                                     entry["first"].get<double>(), entry["last"].get<double>())
                       : fmt::format("{}: {} values", path, entry["count"].get<std::size_t>()));
  }
  line("lanes", fmt::format("{} ({}), {} members in lanes, threads {}", s["lanes"].get<std::size_t>(),
                            s["instruction_set"].get<std::string>(), s["members_in_lanes"].get<std::size_t>(),
                            s["threads"].get<int>()));
  line("wall time", fmt::format("{:.3g} s, {:.4g} member steps/s, {:.4g} members/s", s["wall_seconds"].get<double>(),
                                s["member_steps_per_second"].get<double>(), s["members_per_second"].get<double>()));
  return text;
}

fs::path folder_for(const SweepCommandOptions& options) {
  if (!options.out.empty()) return options.out;
  return fs::path(options.scenario).stem().string() + ".sweep";
}

void make_sweep_folder(const fs::path& folder, bool force) {
  make_folder(folder, force);
  std::error_code error;
  for (const char* left : {"sweep.h5", "sweep.csv"}) fs::remove(folder / left, error);
  if (error) throw FileError("cannot clear " + folder.string() + ": " + error.message());
}

void save(const Sweep& sweep, const fs::path& folder, const Json& summary) {
  const std::vector<std::string>& formats = sweep.common().formats;
  char host[256] = "";
  (void)gethostname(host, sizeof host - 1);
  if (std::find(formats.begin(), formats.end(), "h5") != formats.end()) {
    write_sweep_h5(folder / "sweep.h5", sweep, {HAMFLOW_VERSION, host});
  }
  if (std::find(formats.begin(), formats.end(), "csv") != formats.end()) write_sweep_csv(folder / "sweep.csv", sweep);
  write_text(folder / "summary.json", json_text(summary));
}

/// Empty if the figure can be drawn, else what is wrong with the request for it.
std::string refused_map(const Sweep& sweep, const SweepCommandOptions& options) {
  if (options.figure.empty()) return {};
  const std::string wrong = refused_figure_file(options.figure);
  if (!wrong.empty()) return "--figure: error: " + wrong;
  std::size_t numeric = 0;
  std::vector<std::string> columns;
  for (const SweepColumn& column : columns_of(sweep)) {
    if (column.numbers.empty() || column.width != 1) continue;
    if (column.name.starts_with("varied/")) ++numeric;
    columns.push_back(column.name);
  }
  if (sweep.varied().size() > 2 || numeric != sweep.varied().size()) {
    return "--figure: error: found " + std::to_string(sweep.varied().size()) +
           " varied keys; allowed one or two, all numbers";
  }
  if (std::find(columns.begin(), columns.end(), options.colour) == columns.end()) {
    return "--colour: error: found " + options.colour + "; allowed " + joined(columns) +
           suggestion(options.colour, columns);
  }
  return {};
}

void draw(const Sweep& sweep, const SweepCommandOptions& options) {
  if (options.figure.empty()) return;
  ParameterMap map;
  map.title = sweep.common().request.problem + ", " + describe(sweep.common().request.method).name;
  map.value_name = options.colour;
  for (const SweepColumn& column : columns_of(sweep)) {
    if (column.name == options.colour) map.value = column.numbers;
    if (!column.name.starts_with("varied/")) continue;
    const std::string key = column.name.substr(std::string("varied/").size());
    if (map.x_name.empty()) {
      map.x_name = key;
      map.x = column.numbers;
    } else {
      map.y_name = key;
      map.y = column.numbers;
    }
  }
  write_parameter_map(map, options.figure);
}

int carry_out(Sweep& sweep, const SweepCommandOptions& options) {
  const bool writes = options.out != "none";
  const fs::path folder = folder_for(options);
  if (writes) make_sweep_folder(folder, options.force);
  catch_interrupts();
  const auto begin = std::chrono::steady_clock::now();
  {
    Progress progress(0, sweep.total_steps(), options.quiet);
    sweep.run([&](std::int64_t steps) {
      progress.show(steps);
      return !interrupted();
    });
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  Json summary = summary_of(sweep, seconds, interrupted());
  if (writes) save(sweep, folder, summary);
  draw(sweep, options);
  if (options.json && !writes && sweep.members() <= most_rows_in_summary) {
    summary["rows"] = Json::array();
    for (std::size_t member = 0; member < sweep.members(); ++member) summary["rows"].push_back(row_of(sweep, member));
  }
  std::cout << (options.json ? json_text(summary) : readable_sweep(summary));
  if (writes && !options.json && !options.quiet) std::cout << fmt::format("{:<20}{}\n", "written to", folder.string());
  for (const Json& failure : summary["failures"]) {
    const std::string text = fmt::format("member {}, step {}: {}", failure["member"].get<std::size_t>(),
                                         failure["step"].get<std::int64_t>(), failure["message"].get<std::string>());
    if (summary["status"] == "failed") {
      std::cerr << "error: " << text << '\n';
    } else if (!options.quiet) {
      std::cerr << "note: " << text << '\n';
    }
  }
  if (summary["status"] == "interrupted") return exit_interrupted;
  return summary["status"] == "failed" ? exit_failed : exit_done;
}

/// Lyapunov exponents, where the scenario asks for them (run.lyapunov): a column each.
MemberObservables exponents_asked_for(const std::string& text, const SweepCommandOptions& options,
                                      const std::vector<Vary>& varied) {
  std::vector<std::string> sets = options.sets;
  for (const Vary& vary : varied) sets.push_back(vary.path + "=" + vary.texts.front());
  const Reading first = read_scenario_text(text, options.scenario, sets);
  MemberObservables columns;
  if (!first.scenario) return columns;  // the sweep complains
  if (!options.quiet && (first.scenario->section || first.scenario->eigenvalues)) {
    std::cerr << "note: run.section and run.eigenvalues belong to single runs: a sweep leaves them out\n";
  }
  const std::size_t count = first.scenario->lyapunov;
  for (std::size_t i = 1; i <= count; ++i) columns.names.push_back("lyapunov" + std::to_string(i));
  if (count > 0) {
    columns.observe = [count](const Scenario& scenario) {
      std::vector<double> found = exponents_of(scenario);
      found.resize(count, std::numeric_limits<double>::quiet_NaN());
      return found;
    };
  }
  return columns;
}

}  // namespace

int run_sweep(const SweepCommandOptions& options) {
  try {
    const std::string text = scenario_text(options.scenario);
    std::vector<Vary> varied;
    std::vector<std::string> wrong;
    if (options.varied.empty()) wrong.emplace_back("--vary: error: found none; allowed PATH=a:b:n or PATH=v1,v2,...");
    SweepOptions how{.threads = options.threads};
    const auto try_to = [&](const char* prefix, const auto& action) {
      try {
        action();
      } catch (const FileError&) {
        throw;
      } catch (const Error& error) {
        wrong.push_back(prefix + std::string(error.what()));
      }
    };
    for (const std::string& vary : options.varied) {
      try_to("--vary: error: ", [&] { varied.push_back(parse_vary(vary)); });
    }
    for (std::size_t i = 0; i < varied.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (varied[i].path == varied[j].path) wrong.push_back("--vary: error: found " + varied[i].path + " twice");
      }
    }
    try_to("--vary: error: ", [&] { (void)member_count(varied); });
    try_to("", [&] { how.lanes = lanes_named(options.lanes); });
    if (!wrong.empty()) return rejected(options, wrong);
    how.observables = exponents_asked_for(text, options, varied);
    Sweep sweep(text, options.scenario, options.sets, varied, how);
    if (!sweep.complaints().empty()) return rejected(options, sweep.complaints());
    const std::string figure = refused_map(sweep, options);
    if (!figure.empty()) return rejected(options, {figure});
    return carry_out(sweep, options);
  } catch (const FileError& error) {
    return file_trouble(options, error.what());
  } catch (const fs::filesystem_error& error) {
    return file_trouble(options, error.what());
  }
}

}  // namespace hamflow::app
