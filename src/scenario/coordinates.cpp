#include "hamflow/scenario/coordinates.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "hamflow/core/error.hpp"
#include "hamflow/core/number.hpp"
#include "hamflow/run/walls.hpp"

namespace hamflow {

namespace {

/// Returns the problems with several charts, with one entry for each chart.
const std::map<std::string, std::vector<const ProblemEntry*>>& charted_problems() {
  static const std::map<std::string, std::vector<const ProblemEntry*>> all = [] {
    std::map<std::string, std::vector<const ProblemEntry*>> found;
    for (const ProblemEntry& entry : problems()) {
      if (entry.info.chart_key.empty()) continue;
      auto& charts = found[entry.info.name];
      const bool is_new = std::none_of(charts.begin(), charts.end(), [&](const ProblemEntry* other) {
        return coordinates_of(*other) == coordinates_of(entry);
      });
      if (is_new) charts.push_back(&entry);
    }
    return found;
  }();
  return all;
}

const ProblemEntry* with_coordinates(const std::vector<const ProblemEntry*>& charts, const std::string& name) {
  const auto found = std::find_if(charts.begin(), charts.end(),
                                  [&](const ProblemEntry* entry) { return coordinates_of(*entry) == name; });
  return found == charts.end() ? nullptr : *found;
}

/// Returns a pointer without ownership to an entry that is never destroyed, such as those of problems().
std::shared_ptr<const ProblemEntry> unowned(const ProblemEntry& entry) { return {std::shared_ptr<void>(), &entry}; }

/// Returns the entries of a problem that has both charts, preferably with `size` coordinates. @throws Error
std::pair<std::shared_ptr<const ProblemEntry>, std::shared_ptr<const ProblemEntry>> charts_named(
    const std::string& from, const std::string& to, std::size_t size) {
  check_coordinates(from);
  check_coordinates(to);
  std::pair<const ProblemEntry*, const ProblemEntry*> found{};
  for (const auto& [name, charts] : charted_problems()) {
    const ProblemEntry* const first = with_coordinates(charts, from);
    const ProblemEntry* const second = with_coordinates(charts, to);
    if (first == nullptr || second == nullptr) continue;
    if (found.first == nullptr || (first->dimension == size && found.first->dimension != size)) found = {first, second};
  }
  if (found.first != nullptr) return {unowned(*found.first), unowned(*found.second)};
  throw Error("cannot convert from " + from + " to " + to + "; allowed: " + what_charts_there_are());
}

}  // namespace

std::shared_ptr<const ProblemEntry> without_own_walls(const std::shared_ptr<const ProblemEntry>& problem) {
  if (problem->info.walls.empty() || !problem->walls) return problem;
  return find_problem(problem->info.name, {problem->info.variant.begin(), problem->info.variant.end()});
}

std::string coordinates_of(const ProblemEntry& behind) {
  const auto inside = without_own_walls(unowned(behind));
  return choice_of(inside->info, inside->info.chart_key);
}

std::string what_charts_there_are() {
  std::string text;
  for (const auto& [name, charts] : charted_problems()) {
    text += (text.empty() ? "" : "; ") + name + " has ";
    for (std::size_t i = 0; i < charts.size(); ++i) {
      text += (i == 0 ? "" : i + 1 < charts.size() ? ", " : " and ") + coordinates_of(*charts[i]);
    }
  }
  return text;
}

void check_coordinates(const std::string& name) {
  std::vector<std::string> all;
  for (const auto& [problem, charts] : charted_problems()) {
    for (const ProblemEntry* entry : charts) {
      const std::string system = coordinates_of(*entry);
      if (std::find(all.begin(), all.end(), system) == all.end()) all.push_back(system);
    }
  }
  if (std::find(all.begin(), all.end(), name) != all.end()) return;
  throw Error("found coordinates '" + name + "'; allowed " + joined(all) + suggestion(name, all));
}

std::shared_ptr<const ProblemEntry> in_coordinates(const std::shared_ptr<const ProblemEntry>& given,
                                                   const std::string& to) {
  check_coordinates(to);
  const std::shared_ptr<const ProblemEntry> inside = without_own_walls(given);
  const ProblemEntry& problem = *inside;
  if (problem.walls) {
    throw Error("found " + problem.info.name +
                " with walls; allowed without walls, because a wall on a coordinate of one chart is not a wall on a "
                "coordinate of another");
  }
  const auto charts = charted_problems().find(problem.info.name);
  const bool has_charts = charts != charted_problems().end() && !problem.info.chart_key.empty();
  if (!has_charts || with_coordinates(charts->second, to) == nullptr) {
    const std::string allowed =
        problem.structure ? "those that were typed, " + joined(problem.info.coordinates) : what_charts_there_are();
    // a variant with a single chart, in space
    if (charts != charted_problems().end() && problem.info.chart_key.empty()) {
      const auto text_of = [](const auto& choice) { return choice.first + " = " + choice.second; };
      throw Error("found " + problem.info.name + " with " + joined(problem.info.variant, text_of) +
                  ", which has only the coordinates " + joined(problem.info.coordinates) + "; allowed: " + allowed);
    }
    if (charts == charted_problems().end() && !problem.structure) {
      throw Error(problem.info.name +
                  " has only one set of coordinates, so it cannot be converted; allowed: " + allowed);
    }
    if (!has_charts) throw Error(problem.info.name + " has no " + to + " coordinates; allowed: " + allowed);
    std::vector<std::string> meant;
    for (const ProblemEntry* chart : charts->second) {
      if (choice_of(chart->info, "coordinates") == to) meant.push_back(coordinates_of(*chart));
    }
    if (meant.empty()) throw Error(problem.info.name + " has no " + to + " coordinates; allowed: " + allowed);
    throw Error("found " + to + " coordinates, of which " + problem.info.name + " has several; allowed " +
                joined(meant));
  }
  // Two charts may have different choices, so only the choices that both have are compared.
  for (const ProblemEntry& entry : problems()) {
    if (entry.info.name != problem.info.name || coordinates_of(entry) != to) continue;
    const bool same = std::all_of(entry.info.variant.begin(), entry.info.variant.end(), [&](const auto& choice) {
      const std::string other = choice_of(problem.info, choice.first);
      const bool is_chart = choice.first == entry.info.chart_key || choice.first == problem.info.chart_key;
      return is_chart || other.empty() || other == choice.second;
    });
    if (same) return unowned(entry);
  }
  std::map<std::string, std::string> variant(problem.info.variant.begin(), problem.info.variant.end());
  variant[problem.info.chart_key] = to;
  return find_problem(problem.info.name, variant);  // a problem with a typed potential
}

StateConverter::StateConverter(const std::shared_ptr<const ProblemEntry>& given,
                               const std::shared_ptr<const ProblemEntry>& target, const Texts& parameters)
    : from_(without_own_walls(given)), to_(target), parameters_(complete(target->info, parameters)) {
  const ProblemEntry& from = *given;
  const ProblemEntry& to = *target;
  if (!from.info.angles.empty()) return;
  for (std::size_t i = 0; i < to.info.coordinates.size(); ++i) {
    const auto& angles = to.info.angles;
    if (std::find(angles.begin(), angles.end(), to.info.coordinates[i]) != angles.end()) turning_.push_back(i);
  }
}
StateConverter::StateConverter(const std::string& from, const std::string& to, std::size_t size)
    : StateConverter(charts_named(from, to, size)) {}

void StateConverter::require_on_constraints(const CanonicalState& state) const {
  if (!from_->residuals || state.q.size() != from_->dimension || state.p.size() != from_->dimension) return;
  const auto [position, velocity] = from_->residuals(complete(from_->info, parameters_), state.q, state.p);
  const std::string allowed = "; allowed at most " + shortest(most_residual_at_start);
  if (!(position <= most_residual_at_start))
    throw Error("found a state that violates the constraints, |g(q)| = " + shortest(position) + allowed);
  if (!(velocity <= most_residual_at_start))
    throw Error("found a state whose velocity leaves the constraints, |g'(q) M^-1 p| = " + shortest(velocity) +
                allowed);
}

CanonicalState StateConverter::operator()(const CanonicalState& state) {
  const std::size_t size = from_->dimension > 0 ? from_->dimension : state.q.size();
  if (state.q.size() != size || state.p.size() != size) {
    throw Error("found " + std::to_string(state.q.size()) + " coordinates and " + std::to_string(state.p.size()) +
                " momenta; allowed " + std::to_string(size) + " of each");
  }
  const auto is_finite = [](const std::vector<double>& x) {
    return std::all_of(x.begin(), x.end(), [](double number) { return std::isfinite(number); });
  };
  if (!is_finite(state.q) || !is_finite(state.p))
    throw Error("found a state that is not finite; allowed finite numbers");
  if (coordinates_of(*from_) == coordinates_of(*to_)) return state;
  Frame now;
  now.q = state.q;
  now.p = state.p;
  if (from_->to_reference) now = from_->to_reference(parameters_, now.q, now.p);
  if (to_->from_reference) now = to_->from_reference(parameters_, now.q, now.p);
  if (!is_finite(now.q) || !is_finite(now.p)) {
    throw Error("found a state whose " + coordinates_of(*to_) +
                " coordinates are not finite in double; allowed numbers whose squares and products are finite");
  }
  const double turn = 2 * pi_value<double>();
  for (const std::size_t i : turning_) {
    if (last_.empty()) break;
    now.q[i] += turn * std::round((last_[i] - now.q[i]) / turn);
    largest_turn_ = std::max(largest_turn_, std::abs(now.q[i] - last_[i]));
  }
  last_ = now.q;
  return {now.q, now.p};
}

}  // namespace hamflow
