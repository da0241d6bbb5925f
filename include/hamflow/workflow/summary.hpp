// Summary of a run as a struct. The command's output and summary.json are made from it.
#pragma once

#include <complex>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hamflow/core/method_info.hpp"
#include "hamflow/detail/problems/two_bodies.hpp"
#include "hamflow/run/simulation.hpp"
#include "hamflow/scenario/value.hpp"
#include "hamflow/verify/certificate.hpp"
#include "hamflow/verify/long_number.hpp"

namespace hamflow {

/// Named values, in the order in which they are reported.
template <class T>
using Named = std::vector<std::pair<std::string, T>>;

/// A problem found in a run that did not fail.
struct Warning {
  std::string kind;  // "energy_error", "long_step", ...
  std::string message;
};
/// Returns "kind: message" for each warning.
std::vector<std::string> warning_lines(const std::vector<Warning>& warnings);

/// Why a run failed.
struct RunError {
  std::string kind;       // name of an Outcome, or "file"
  std::int64_t step = 0;  // the step that failed; for kind "file" the last step that was taken
  double t = 0;           // time of the last good state
  std::string message;    // says what happened
  std::string hint;       // says what to try
  std::string details;    // iteration history of an implicit step without a solution; else empty
};

/// Positions and momenta.
struct StateSummary {
  std::vector<double> q;
  std::vector<double> p;
  FrameDigits digits{};   // time, q and p with all digits, in arithmetic with more digits than double; else empty
  bool is_large = false;  // the state is too large for a summary: q, p and their digits are empty
  std::string dataset{};  // dataset of the result file that contains a large state; empty: no file does
};
struct StateAtTime : StateSummary {
  double t = 0;
};

/// Energy H(q, p). If H depends on t, it is H minus the work of the drive.
struct EnergySummary {
  LongNumber initial;           // with all digits
  LongNumber final;             // the same
  LongNumber max_error;         // |H - H0| over every step
  std::optional<double> scale;  // max(|H0|, |T| + |V|, p dH/dp); nullopt: the problem is a map
  // max_error divided by the scale; nullopt: H is 0 at the start, or the problem is a map
  std::optional<LongNumber> max_relative_error{};
  // "recorded states": of a method with a corrector, as for invariants and means; empty: of every step
  std::string of{};
};

/// H(q, p, t) of a driven problem.
struct HamiltonianSummary {
  double initial = 0;
  double final = 0;
};

struct InvariantSummary {
  std::string name;
  bool is_list = false;  // JSON has a list instead of a number
  InvariantExcursion seen;
  /// Norm of the largest deviation; nullopt if a number at the start or at the end is not finite.
  std::optional<LongNumber> max_error() const;
};

/// Grid spacing of the arithmetic "lattice".
struct LatticeUnits {
  double position = 0;
  double momentum = 0;
};

/// Range of a quantity over all steps, and the times at the ends of the two steps that attain it.
struct DiagnosticRange {
  double min = 0;
  double t_min = 0;
  double max = 0;
  double t_max = 0;
};
/// Conditioning of the implicit steps; nullopt before the first step.
struct DiagnosticsSummary {
  std::optional<DiagnosticRange> condition_tangent;
  std::optional<DiagnosticRange> determinant_tangent;
  std::optional<DiagnosticRange> condition_inverse_mass;
};

/// Orbit in a central force, from the effective potential. Numbers have all digits of the arithmetic.
struct OrbitSummary {
  std::string type;   // "circle", "bounded closed", "bounded open", "unbounded"
  std::string conic;  // "circle", "ellipse", "parabola", "hyperbola", "line"; empty: the orbit is not a conic
  LongNumber r_min;
  LongNumber r_max;                     // infinite: the orbit is unbounded
  LongNumber circular_radius;           // NaN: there is no circular orbit
  std::optional<bool> circular_stable;  // nullopt: there is no circular orbit
  LongNumber apsidal_angle;             // rad, from pericentre to apocentre or infinity
  LongNumber radial_period;             // from pericentre to pericentre
  bool closed = false;
  double revolutions = 0;     // number until the orbit closes; NaN if it does not
  double radial_periods = 0;  // number until the orbit closes; NaN if it does not
  bool falls_into_centre = false;
  /// Change of each number by one rounding of the start; nullopt: unknown. The list is empty in double.
  Named<std::optional<double>> uncertainty{};
};

/// Exact state at the final time, and the distance of the run from it.
struct ExactSummary {
  std::vector<double> q;
  std::vector<double> p;
  double max_difference = 0;          // for the group of numbers with the largest relative difference
  double relative_difference = 0;     // max_difference divided by the size of this group
  Named<double> differences;          // one for each group of numbers with the same unit
  std::optional<double> uncertainty;  // uncertainty of the closed form; nullopt in double
};

/// Linear solves per step of an implicit method.
struct NewtonSummary {
  std::int64_t min = 0;
  double mean = 0;
  std::int64_t max = 0;
  std::int64_t stagnated = 0;  // steps that were accepted at rounding level although above the tolerance
  // iteration that was chosen automatically; empty: Newton's iteration, or the requested one
  std::string iteration;
};

/// Change of a setting of a session.
struct SessionChange {
  std::int64_t step = 0;
  double time = 0;
  std::string what;  // for example "dt = 0.05"
};

/// run.lyapunov: Lyapunov exponents of the method's own steps.
struct LyapunovSummary {
  std::vector<double> exponents;
  std::vector<double> standard_errors;  // one for each exponent
  bool steady = false;                  // the largest exponent grew steadily
  std::vector<double> pair_sums;        // each exponent plus its partner; empty unless all exponents are computed
  double time = 0;                      // averaging time; for a map, number of steps
  std::int64_t renormalisations = 0;
  std::optional<std::int64_t> stopped_at_step;  // step that could not be differentiated; nullopt: all could
};

/// run.eigenvalues: eigenvalues of M, the derivative of all steps together.
struct EigenvalueSummary {
  std::optional<std::vector<std::complex<double>>> values;  // with partners next to each other; nullopt: see message
  double pair_defect = 0;                                   // max |lambda lambda' - 1| over pairs of partners
  double symplectic_defect = 0;                             // the largest entry of |M^T J M - J|
  double norm = 0;                                          // the largest row sum of |M|
  std::string message;                                      // explains why there are no values; else empty
  std::int64_t steps = 0;                                   // M is the derivative of this many steps
};

/// run.section. The tables of the run contain the points.
struct SectionSummary {
  std::int64_t points = 0;
  double max_residual = 0;  // largest distance of a point from the section
  std::string message;      // why points may be missing; else empty
};

/// run.events: the event that ended the run, and the state there.
struct StopSummary : StateAtTime {
  std::string event;
};

/// output.observables: an expression that is evaluated at every step.
struct ObservableSummary {
  std::string name;
  double initial = 0;
  double mean = 0;  // over the steps, without the start
  double final = 0;
};

/// Results of a run, in the units of the scenario. JSON has null for numbers that are not finite.
struct Summary {
  std::string status;  // "done", "interrupted", "failed"
  std::string problem;
  std::string method;  // canonical name, for example "cg(1,5)"
  std::string arithmetic;
  std::optional<LatticeUnits> lattice{};  // only with the arithmetic "lattice"
  Value::Table parameters{};              // parameters of the problem, including defaults
  double dt = 0;
  std::int64_t steps = 0;               // number of steps taken
  std::optional<StateSummary> start{};  // nullopt: the scenario gives the start itself, not its energy
  StateAtTime final{};
  EnergySummary energy{};
  std::optional<HamiltonianSummary> hamiltonian{};  // nullopt: H does not depend on t
  std::vector<InvariantSummary> invariants{};
  std::optional<ConstraintResiduals> constraints{};  // largest over every step; nullopt: there are no constraints
  std::optional<DiagnosticsSummary> diagnostics{};   // nullopt: method.diagnostics does not request them
  std::vector<Body> bodies{};                        // bodies of a two-body problem at the end; else empty
  Value::Table elements{};                           // of each body at the end; empty: not requested
  std::optional<OrbitSummary> orbit{};               // nullopt: there is no central force, or the problem is a map
  std::optional<ExactSummary> exact{};               // nullopt: no closed form is known
  Effort effort{};                                   // numbers of evaluations and linear solves
  std::optional<NewtonSummary> newton{};             // nullopt: the method is explicit
  // numbers of bounces for each wall, halved steps, and events "user:NAME"
  Named<std::int64_t> events{};
  std::vector<std::string> event_notes{};  // remarks on these numbers
  std::optional<LyapunovSummary> lyapunov{};
  std::optional<EigenvalueSummary> eigenvalues{};
  std::optional<SectionSummary> section{};
  std::optional<StopSummary> stopped_by{};  // nullopt: no event ended the run
  std::vector<ObservableSummary> observables{};
  std::vector<Warning> warnings{};
  std::optional<RunCertificate> certificate{};  // nullopt: it is not requested, or the problem is a map
  double wall_seconds = 0;                      // over all parts of the run
  double steps_per_second = 0;
  std::optional<RunError> error{};       // nullopt: the run did not fail
  std::vector<SessionChange> changes{};  // changes of a session; empty for runs
};

/// Returns the text of summary.json.
std::string summary_json(const Summary& summary);
/// Returns the summary as text, one line for each entry.
std::string summary_text(const Summary& summary);
/// Reads the text of summary.json. The parts of `effort` and `certificate` that JSON does not contain keep their
/// default values.
/// @throws std::exception if the text is not such JSON
Summary read_summary(const std::string& json);

}  // namespace hamflow
