// hamflow compare: several methods, several steps, one run: what accuracy costs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>

#include "commands.hpp"
#include "hamflow/verify/comparison.hpp"
#include "progress.hpp"
#include "run_folder.hpp"
#include "run_keys.hpp"
#include "summary.hpp"
#include "terminal.hpp"
#include "work_precision.hpp"

namespace hamflow::app {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Everything wrong with the command line beside the scenario, one line each.
class Wishes {
 public:
  Wishes(const Scenario& scenario, const CompareOptions& options) : scenario_(scenario) {
    read_methods(options.methods);
    asked.request = scenario.request;
    asked.t_end = scenario.dt * static_cast<double>(scenario.steps);
    if (!(std::abs(asked.t_end) > 0)) {
      complain("run", "found a run of no time; allowed one with at least a step");
    } else {
      read_steps(options.dts);
    }
    if (!options.figure.empty()) complain_if("--figure", refused_figure_file(options.figure));
  }

  ComparisonRequest asked;
  std::vector<std::string> notes;
  std::vector<Complaint> complaints;

 private:
  void complain(const std::string& key, const std::string& message) {
    complaints.push_back({scenario_.file, 0, 0, key, message});
  }
  void complain_if(const std::string& key, const std::string& message) {
    if (!message.empty()) complain(key, message);
  }

  void read_methods(const std::string& text) {
    if (digits_beyond_double(scenario_.request.arithmetic) > 0) {
      complain(run_path(run_keys().arithmetic), "found \"" + scenario_.request.arithmetic +
                                     "\", whose errors are below those of the reference here; allowed double, " +
                                     "compensated, lattice");
    }
    for (const std::string& name : split_list(text)) {
      try {
        const MethodSpec method = parse_method(name);
        std::string why_not = refusal(method, scenario_.request.arithmetic);
        if (why_not.empty()) why_not = refusal(method, *scenario_.problem);
        Request request = scenario_.request;
        request.method = method;
        if (why_not.empty() && request.kernel == "fast") why_not = refused_fast_kernel(request, *scenario_.problem);
        if (why_not.empty()) {
          asked.methods.push_back(method);
        } else {
          complain("--methods", "found '" + name + "'; " + why_not);
        }
      } catch (const Error& error) {
        complain("--methods", "found '" + name + "'; " + error.what());
      }
    }
  }

  /// The nearest number of steps that ends at t_end.
  void read_steps(const std::string& text) {
    if (text.empty()) {
      asked.steps = usual_step_counts(scenario_.steps);
      return;
    }
    for (const std::string& part : split_list(text)) {
      double dt = 0;
      try {
        dt = std::abs(evaluate_number<double>(part));
      } catch (const Error& error) {
        complain("--dt", "found '" + part + "'; allowed numbers with commas between (" + error.what() + ")");
        continue;
      }
      const double count = std::round(std::abs(asked.t_end) / dt);
      if (!(dt > 0) || !(count < 0x1p53)) {
        complain("--dt", "found '" + part + "'; allowed a number other than 0 that fits into t_end = " +
                             shortest(asked.t_end) + " less than 2^53 times");
        continue;
      }
      const auto steps = std::max<std::int64_t>(1, static_cast<std::int64_t>(count));
      const double fitting = std::abs(asked.t_end) / static_cast<double>(steps);
      if (std::abs(fitting - dt) > 1e-9 * dt) {
        notes.push_back("dt = " + part + " does not divide t_end = " + shortest(asked.t_end) +
                        "; dt = " + shortest(fitting) + " is taken");
      }
      asked.steps.push_back(steps);
    }
    std::sort(asked.steps.begin(), asked.steps.end());
    asked.steps.erase(std::unique(asked.steps.begin(), asked.steps.end()), asked.steps.end());
  }

