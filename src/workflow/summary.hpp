// Makes the summary of a run.
#pragma once

#include <string_view>

#include "hamflow/detail/verify/turning_points.hpp"
#include "hamflow/run/simulation.hpp"
#include "hamflow/scenario/scenario.hpp"
#include "hamflow/verify/certificate.hpp"
#include "hamflow/workflow/summary.hpp"

namespace hamflow {

class Measures;
struct MemberStop;

/// Result of taking the steps of a run.
struct RunResult {
  Outcome outcome = Outcome::done;
  std::string failure;       // describes the step that failed
  std::string file_error;    // explains why samples could not be written
  std::string client_error;  // explains why the client of a socket gave no forces; the outcome is then "stopped"
  double wall_seconds = 0;
  std::int64_t steps_taken = 0;
};

/// Returns "done", "failed" or "interrupted".
std::string status_of(Outcome outcome);
/// Returns whether the run needs the derivative of each step. A halved step has none.
inline bool differentiates_steps(const Scenario& scenario) { return scenario.lyapunov > 0 || scenario.eigenvalues; }
/// Returns the hint for an outcome, which also depends on the method, the problem and the message of the failure.
std::string hint_for(const Request& request, bool differentiated, Outcome outcome, std::string_view failure);
/// Returns the error of a run that failed.
RunError error_of(const Scenario& scenario, const Simulation& simulation, const RunResult& result);
/// Returns the orbit through the start, from the effective potential, for a problem that describes its orbits.
OrbitSummary orbit_of(const Scenario& scenario);
/// @param digits all digits, in arithmetic with more digits than double; else empty
StateAtTime state_at(double t, std::vector<double> q, std::vector<double> p, FrameDigits digits);
/// @param name name of the event
StopSummary stop_summary(const std::string& name, const MemberStop& stop);
/// Returns the summary of an invariant with this declaration.
InvariantSummary invariant_summary(const InvariantInfo& info, InvariantExcursion seen);
/// @param certificate null: there is none   @param measures null: nothing was measured
/// @param turns null: nothing watched for steps that are too long
Summary summary_of(const Scenario& scenario, const Simulation& simulation, const RunResult& result,
                   const RunCertificate* certificate = nullptr, const Measures* measures = nullptr,
                   const TurningPointObserver* turns = nullptr);

}  // namespace hamflow
