#include "hamflow/verify/reference_solution.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/double_constants.hpp"
#include "hamflow/core/counter_random.hpp"
#include "hamflow/core/stop_question.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/detail/verify/state_units.hpp"
#include "hamflow/run/walls.hpp"
#include "hamflow/verify/extrapolated_midpoint.hpp"
#include "rounding.hpp"
#include "state_difference.hpp"

namespace hamflow {

namespace {

State<double> joined_state(const Frame& frame) {
  State<double> z = frame.q;
  z.insert(z.end(), frame.p.begin(), frame.p.end());
  return z;
}

std::vector<std::string> all_exact_digits(const std::vector<double>& x) {
  std::vector<std::string> all;
  for (const double number : x) all.push_back(exact_digits(number));
  return all;
}

/// Returns the numbers rounded to double, as the run in double uses them.
Texts rounded(const Texts& parameters) {
  Texts all = parameters;
  for (auto& [name, text] : all) {
    if (text.empty()) continue;
    const std::vector<std::string> parts = list_parts(text);
    const std::string numbers =
        joined(parts, [](const std::string& part) { return exact_digits(evaluate_number<double>(part)); });
    text = text.front() == '[' ? "[" + numbers + "]" : numbers;
  }
  return all;
}

/// Returns whether the orbit ends in the centre, where H has no value. A closed form may continue past the centre, but
/// that is no motion.
bool falls_into_centre(const ProblemEntry& problem, const Texts& parameters, const Frame& start) {
  if (!problem.describe_orbit) return false;
  const OrbitFacts facts = problem.describe_orbit(parameters, start.q, start.p);
  return std::any_of(facts.begin(), facts.end(), [](const auto& fact) {
    const bool* falls = std::get_if<bool>(&fact.second);
    return fact.first == "falls_into_centre" && falls != nullptr && *falls;
  });
}

/// Returns for each number of a state the size by which its difference is divided.
State<double> sizes_along(const ProblemEntry& problem, const StateSizes& sizes) {
  const std::size_t n = sizes.q.size();
  const UnitGroups groups = unit_groups(problem, n);
  const std::vector<double> of_groups = group_sizes(groups, sizes).size;
  State<double> all(2 * n);
  for (std::size_t i = 0; i < 2 * n; ++i) {
    const double size = of_groups[i < n ? groups.group(i) : groups.count() + groups.group(i - n)];
    all[i] = size > 0 && std::isfinite(size) ? size : 1;
  }
  return all;
}

/// Returns a pseudo-random number in [0, 1), the same in every run. The sizes of a motion are sampled at random times,
/// because at times in step with an oscillation the momenta may be 0 each time.
double random_part(std::int64_t k) { return 0.5 + 0.5 * counter_uniform(64, static_cast<std::uint64_t>(k)); }

/// Evaluates the closed form in long double from the start in double. The uncertainty consists of the rounding of the
/// returned numbers and of 32 roundings of long double in each coordinate of the start, amplified by the motion until
/// the end.
std::optional<ReferenceSolution> closed_form(const Request& request, const ProblemEntry& problem, double t_end) {
  if (!problem.exact) return std::nullopt;
  const Frame start = problem.start(request);
  const Texts parameters = problem.derived(request.parameters, request.start);
  // an integration finds the time of the collision
  if (falls_into_centre(problem, parameters, start)) return std::nullopt;
  const auto exact = problem.exact(parameters, start.q, start.p, t_end);
  if (!exact) return std::nullopt;
  ReferenceSolution found{"closed form", "the closed form of the problem, in double", joined_state(*exact), {}, {}, {}};
  found.digits = all_exact_digits(found.end);
  StateSizes seen;
  seen.include(start.q, start.p);
  constexpr int looks = 24;
  for (int k = 1; k <= looks; ++k) {
    const auto at = problem.exact(parameters, start.q, start.p, t_end * (k - random_part(k)) / looks);
    if (at) seen.include(at->q, at->p);
  }
  found.sizes = sizes_along(problem, seen);
  double moved_by = 0;
  for (std::size_t i = 0; i < 2 * start.q.size(); ++i) {
    Frame near = start;
    double& x = i < start.q.size() ? near.q[i] : near.p[i - start.q.size()];
    const double along = i < start.q.size() ? seen.q[i] : seen.p[i - start.q.size()];
    x += epsilon * (x != 0 ? x : along);
    const auto moved = problem.exact(parameters, near.q, near.p, t_end);
    if (!moved) return std::nullopt;  // the neighbouring motion is unknown, so the uncertainty is, too
    const State<double> end = joined_state(*moved);
    double most = 0;
    for (std::size_t k = 0; k < end.size(); ++k)
      most = std::max(most, std::abs(end[k] - found.end[k]) / found.sizes[k]);
    moved_by += most;
  }
  constexpr double share = 32 * 0x1p-11;  // relative to a rounding of double
  double of_the_end = 0;
  for (std::size_t k = 0; k < found.end.size(); ++k) {
    of_the_end = std::max(of_the_end, std::abs(found.end[k]) / found.sizes[k]);
  }
  found.uncertainty = epsilon / 2 * of_the_end + share * moved_by;
  return found;
}

}  // namespace

int digits_of(const std::string& arithmetic) {
  const int digits = digits_beyond_double(arithmetic);
  return digits > 0 ? digits : 16;
}

std::string reference_arithmetic(const std::string& arithmetic) {
  const int digits = digits_of(arithmetic);
  if (digits <= 18) return "double-double";
  // Ten digits allow for the growth of errors until the end; a sixth more for digits that extrapolation with many
  // columns loses.
  return fmt::format("mp({})", digits + 10 + digits / 6);
}

class ReferenceRun::Impl {
 public:
  Impl(const Request& request, const std::string& t_end, std::int64_t steps) : problem_(find_problem(request)) {
    const ProblemEntry& problem = *problem_;
    Request full = request;
    full.parameters = complete(problem.info, request.parameters);
    const bool beyond_double = digits_beyond_double(request.arithmetic) > 0;
    std::optional<DoubleConstants> constants;  // needed while the simulations are made
    if (!beyond_double) {
      if (auto exact = closed_form(full, problem, evaluate_number<double>(t_end))) {
        solution_ = std::move(*exact);
        return;
      }
      const Frame start = problem.start(full);
      full.parameters = rounded(problem.derived(full.parameters, full.start));
      full.start = {.q = all_exact_digits(start.q), .p = all_exact_digits(start.p)};
      constants.emplace();
    }
    full.arithmetic = reference_arithmetic(request.arithmetic);
    full.threads = 1;
    // Pieces cut sub-steps short, so there should be fewer pieces than sub-steps, which are a few hundred steps long.
    // But a piece has at most 800 steps, because Taylor series are stopped only between pieces.
    pieces_ = std::max<std::int64_t>(steps / 800, 16);
    // With hard walls the exact motion bounces at located times, whatever the rule of the run is. Pieces as short as
    // the steps of the run locate the bounces.
    if (full.walls && full.walls->hard()) {
      full.walls->rule = WallRule::event;
      pieces_ = std::max<std::int64_t>(steps, 16);
    }
    const std::string end = beyond_double ? t_end : exact_digits(evaluate_number<double>(t_end));
    full.dt = "(" + end + ")/" + std::to_string(pieces_);
    // tolerances are doubles, so they cannot be smaller
    const int digits = std::min(digits_of(request.arithmetic), 290);
    const MethodSpec taylor{"taylor", {{tolerance_option, fmt::format("1e-{}", digits + 3)}}};
    // Problems with constraints are integrated as a vector field with multipliers, whatever the form of the run is.
    const bool recordable = problem.accepts(taylor) || !problem.constraint_form.empty();
    first_tolerance_ = std::pow(10.0, -digits - 3);
    second_tolerance_ = std::pow(10.0, recordable ? -digits - 2 : -digits);
    full.method = recordable ? taylor : extrapolated(first_tolerance_);
    first_name_ = recordable ? "Taylor series of order " + std::to_string(describe(taylor).order)
                             : extrapolation_name(first_tolerance_);
    first_ = problem.accepts(taylor) ? make_simulation(full) : problem.simulate_erased(full);
    full.method = extrapolated(second_tolerance_);
    second_ = problem.simulate_erased(full);
    arithmetic_ = full.arithmetic;
    look();
  }

