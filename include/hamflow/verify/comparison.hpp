// **Comparison** of methods on one run: the cost of accuracy.
// Each method integrates the same motion with several step sizes or tolerances. The error at the end is measured
// against a reference with a stated uncertainty (verify/reference_solution.hpp), in the digits of the run.
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

/// The request of a comparison.
struct ComparisonRequest {
  Request request;  // problem, start, arithmetic; its method and dt are replaced
  std::vector<MethodSpec> methods;
  double t_end = 0;
  std::vector<std::int64_t> steps;  // numbers of steps to t_end, one for each dt
  std::string t_end_text{};         // t_end with all digits, a number expression; empty: t_end
  /// The dt of a number of steps, as a single run reads it. Without an entry dt is t_end / steps, which may differ from
  /// the typed number by a rounding.
  std::map<std::int64_t, std::string> dts{};
};

/// Whether `steps` steps of length `dt` give t_end in every digit of the arithmetic; dt and t_end are number
/// expressions.
bool divides_exactly(const std::string& dt, std::int64_t steps, const std::string& t_end,
                     const std::string& arithmetic);

/// One method with one dt, or one tolerance.
struct ComparisonPoint {
  std::string method;  // one of comparison_names()
  int order = 0;
  bool explicit_step = true;
  double dt = 0;
  std::int64_t steps = 0;
  std::optional<double> tolerance;  // for an adaptive method, in place of dt
  Outcome outcome = Outcome::done;
  std::string failure;
  Magnitude error;  // largest difference at the end, relative to its size along the motion
  std::vector<std::pair<std::string, Magnitude>> differences;  // of each group of numbers with one unit, in that unit
  bool below_uncertainty = false;            // the error is below the uncertainty of the reference, so only a bound
  Magnitude max_energy_error;                // over every step, relative to the energy's scale
  Magnitude end_energy_error;                // the same at the end
  long long force = 0, gradient = 0;         // evaluations; for taylor each coefficient of the series counts as one
  long long hessian = 0, linear_solves = 0;  //
  double seconds = 0;                        // of the bare steps, median of repeats; the smaller of wall and CPU time
  double wall_seconds = 0;                   // wall time
  double evaluations() const { return static_cast<double>(force + gradient); }
  bool done() const { return outcome == Outcome::done; }
};

/// The method that reaches an error, or a smaller one, with the least work. log(work) is interpolated over log(error)
/// between the steps of a method.
struct ComparisonWinner {
  Magnitude error;
  std::string by;  // "evaluations", "seconds"
  std::string method;
  double work = 0;
  std::string second;  // the runner-up, empty if there is none
  double second_work = 0;
};

struct Comparison {
  std::string problem, arithmetic;
  double t_end = 0;
  ReferenceSolution reference;
  std::vector<ComparisonPoint> points;  // method by method
  bool stopped = false;
};

/// The progress of a comparison, including the reference.
struct ComparisonProgress {
  std::size_t done = 0;  // runs
  std::size_t runs = 0;
  double part = 0;                     // fraction of the time, in [0, 1]; 0 until it is known
  std::optional<double> seconds_left;  // known when every method and the reference have been timed
};

/// Numbers of steps for twice, once, a half, ... of the given dt: `count` of them, without duplicates.
std::vector<std::int64_t> usual_step_counts(std::int64_t steps, int count = 6);

/// Unique names of the methods. If two have the same canonical name, the options in which they differ are added. Equal
/// names mean the same method with the same options.
std::vector<std::string> comparison_names(const std::vector<MethodSpec>& methods);

/// Notes about the rows of adaptive methods and about the reference, a sentence each.
std::vector<std::string> comparison_notes(const ComparisonRequest& asked);

/// Runs a comparison. If it is stopped before the reference is complete, the result has no points.
/// @param progress called several times a second; returns false to stop
/// @throws Error if there is no reference, because the motion cannot be followed to the end
Comparison compare(const ComparisonRequest& asked, const std::function<bool(const ComparisonProgress&)>& progress = {});

/// The winners at every power of ten that at least one method reaches and that is above the uncertainty of the
/// reference, for both kinds of work.
std::vector<ComparisonWinner> winners(const Comparison& comparison);

std::string comparison_table(const Comparison& comparison);
std::string comparison_csv(const Comparison& comparison);

}  // namespace hamflow
