// **Comparison** of methods on one run: how much work an accuracy costs.
// Each method integrates the same motion with several step sizes or tolerances. The error at the end is measured
// against a reference solution with a stated uncertainty (verify/reference_solution.hpp), in the arithmetic of the run.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hamflow/run/catalog.hpp"
#include "hamflow/run/observer.hpp"
#include "hamflow/verify/reference_solution.hpp"

namespace hamflow {

/// What is to be compared.
struct ComparisonRequest {
  Request request;  // problem, start and arithmetic are used; method and dt are replaced
  std::vector<MethodSpec> methods;
  double t_end = 0;
  std::vector<std::int64_t> steps;  // numbers of steps until t_end, one for each dt
  std::string t_end_text{};         // t_end with all digits, a number expression; empty: t_end
  /// The dt that belongs to a number of steps, exactly as a single run reads it. Without an entry dt is t_end / steps,
  /// which may differ from the typed number by a rounding.
  std::map<std::int64_t, std::string> dts{};
};

/// Returns whether `steps` steps of size `dt` end at t_end in every digit of the arithmetic. dt and t_end are number
/// expressions.
bool divides_exactly(const std::string& dt, std::int64_t steps, const std::string& t_end,
                     const std::string& arithmetic);

/// Result of one method with one dt or one tolerance.
struct ComparisonPoint {
  std::string method;  // one of comparison_names()
  int order = 0;
  bool explicit_step = true;
  double dt = 0;
  std::int64_t steps = 0;
  std::optional<double> tolerance;  // tolerance of an adaptive method, in place of dt
  Outcome outcome = Outcome::done;
  std::string failure;
  Magnitude error;  // largest difference from the reference at the end, relative to its size along the motion
  // differences of each group of numbers with one unit, in that unit
  std::vector<std::pair<std::string, Magnitude>> differences;
  // the error is below the uncertainty of the reference, so only a bound is known
  bool below_uncertainty = false;
  Magnitude max_energy_error;  // over every step, relative to the scale of the energy
  Magnitude end_energy_error;  // energy error at the end, relative to the same scale
  // number of evaluations; taylor counts each coefficient of its series as one
  long long force = 0, gradient = 0;
  long long hessian = 0, linear_solves = 0;
  // of the bare steps: the median of repeats, each the smaller of wall and CPU time
  double seconds = 0;
  double wall_seconds = 0;
  double evaluations() const { return static_cast<double>(force + gradient); }
  bool done() const { return outcome == Outcome::done; }
};

/// The method that reaches an error, or a smaller one, with the least work. Between the step sizes of a method,
/// log(work) is interpolated over log(error).
struct ComparisonWinner {
  Magnitude error;
  std::string by;  // kind of work: "evaluations" or "seconds"
  std::string method;
  double work = 0;
  std::string second;  // the runner-up, empty if there is none
  double second_work = 0;
};

struct Comparison {
  std::string problem, arithmetic;
  double t_end = 0;
  ReferenceSolution reference;
  std::vector<ComparisonPoint> points;  // ordered by method
  bool stopped = false;
};

/// Progress of a comparison, including its reference solution.
struct ComparisonProgress {
  std::size_t done = 0;  // number of finished runs
  std::size_t runs = 0;
  double part = 0;                     // finished fraction of the expected time, in [0, 1]; 0 until it is known
  std::optional<double> seconds_left;  // known once every method and the reference have been timed
};

/// Returns `count` numbers of steps, for twice, once, a half, ... of the given dt, without duplicates.
std::vector<std::int64_t> usual_step_counts(std::int64_t steps, int count = 6);

/// Returns unique names of the methods. If two have the same canonical name, the options in which they differ are
/// added. Equal names mean the same method with the same options.
std::vector<std::string> comparison_names(const std::vector<MethodSpec>& methods);

/// Returns notes on the rows of adaptive methods and on the reference, a sentence each.
std::vector<std::string> comparison_notes(const ComparisonRequest& asked);

/// Runs a comparison. The result has no points if it is stopped before the reference is complete.
/// @param progress called several times a second; returns false to stop
/// @throws Error if there is no reference, because the motion cannot be integrated to the end
Comparison compare(const ComparisonRequest& asked, const std::function<bool(const ComparisonProgress&)>& progress = {});

/// Returns the winners for both kinds of work, at every power of ten that at least one method reaches and that is above
/// the uncertainty of the reference.
std::vector<ComparisonWinner> winners(const Comparison& comparison);

std::string comparison_table(const Comparison& comparison);
std::string comparison_csv(const Comparison& comparison);

}  // namespace hamflow
