// The summary of a run: what --json prints and summary.json holds.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "hamflow/run/simulation.hpp"
#include "hamflow/scenario/scenario.hpp"
#include "hamflow/verify/certificate.hpp"
#include "hamflow/verify/turns.hpp"

namespace hamflow {

class Measures;

/// What the run itself found out.
struct RunResult {
  Outcome outcome = Outcome::done;
  std::string failure;       // a sentence about the step that failed
  std::string file_trouble;  // why the samples could not be written any further
  double wall_seconds = 0;
  std::int64_t steps_taken = 0;
};

/// "done", "failed" or "interrupted".
std::string status_of(Outcome outcome);
/// Whether the run needs the derivative of each step, which a step that was halved does not have.
inline bool differentiates_steps(const Scenario& scenario) { return scenario.lyapunov > 0 || scenario.eigenvalues; }
/// The hint of the outcome, and what method, problem and the sentence about the failure add to it.
std::string hint_for(const Request& request, bool differentiated, Outcome outcome, std::string_view failure);
/// What the effective potential tells of the start of a problem that describes its orbits.
nlohmann::ordered_json orbit_of(const Scenario& scenario);
/// @param certificate null where nobody has watched   @param measures null where nothing was measured
/// @param turns null where nobody has watched for long steps
nlohmann::ordered_json summary_of(const Scenario& scenario, const Simulation& simulation, const RunResult& result,
                                  const RunCertificate* certificate = nullptr, const Measures* measures = nullptr,
                                  const TurnWatch* turns = nullptr);
/// One invariant of a summary: a number, or a list where it has several components.
nlohmann::ordered_json invariant_json(const InvariantInfo& info, const InvariantExcursion& seen);
/// The same summary for people.
std::string readable(const nlohmann::ordered_json& summary);
/// JSON as text, also of strings that are no UTF-8: names of files may be anything.
std::string json_text(const nlohmann::ordered_json& json);

}  // namespace hamflow
