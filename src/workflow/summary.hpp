// How the summary of a run comes about.
#pragma once

#include <string_view>

#include "hamflow/detail/verify/turns.hpp"
#include "hamflow/run/simulation.hpp"
#include "hamflow/scenario/scenario.hpp"
#include "hamflow/verify/certificate.hpp"
#include "hamflow/workflow/summary.hpp"

namespace hamflow {

class Measures;
struct MemberStop;

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
/// The error of a run that failed.
RunError error_of(const Scenario& scenario, const Simulation& simulation, const RunResult& result);
/// What the effective potential tells of the start of a problem that describes its orbits.
OrbitSummary orbit_of(const Scenario& scenario);
/// @param digits all of them, in arithmetic beyond double
StateAtTime state_at(double t, std::vector<double> q, std::vector<double> p, FrameDigits digits);
/// @param name of the event
StopSummary stop_summary(const std::string& name, const MemberStop& stop);
/// How an invariant with this declaration is reported.
InvariantSummary invariant_summary(const InvariantInfo& info, InvariantExcursion seen);
/// @param certificate null where nobody has watched   @param measures null where nothing was measured
/// @param turns null where nobody has watched for long steps
Summary summary_of(const Scenario& scenario, const Simulation& simulation, const RunResult& result,
                   const RunCertificate* certificate = nullptr, const Measures* measures = nullptr,
                   const TurnWatch* turns = nullptr);

}  // namespace hamflow