  void advance(const std::function<bool()>& goes_on) {
    const StopQuestion question(goes_on);
    constexpr std::int64_t looked_into = 16;  // number of pieces that are sampled within
    if (first_ != nullptr && first_->step() < looked_into) {
      Frame within;
      if (first_->look_part(random_part(first_->step()), within) == Outcome::done) seen_.include(within.q, within.p);
    }
    for (Simulation* one : {first_.get(), second_.get()}) {
      if (one == nullptr) continue;
      const Outcome outcome = one->advance(1);
      if (outcome == Outcome::stopped) return;
      if (outcome != Outcome::done) {
        const std::string why = one->failure().empty() ? std::string(message(outcome)) : cause_of(one->failure());
        Frame frame;
        one->look(frame);
        throw Error("there is no reference solution: the motion cannot be integrated beyond t = " +
                    shortest(frame.time) + ": " + why);
      }
    }
    look();
    if (finished()) compare();
  }
  bool finished() const { return first_ == nullptr || first_->step() == pieces_; }
  double part() const {
    return first_ == nullptr ? 1 : static_cast<double>(first_->step()) / static_cast<double>(pieces_);
  }
  const ReferenceSolution& solution() const { return solution_; }

 private:
  static MethodSpec extrapolated(double tolerance) {
    return {ExtrapolatedMidpoint::name, {{tolerance_option, shortest(tolerance)}}};
  }
  static std::string extrapolation_name(double tolerance) {
    return fmt::format("extrapolated midpoint rule of order {}", 2 * extrapolation_columns(tolerance));
  }

