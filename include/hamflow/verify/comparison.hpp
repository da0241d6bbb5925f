// **Comparison** of methods on one run: what accuracy costs.
// Each method goes the same way with several steps, or tolerances; the error at the end is measured against a reference
// whose uncertainty is stated (verify/reference_solution.hpp), in the digits of the run.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hamflow/run/catalog.hpp"
#include "hamflow/run/observer.hpp"
#include "hamflow/verify/reference_solution.hpp"

namespace hamflow {

/// What is compared.
struct ComparisonRequest {
  Request request;  // problem, start, arithmetic; its method and dt are replaced
  std::vector<MethodSpec> methods;
  double t_end = 0;
  std::vector<std::int64_t> steps;  // to t_end, one for each dt
  std::string t_end_text{};         // with all its digits, a number expression; empty: that of t_end
  /// The dt of a number of steps, as a single run reads it. Those without an entry have t_end / steps, which another
  /// rounding separates from the number that was typed.
  std::map<std::int64_t, std::string> dts{};
};

/// Whether `steps` steps of length `dt` make t_end in every digit of the arithmetic; number expressions.
bool divides_exactly(const std::string& dt, std::int64_t steps, const std::string& t_end,
                     const std::string& arithmetic);

/// One method with one dt, or one tolerance.
struct ComparisonPoint {
  std::string method;  // one of comparison_names()
  int order = 0;
  bool explicit_step = true;
  double dt = 0;
  std::int64_t steps = 0;
  std::optional<double> tolerance;  // of an adaptive method, which has it in place of dt
  Outcome outcome = Outcome::done;
  std::string failure;
  Magnitude error;                           // largest coordinate of the difference at the end
  bool below_uncertainty = false;            // of the reference: the error is no more than that it is small
  Magnitude max_energy_error;                // over every step, relative to the energy's scale
  Magnitude end_energy_error;                // the same at the end
  long long force = 0, gradient = 0;         // evaluations; of taylor a coefficient of the series counts as one
  long long hessian = 0, linear_solves = 0;  //
  double seconds = 0;                        // of the bare steps, median of repeats: wall or processor, what is less
  double wall_seconds = 0;                   // by the clock on the wall
  double evaluations() const { return static_cast<double>(force + gradient); }
  bool done() const { return outcome == Outcome::done; }
};

/// The cheapest way to an error, or a smaller one, by interpolation of log(work) over log(error) between the steps of a
/// method.
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

/// How far a comparison is, reference included.
struct ComparisonProgress {
  std::size_t done = 0;  // runs
  std::size_t runs = 0;
  double part = 0;                     // of the time, in [0, 1]; 0 until it can be told
  std::optional<double> seconds_left;  // as soon as every method and the reference have shown their pace
};

/// Numbers of steps for twice, once, a half, ... of the given dt: `count` of them, without those that fall together.
std::vector<std::int64_t> usual_step_counts(std::int64_t steps, int count = 6);

/// What the methods are called, each by a name of its own: where two have the same canonical name, the options in which
/// they differ stand in it. Two that are called the same are the same method with the same options.
std::vector<std::string> comparison_names(const std::vector<MethodSpec>& methods);

/// What one has to know about the rows of adaptive methods, a sentence each.
std::vector<std::string> comparison_notes(const ComparisonRequest& asked);

/// Stopped before the reference is there, it has no points.
/// @param progress called several times a second; returns false to stop
/// @throws Error when there is no reference: the motion cannot be followed to the end
Comparison compare(const ComparisonRequest& asked, const std::function<bool(const ComparisonProgress&)>& progress = {});

/// At every power of ten that at least one method reaches and the reference can tell, for either kind of work.
std::vector<ComparisonWinner> winners(const Comparison& comparison);

std::string comparison_table(const Comparison& comparison);
std::string comparison_csv(const Comparison& comparison);

}  // namespace hamflow
