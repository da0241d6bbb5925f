// The summary of a run: what --json prints and summary.json holds.   [spec: product, section 4]
#pragma once

#include <nlohmann/json.hpp>

#include "hamflow/run/simulation.hpp"
#include "scenario.hpp"

namespace hamflow {

/// What the run itself found out.
struct RunResult {
  Outcome outcome = Outcome::done;
  std::string failure;  // a sentence about the step that failed
  double wall_seconds = 0;
  std::int64_t steps_taken = 0;
};

/// "done", "failed" or "interrupted".
std::string status_of(Outcome outcome);
nlohmann::ordered_json summary_of(const Scenario& scenario, const Simulation& simulation, const RunResult& result);
/// {"status": "rejected", "errors": [{file, line, column, key, message}, ...]}
nlohmann::ordered_json rejection_of(const std::vector<Complaint>& complaints);
/// The same summary for people.
std::string readable(const nlohmann::ordered_json& summary);

}  // namespace hamflow
