#include "walled_problem.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <memory>
#include <tuple>

#include "engine/made_entries.hpp"
#include "hamflow/run/state_names.hpp"
#include "soft_energy.hpp"

namespace hamflow {

namespace {

using Choices = std::map<std::string, std::string>;

/// Whether a formula contains a symbol.
bool names(const std::string& formula, std::string symbol) {
  symbol = symbol.substr(0, symbol.find('['));
  std::string word;
  for (const char c : formula + " ") {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_') {
      word += c;
    } else {
      if (word == symbol) return true;
      word.clear();
    }
  }
  return false;
}

/// Whether a wall leaves an invariant: a bounce changes one momentum, on which the invariant must not depend. Among
/// declared invariants this holds for certain only for the momentum of the last coordinate, which is cyclic; for typed
/// invariants the formula decides.
bool wall_keeps_invariant(const ProblemEntry& problem, const InvariantInfo& invariant, const Walls::Interval& wall) {
  if (problem.structure) {
    const auto momentum =
        wall.index < problem.momenta.size() ? problem.momenta[wall.index] : momentum_name(wall.coordinate);
    return !names(invariant.meaning, momentum);
  }
  return invariant.terms == Terms::momentum && wall.index + 1 < problem.info.coordinates.size();
}

std::vector<bool> kept_of(const ProblemEntry& problem, const Walls& walls) {
  std::vector<bool> kept;
  for (const InvariantInfo& invariant : problem.info.invariants) {
    kept.push_back(std::all_of(walls.intervals.begin(), walls.intervals.end(), [&](const Walls::Interval& wall) {
      return wall_keeps_invariant(problem, invariant, wall);
    }));
  }
  return kept;
}

namespace {
/// Half of the edge of a box as a number; for walls from a scenario, the typed text.
std::string readable_wall(const std::string& text) {
  return text.starts_with("(") || text.starts_with("-(") ? shortest(number_value(text)) : text;
}
}  // namespace

StartRefusal beyond_walls(const ProblemEntry& problem, const Walls& walls, const Texts& parameters,
                          const std::vector<double>& q) {
  for (const Walls::Interval& wall : walls.intervals) {
    const double x = q.at(wall.index);
    const bool below = !wall.min.empty() && (walls.hard() ? x < number_value(wall.min) : x <= number_value(wall.min));
    const bool above = !wall.max.empty() && (walls.hard() ? x > number_value(wall.max) : x >= number_value(wall.max));
    if (!below && !above) continue;
    StartRefusal refusal{.key = wall_keys().walls.name};
    refusal.message = wall.coordinate + " = " + shortest(x) + (walls.hard() ? " beyond" : " on or beyond") +
                      " the wall at " + readable_wall(below ? wall.min : wall.max) +
                      "; allowed a start between the walls, " +
                      (wall.min.empty()   ? "at most " + readable_wall(wall.max)
                       : wall.max.empty() ? "at least " + readable_wall(wall.min)
                                          : "from " + readable_wall(wall.min) + " to " + readable_wall(wall.max));
    if (problem.particles) refusal.particles = {wall.index / problem.particles(parameters).space + 1};
    return refusal;
  }
  return {};
}

ProblemEntry entry_with_walls(const ProblemEntry& problem, const Walls& walls) {
  ProblemEntry e = problem;
  e.walls = walls;
  e.info.chart_key.clear();
  e.info.invariants.clear();
  const std::vector<bool> kept = kept_of(problem, walls);
  for (std::size_t k = 0; k < kept.size(); ++k) {
    if (kept[k]) e.info.invariants.push_back(problem.info.invariants[k]);
  }
  e.invariant_sizes = [inner = problem.invariant_sizes, kept](const Texts& parameters, std::size_t size) {
    std::vector<std::size_t> sizes;
    const std::vector<std::size_t> all = inner(parameters, size);
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (kept.at(k)) sizes.push_back(all[k]);
    }
    return sizes;
  };
  // Exact results for the motion without walls do not hold here.
  e.exact = nullptr;
  e.exact_radius = nullptr;
  e.describe_orbit = nullptr;
  e.to_reference = nullptr;
  e.from_reference = nullptr;
  // Kernels compiled for a problem do not support walls.
  e.simulate = [](const Request&) { return std::unique_ptr<Simulation>(); };
  e.refused_start = [problem, walls](const Texts& parameters, const std::vector<double>& q) {
    const StartRefusal beyond = beyond_walls(problem, walls, parameters, q);
    return beyond.message.empty() ? problem.refused_start(parameters, q) : beyond;
  };
  if (walls.hard()) return e;
  // boris and eg do not support another term of V.
  e.accepts = [inner = problem.accepts](const MethodSpec& method) {
    return method.name != "boris" && method.name != "eg" && inner(method);
  };
  e.energy = [inner = problem.energy, walls](const Texts& parameters, const std::vector<double>& q,
                                             const std::vector<double>& p) {
    return inner(parameters, q, p) + soft_energy<double>(walls, q);
  };
  return e;
}

}  // namespace

std::vector<bool> kept_invariants(const Request& request, const Walls& walls) {
  return kept_of(*find_problem(request.problem, request.variant), walls);
}

std::shared_ptr<const ProblemEntry> walled_problem(const std::string& name, const Choices& choices,
                                                   const Walls& walls) {
  static MadeEntries<std::tuple<std::string, Choices, Walls>> made;
  const std::shared_ptr<const ProblemEntry> problem = find_problem(name, choices);
  return made.find({name, choices, walls}, [&] { return entry_with_walls(*problem, walls); });
}

}  // namespace hamflow
