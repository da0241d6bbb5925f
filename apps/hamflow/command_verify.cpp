#include "command_verify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <optional>
#include <thread>

#include "hamflow/verify/measure.hpp"
#include "summary.hpp"

namespace {
std::vector<hamflow::MethodSpec> methods_of(const VerifyOptions& options) {
  std::vector<hamflow::MethodSpec> specs;
  for (const std::string& text : options.methods) specs.push_back(hamflow::parse_method(text));
  if (!options.all) return specs;
  for (const hamflow::MethodEntry& entry : hamflow::methods()) {
    if (entry.family->representatives.empty()) specs.push_back(hamflow::parse_method(entry.name));
    for (const std::string& text : entry.family->representatives) specs.push_back(hamflow::parse_method(text));
  }
  return specs;
}

/// The problem as a scenario means it by default; where a method cannot run there, in the first variant where all can.
hamflow::Region region_for(const std::string& problem, const std::vector<hamflow::MethodSpec>& specs) {
  const auto accepted = [&](const hamflow::ProblemEntry& entry) {
    return std::all_of(specs.begin(), specs.end(), [&](const auto& spec) { return entry.accepts(spec); });
  };
  if (!accepted(hamflow::usual_problem(problem))) {
    for (const hamflow::ProblemEntry& entry : hamflow::problems()) {
      if (entry.info.name != problem || !accepted(entry)) continue;
      return hamflow::region_of(problem, {entry.info.variant.begin(), entry.info.variant.end()});
    }
  }
  return hamflow::region_of(problem);
}

/// The rows in the order of the methods, measured on all cores.
std::vector<hamflow::PropertyRow> measure_all(const std::vector<hamflow::MethodSpec>& specs,
                                              const std::vector<hamflow::Region>& given) {
  std::vector<std::optional<hamflow::PropertyRow>> measured(specs.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < specs.size(); i = next++)
      measured[i] = hamflow::measure_method(specs[i], given.empty() ? hamflow::default_regions(specs[i]) : given);
  };
  {
    std::vector<std::jthread> helpers;
    const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
    for (std::size_t k = 1; k < std::min(cores, specs.size()); ++k) helpers.emplace_back(work);
    work();
  }
  std::vector<hamflow::PropertyRow> rows;
  for (auto& row : measured) rows.push_back(std::move(*row));
  return rows;
}
}  // namespace

int run_verify(const VerifyOptions& options) {
  std::vector<hamflow::MethodSpec> specs;
  std::vector<hamflow::Region> regions;
  try {
    specs = methods_of(options);
    if (specs.empty()) throw hamflow::Error("verify needs at least one METHOD, or --all");
    if (!options.problem.empty()) regions = {region_for(options.problem, specs)};
    for (const hamflow::Region& region : regions) {
      for (const hamflow::MethodSpec& spec : specs) (void)hamflow::step_map_on(region, spec);  // throws where refused
    }
  } catch (const hamflow::Error& error) {
    fmt::print(stderr, "hamflow verify: error: {}\n", error.what());
    if (options.json) {
      const nlohmann::ordered_json errors{{{"key", "verify"}, {"message", error.what()}}};
      std::fputs(hamflow::json_text({{"status", "rejected"}, {"errors", errors}}).c_str(), stdout);
    }
    return 2;
  }
  const std::vector<hamflow::PropertyRow> rows = measure_all(specs, regions);
  std::fputs((options.json ? hamflow::property_json(rows) : hamflow::property_table(rows)).c_str(), stdout);
  return std::all_of(rows.begin(), rows.end(), [](const hamflow::PropertyRow& row) { return row.agrees(); }) ? 0 : 1;
}