  const Scenario& scenario_;
};

Json row_of(const ComparisonPoint& p) {
  Json row{
      {"method", p.method},
      {"order", p.order},
      {"dt", p.dt},
      {"steps", p.steps},
      {"status", status_of(p.outcome)},
      {"evaluations",
       {{"force", p.force}, {"gradient", p.gradient}, {"hessian", p.hessian}, {"linear_solves", p.linear_solves}}}};
  if (p.tolerance) row["tolerance"] = *p.tolerance;
  const auto measured = [&](double x) { return p.done() ? Json(x) : Json(nullptr); };
  row["error"] = measured(p.error);
  row["max_energy_error"] = measured(p.max_energy_error);
  row["end_energy_error"] = measured(p.end_energy_error);
  row["seconds"] = measured(p.seconds);
  row["wall_seconds"] = measured(p.wall_seconds);
  if (!p.done()) row["reason"] = p.failure;
  return row;
}

Json json_of(const Comparison& c, bool all_failed) {
  const std::size_t n = c.reference.end.size() / 2;
  const auto middle = c.reference.end.begin() + static_cast<std::ptrdiff_t>(n);
  Json all{{"status", c.stopped    ? "interrupted"
                      : all_failed ? "failed"
                                   : "done"},
           {"problem", c.problem},
           {"arithmetic", c.arithmetic},
           {"t_end", c.t_end},
           {"reference",
            {{"kind", c.reference.kind},
             {"description", c.reference.description},
             {"q", State<double>(c.reference.end.begin(), middle)},
             {"p", State<double>(middle, c.reference.end.end())},
             {"uncertainty", c.reference.uncertainty}}},
           {"rows", Json::array()},
           {"winners", Json::array()}};
  for (const ComparisonPoint& p : c.points) all["rows"].push_back(row_of(p));
  for (const ComparisonWinner& w : winners(c)) {
    all["winners"].push_back({{"error", w.error}, {"by", w.by}, {"method", w.method}, {"work", w.work}});
    if (w.second.empty()) continue;
    all["winners"].back()["second"] = w.second;
    all["winners"].back()["second_work"] = w.second_work;
  }
  return all;
}

void draw(const Comparison& c, const fs::path& file) {
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  WorkPrecision data;
  data.title = fmt::format("{}, t = {}, {} arithmetic", c.problem, shortest(c.t_end), c.arithmetic);
  data.floor = c.reference.uncertainty;
  std::string last;
  for (const ComparisonPoint& p : c.points) {
    if (p.method != last) data.curves.push_back({p.method, p.order, p.explicit_step, {}, {}, {}, {}});
    last = p.method;
    WorkCurve& curve = data.curves.back();
    curve.evaluations.push_back(p.evaluations());
    curve.seconds.push_back(p.done() ? p.seconds : nothing);
    curve.error.push_back(p.done() ? p.error : nothing);
    curve.energy_error.push_back(p.done() ? p.max_energy_error : nothing);
  }
  write_work_precision(data, file);
}

void make_comparison_folder(const fs::path& folder, bool force) {
  std::error_code error;
  if (fs::exists(folder, error) && !force) {
    throw FileError(folder.string() + " exists; give --force to replace the comparison in it, or --out another");
  }
  fs::create_directories(folder / "figures", error);
  if (error) throw FileError("cannot make the folder " + folder.string() + ": " + error.message());
}

int carry_out(const Scenario& scenario, const Wishes& wishes, const CompareOptions& options) {
  if (!options.quiet) {
    for (const std::string& note : scenario.notes) std::cerr << "note: " << note << '\n';
    for (const std::string& note : wishes.notes) std::cerr << "note: " << note << '\n';
  }
  const bool writes = !options.out.empty() && options.out != "none";
  if (writes) make_comparison_folder(options.out, options.force);
  catch_interrupts();
  Comparison comparison;
  {
    Progress progress(0, static_cast<std::int64_t>(wishes.asked.methods.size() * wishes.asked.steps.size()),
                      options.quiet);
    comparison = compare(wishes.asked, [&](std::size_t done) {
      progress.show(static_cast<std::int64_t>(done));
      return !interrupted();
    });
  }
  const bool all_failed = !comparison.stopped && std::none_of(comparison.points.begin(), comparison.points.end(),
                                                              [](const ComparisonPoint& p) { return p.done(); });
  const Json json = json_of(comparison, all_failed);
  std::cout << (options.json ? json_text(json) : comparison_table(comparison));
  if (!options.csv.empty()) write_text(options.csv, comparison_csv(comparison));
  if (writes) {
    write_text(fs::path(options.out) / "compare.json", json_text(json));
    write_text(fs::path(options.out) / "compare.csv", comparison_csv(comparison));
  }
  if (all_failed) {
    std::cerr << "error: every run failed; the first: " << comparison.points.front().failure << '\n';
    return exit_failed;
  }
  if (!comparison.stopped) {
    if (!options.figure.empty()) draw(comparison, options.figure);
    for (const char* format : {".svg", ".pdf", ".png"}) {
      if (writes) draw(comparison, fs::path(options.out) / "figures" / (std::string("work-precision") + format));
    }
  }
  if (writes && !options.json && !options.quiet) std::cout << fmt::format("\nwritten to {}\n", options.out);
  return comparison.stopped ? exit_interrupted : exit_done;
}

int rejected(const std::vector<Complaint>& complaints, bool json) {
  for (const Complaint& complaint : complaints) std::cerr << complaint.text() << '\n';
  if (json) std::cout << json_text(rejection_of(complaints));
  return exit_rejected;
}

int failed(const CompareOptions& options, int status, const char* kind, const std::string& message) {
  std::cerr << "error: " << message << '\n';
  if (options.json) std::cout << json_text({{"status", "failed"}, {"error", {{"kind", kind}, {"message", message}}}});
  return status;
}

}  // namespace

int compare_methods(const CompareOptions& options) {
  try {
    const Reading reading = read_scenario(options.scenario, options.sets);
    if (!reading.scenario) return rejected(reading.complaints, options.json);
    const Wishes wishes(*reading.scenario, options);
    if (!wishes.complaints.empty()) return rejected(wishes.complaints, options.json);
    return carry_out(*reading.scenario, wishes, options);
  } catch (const FileError& error) {
    return failed(options, exit_file, "file", error.what());
  } catch (const fs::filesystem_error& error) {
    return failed(options, exit_file, "file", error.what());
  } catch (const Error& error) {
    return failed(options, exit_failed, "comparison", error.what());
  }
}

}  // namespace hamflow::app
