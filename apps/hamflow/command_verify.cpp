// hamflow verify METHOD...|--all [--problem P] [--json]: the property table, measured.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <mutex>
#include <nlohmann/json.hpp>
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
  std::vector<Complaint> unknown;
  for (const std::string& text : options.methods) {
    try {
      specs.push_back(parse_method(text));
    } catch (const Error& error) {
      unknown.push_back({"", 0, 0, "METHOD", error.what()});
    }
  }
  if (!unknown.empty()) throw Rejection(std::move(unknown));
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
  if (!accepted(*usual_problem(problem))) {
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

/// What is measured, on all cores: the main thread waits, so that it can say what is there when it is interrupted.
class Measuring {
 public:
  Measuring(const std::vector<Job>& jobs, const std::vector<Region>& given)
      : jobs_(jobs), given_(given), measured_(jobs.size()) {
    const std::size_t all = std::min<std::size_t>(std::max(1u, std::thread::hardware_concurrency()), jobs.size());
    at_work_ = all;
    for (std::size_t k = 0; k < all; ++k) helpers_.emplace_back([this] { work(); });
  }

  /// Until all is measured, or an interrupt.   @return false when interrupted
  bool wait() {
    std::unique_lock lock(mutex_);
    while (at_work_ > 0 && !interrupted()) finished_.wait_for(lock, std::chrono::milliseconds(20));
    if (at_work_ > 0) return false;
    if (failure_) std::rethrow_exception(failure_);
    return true;
  }
  /// Those that are there, in the order of the jobs.
  std::vector<PropertyRow> rows() {
    const std::lock_guard lock(mutex_);
    std::vector<PropertyRow> all;
    for (const auto& row : measured_) {
      if (row) all.push_back(*row);
    }
    return all;
  }

 private:
  void work() {
    try {
      for (std::size_t i = next_++; i < jobs_.size(); i = next_++) {
        const auto& [method, at_walls] = jobs_[i];
        PropertyRow row = at_walls ? measure_at_walls(method, *at_walls)
                                   : measure_method(method, given_.empty() ? default_regions(method) : given_);
        const std::lock_guard lock(mutex_);
        measured_[i] = std::move(row);
      }
    } catch (...) {
      next_ = jobs_.size();
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    --at_work_;
    finished_.notify_all();
  }

  const std::vector<Job>& jobs_;
  const std::vector<Region>& given_;
  std::vector<std::optional<PropertyRow>> measured_;
  std::atomic<std::size_t> next_{0};
  std::size_t at_work_ = 0;
  std::exception_ptr failure_;
  std::mutex mutex_;
  std::condition_variable finished_;
  std::vector<std::jthread> helpers_;  // the last member: they end before what they use
};

/// What was measured before an interrupt, as the whole would have been printed. Helpers that are still at work have
/// nothing to save: the process ends without them.
[[noreturn]] void end_interrupted(const std::vector<PropertyRow>& rows, bool json) {
  if (json) {
    nlohmann::json all = nlohmann::json::parse(property_json(rows));
    all["status"] = "interrupted";
    std::cout << all.dump(2) << '\n';
  } else if (!rows.empty()) {
    std::cout << property_table(rows);
  }
  std::_Exit(written_out(exit_interrupted));
}
}  // namespace

int verify_command(const VerifyOptions& options) {
  return guarded(options.json, [&] {
    if (options.all && !options.methods.empty())
      throw Rejection("METHOD", "found METHOD beside --all; allowed one of them");
    const std::vector<MethodSpec> specs = methods_of(options);
    if (specs.empty()) throw Error("verify needs at least one METHOD, or --all");
    std::vector<Region> regions;
    try {
      if (!options.problem.empty()) regions = {region_for(options.problem, specs)};
    } catch (const Error& error) {
      throw Rejection("--problem", error.what());
    }
    for (const Region& region : regions) {
      for (const MethodSpec& spec : specs) (void)step_map_on(region, spec);  // throws where refused
    }
    catch_interrupts();
    std::vector<Job> jobs;
    const auto at_walls = regions.empty() ? std::nullopt : region_at_walls(options.problem);
    for (const MethodSpec& spec : specs) {
      jobs.push_back({spec});
      // A second copy of the state meets walls elsewhere.
      if (at_walls && !describe(spec).carries_copy && find_problem(options.problem, at_walls->variant)->accepts(spec)) {
        jobs.push_back({spec, at_walls});
      }
    }
    Measuring measuring(jobs, regions);
    if (!measuring.wait()) end_interrupted(measuring.rows(), options.json);
    const std::vector<PropertyRow> rows = measuring.rows();
    std::cout << (options.json ? property_json(rows) : property_table(rows));
    const bool all_agree = std::all_of(rows.begin(), rows.end(), [](const PropertyRow& row) { return row.agrees(); });
    return all_agree ? exit_done : exit_failed;
  });
}

}  // namespace hamflow::app