  void look() {
    Frame frame;
    first_->look(frame);
    seen_.include(frame.q, frame.p);
  }
  void compare() {
    Frame frame;
    first_->look(frame);
    solution_.kind = "integration";
    solution_.end = joined_state(frame);
    solution_.digits = state_digits(frame);
    second_->look(frame);
    const int digits = digits_of(arithmetic_);
    solution_.sizes = sizes_along(*problem_, seen_);
    const Magnitude difference =
        largest_difference(solution_.digits, state_digits(frame), solution_.sizes, digits + 10);
    // The uncertainty is at least the tolerance of the less accurate integration, because both errors may agree by
    // chance.
    const Magnitude least = second_tolerance_;
    const Magnitude twice = difference.text.empty() ? Magnitude(2 * difference.value) : difference;
    solution_.uncertainty = twice < least ? least : twice;
    solution_.description = fmt::format(
        "{}, tolerance {:.0e}, in {}; relative difference {} from the {}, tolerance {:.0e}", first_name_,
        first_tolerance_, arithmetic_, readable(difference), extrapolation_name(second_tolerance_), second_tolerance_);
  }

  std::shared_ptr<const ProblemEntry> problem_;
  StateSizes seen_;                    // sizes of the motion
  std::unique_ptr<Simulation> first_;  // null if there is a closed form
  std::unique_ptr<Simulation> second_;
  std::int64_t pieces_ = 0;
  double first_tolerance_ = 0;
  double second_tolerance_ = 0;
  std::string first_name_;
  std::string arithmetic_;
  ReferenceSolution solution_;
};

ReferenceRun::ReferenceRun(const Request& request, const std::string& t_end, std::int64_t steps)
    : impl_(std::make_unique<Impl>(request, t_end, steps)) {}
ReferenceRun::~ReferenceRun() = default;
void ReferenceRun::advance(const std::function<bool()>& goes_on) { impl_->advance(goes_on); }
double ReferenceRun::part() const { return impl_->part(); }
const ReferenceSolution& ReferenceRun::solution() const { return impl_->solution(); }

}  // namespace hamflow
