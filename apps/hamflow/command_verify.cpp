// hamflow verify METHOD...|--all [--problem P] [--json]: the property table, measured.
#include <algorithm>
#include <atomic>
#include <iostream>
#include <optional>
#include <thread>

#include "commands.hpp"
#include "guarded.hpp"
#include "hamflow/verify/measure.hpp"
#include "progress.hpp"

namespace hamflow::app {

namespace {
std::vector<MethodSpec> methods_of(const VerifyOptions& options) {
  std::vector<MethodSpec> specs;
  for (const std::string& text : options.methods) specs.push_back(parse_method(text));
  if (!options.all) return specs;
  for (const MethodEntry& entry : methods()) {
    if (entry.family->representatives.empty()) specs.push_back(parse_method(entry.name));
    for (const std::string& text : entry.family->representatives) specs.push_back(parse_method(text));
  }
  return specs;
}

/// The problem as a scenario means it by default; where a method cannot run there, in the first variant where all can.
Region region_for(const std::string& problem, const std::vector<MethodSpec>& specs) {
  const auto accepted = [&](const ProblemEntry& entry) {
    return std::all_of(specs.begin(), specs.end(), [&](const auto& spec) { return entry.accepts(spec); });
  };
  if (!accepted(usual_problem(problem))) {
    for (const ProblemEntry& entry : problems()) {
      if (entry.info.name != problem || !accepted(entry)) continue;
      return region_of(problem, {entry.info.variant.begin(), entry.info.variant.end()});
    }
  }
  return region_of(problem);
}

/// A method, and where: without a region at walls on the given ones, or on its own.
struct Job {
  MethodSpec spec;
  std::optional<Region> at_walls{};
};

/// The rows in the order of the jobs, measured on all cores.
std::vector<PropertyRow> measure_all(const std::vector<Job>& jobs, const std::vector<Region>& given) {
  std::vector<std::optional<PropertyRow>> measured(jobs.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < jobs.size(); i = next++) {
      const auto& [method, at_walls] = jobs[i];
      measured[i] = at_walls ? measure_at_walls(method, *at_walls)
                             : measure_method(method, given.empty() ? default_regions(method) : given);
    }
  };
  {
    std::vector<std::jthread> helpers;
    const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
    for (std::size_t k = 1; k < std::min(cores, jobs.size()); ++k) helpers.emplace_back(work);
    work();
  }
  std::vector<PropertyRow> rows;
  for (auto& row : measured) rows.push_back(std::move(*row));
  return rows;
}
}  // namespace

int verify_command(const VerifyOptions& options) {
  return guarded(options.json, [&] {
    if (options.all && !options.methods.empty()) throw Error("found METHOD beside --all; allowed one of them");
    const std::vector<MethodSpec> specs = methods_of(options);
    if (specs.empty()) throw Error("verify needs at least one METHOD, or --all");
    std::vector<Region> regions;
    if (!options.problem.empty()) regions = {region_for(options.problem, specs)};
    for (const Region& region : regions) {
      for (const MethodSpec& spec : specs) (void)step_map_on(region, spec);  // throws where refused
    }
    end_on_interrupts();
    std::vector<Job> jobs;
    const auto at_walls = regions.empty() ? std::nullopt : region_at_walls(options.problem);
    for (const MethodSpec& spec : specs) {
      jobs.push_back({spec});
      // A second copy of the state meets walls elsewhere.
      if (at_walls && !describe(spec).carries_copy && find_problem(options.problem, at_walls->variant).accepts(spec)) {
        jobs.push_back({spec, at_walls});
      }
    }
    const std::vector<PropertyRow> rows = measure_all(jobs, regions);
    std::cout << (options.json ? property_json(rows) : property_table(rows));
    const bool all_agree = std::all_of(rows.begin(), rows.end(), [](const PropertyRow& row) { return row.agrees(); });
    return all_agree ? exit_done : exit_failed;
  });
}

}  // namespace hamflow::app
