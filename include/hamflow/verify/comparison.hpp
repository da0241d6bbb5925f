// **Comparison** of methods on one run: what accuracy costs.
// Each method goes the same way with several steps; the error at the end is measured against the closed form where
// there is one, else against a method of another family.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hamflow/run/catalog.hpp"
#include "hamflow/run/observer.hpp"
#include "hamflow/run/step_map.hpp"

namespace hamflow {

/// What is compared.
struct ComparisonRequest {
  Request request;  // problem, start, arithmetic; its method and dt are replaced
  std::vector<MethodSpec> methods;
  double t_end = 0;
  std::vector<std::int64_t> steps;  // to t_end, one for each dt
};

/// The end state that errors are measured against.
struct ReferenceSolution {
  std::string kind;  // "closed form", "extrapolation"
  std::string description;
  State<double> end;       // q, then p
  double uncertainty = 0;  // of its largest coordinate, estimated
};

/// One method with one dt, or one tolerance.
struct ComparisonPoint {
  std::string method;  // canonical
  int order = 0;
  bool explicit_step = true;
  double dt = 0;
  std::int64_t steps = 0;
  std::optional<double> tolerance;  // of an adaptive method, which has it in place of dt
  Outcome outcome = Outcome::done;
  std::string failure;
  double error = 0;                          // largest coordinate of the difference at the end
  double max_energy_error = 0;               // over every step, relative to the energy's scale
  double end_energy_error = 0;               // the same at the end
  long long force = 0, gradient = 0;         // evaluations
  long long hessian = 0, linear_solves = 0;  //
  double seconds = 0;                        // of the bare steps, median of repeats: wall or processor, what is less
  double wall_seconds = 0;                   // by the clock on the wall
  double evaluations() const { return static_cast<double>(force + gradient); }
  bool done() const { return outcome == Outcome::done; }
};

/// The cheapest way to an error, by interpolation of log(work) over log(error) between the steps of a method.
struct ComparisonWinner {
  double error = 0;
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

/// Numbers of steps for twice, once, a half, ... of the given dt: `count` of them, without those that fall together.
std::vector<std::int64_t> usual_step_counts(std::int64_t steps, int count = 6);

/// @throws Error when there is none: the motion cannot be followed to the end
ReferenceSolution reference_solution(const ComparisonRequest& asked, const std::function<bool()>& pulse = {});

/// @param progress called before each point with how many are done; returns false to stop
Comparison compare(const ComparisonRequest& asked, const std::function<bool(std::size_t done)>& progress = {});

/// At every power of ten that at least one method reaches, for either kind of work.
std::vector<ComparisonWinner> winners(const Comparison& comparison);

std::string comparison_table(const Comparison& comparison);
std::string comparison_csv(const Comparison& comparison);

}  // namespace hamflow
