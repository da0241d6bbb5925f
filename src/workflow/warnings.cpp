#include "warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "element_columns.hpp"
#include "engine/planetary_steps.hpp"
#include "gas/container.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/run/section.hpp"
#include "hamflow/run/state_names.hpp"
#include "hamflow/run/walls.hpp"
#include "hamflow/verify/certificate.hpp"

namespace hamflow {

namespace {

constexpr double steps_per_period = 10;

std::string name_of(const Scenario& scenario, std::uint64_t coordinate) {
  return state_names(*scenario.problem, scenario.request.parameters, scenario.start_q.size()).q.at(coordinate);
}

/// Returns the period of a Cartesian coordinate on the orbit, or of the radius if that is longer; 0 if unknown.
double period_of_orbit(const OrbitSummary& orbit) {
  if (orbit.falls_into_centre) return 0;
  const double radial = orbit.radial_period;
  const double angle = orbit.apsidal_angle;
  const double round = angle > 0 ? radial * pi_value<double>() / angle : radial;
  return std::isfinite(round) && std::isfinite(radial) ? std::max(radial, round) : 0;
}

/// Returns the mean time between bounces off the wall that was hit most often. The fastest oscillation has at most this
/// period. It also counts several bounces within one step, which the states at the two ends of the step do not show.
/// @param length time of all steps, or more
std::optional<FastestOscillation> between_bounces(std::span<const WallCount> walls, double length) {
  std::optional<FastestOscillation> fastest;
  for (const WallCount& wall : walls) {
    if (wall.bounces < static_cast<std::int64_t>(TurningPointObserver::fewest_periods)) continue;
    const double period = length / static_cast<double>(wall.bounces);
    if (!fastest || period < fastest->period) fastest = {period, 0, wall.coordinate};
  }
  return fastest;
}

/// Returns whether H does not depend on the coordinates, judged from states between the start and the end. If so, every
/// step is exact, whatever its size, unless a wall rejects steps or is soft.
bool is_free_motion(const Scenario& scenario, const Frame& end) {
  const auto& walls = scenario.request.walls;
  if (walls && (walls->rule == WallRule::reject || walls->rule == WallRule::soft)) return false;
  const std::vector<double>& start = scenario.start_q;
  if (scenario.problem->structure && scenario.problem->structure->time) return false;
  if (!scenario.problem->energy || end.q.size() != start.size()) return false;
  const double at_start = scenario.problem->energy(scenario.request.parameters, start, scenario.start_p);
  for (const double part : {0.31, 0.5, 1.0, 1.73}) {
    std::vector<double> q = start;
    for (std::size_t i = 0; i < q.size(); ++i) q[i] += part * (end.q[i] - start[i]) + part * (1 + std::abs(start[i]));
    const double there = scenario.problem->energy(scenario.request.parameters, q, scenario.start_p);
    if (!(std::abs(there - at_start) <= 8 * std::numeric_limits<double>::epsilon() * std::abs(at_start))) return false;
  }
  return true;
}

void add_long_step(const Scenario& scenario, const WatchedMotion& motion, std::vector<Warning>& all) {
  // With steps of varying size, dt is only the first step. It is compared with the known period of the orbit. The
  // mean step is compared, too, because a density that is integrated with too long steps no longer follows its monitor.
  const bool varies = describe(scenario.request.method).varies_steps;
  const auto seen = varies ? std::nullopt : motion.turns->fastest();
  const double first = varies ? std::abs(scenario.dt) : motion.turns->longest_step();
  const double mean = varies ? motion.mean_step : 0;
  double dt = std::max(first, mean);
  double period = 0;
  std::string whose;
  if (seen) {
    const auto bounces = between_bounces(motion.walls, static_cast<double>(motion.steps) * dt);
    const bool at_wall = bounces && bounces->period < seen->period;
    dt = std::abs(seen->dt);
    period = at_wall ? bounces->period : seen->period;
    whose = fmt::format("shortest period seen, {:.3g} (of {})", period,
                        name_of(scenario, at_wall ? bounces->coordinate : seen->coordinate));
  } else if (motion.orbit != nullptr) {
    period = period_of_orbit(*motion.orbit);
    whose = fmt::format("period of the orbit, {:.3g}", period);
  }
  if (period == 0 || steps_per_period * dt <= period) return;
  const double enough = period / (2 * steps_per_period);
  if (mean > first) {
    all.push_back({"long_step", fmt::format("the mean step, {:.3g}, is more than a tenth of the {}; try dt = {:.2g} or "
                                            "less, to which all steps are proportional, or another monitor",
                                            mean, whose, scenario.dt * enough / mean)});
    return;
  }
  all.push_back({"long_step",
                 fmt::format("dt = {:g} is more than a tenth of the {}; try dt = {:.2g} or less", dt, whose, enough)});
}

/// The springs of tao2 and tao4 rotate the copies by 2 omega dt in a step, and the error grows as omega dt^order.
constexpr double most_spring_rotation = 0.25;

/// Returns omega dt, for a method that carries a second copy of the state.
double spring_rotation(const Scenario& scenario) {
  const MethodSpec& method = scenario.request.method;
  const std::vector<OptionInfo>& options = find_method(method.name).family->options;
  const auto springs =
      std::find_if(options.begin(), options.end(), [](const OptionInfo& o) { return o.position == 1; });
  const auto given = method.options.find(springs->name);
  return evaluate_number<double>(given == method.options.end() ? springs->default_value : given->second) *
         std::abs(scenario.dt);
}

void add_fast_springs(const Scenario& scenario, std::vector<Warning>& all) {
  if (!describe(scenario.request.method).carries_copy) return;
  const double turn = spring_rotation(scenario);
  if (!(turn > most_spring_rotation)) return;
  all.push_back({"long_step", fmt::format("omega dt = {:.3g} is above 1/4, so the springs between the two copies of "
                                          "the state are too fast for this step; try dt = {:.2g} or less",
                                          turn, scenario.dt * most_spring_rotation / turn)});
}

/// Warns if the two copies of the state in tao2 and tao4 have separated. The method conserves the energy of both copies
/// together, so a large energy error of (q, p) indicates that they have. The run is repeated in double until the copies
/// have separated.
/// @param size size of the energy
void add_separated_copies(const Scenario& scenario, const Excursion& energy, double size, std::int64_t steps,
                          std::vector<Warning>& all) {
  constexpr double least_error = 0x1p-8;  // relative energy error; it is smaller as long as the copies stay together
  constexpr double most = 0x1p-5;         // distance of the copies relative to the size of the state
  constexpr std::int64_t most_steps = std::int64_t{1} << 22U;
  constexpr std::int64_t looks = 1024;
  const ProblemEntry& problem = *scenario.problem;
  if (!describe(scenario.request.method).carries_copy || depends_on_time(problem)) return;
  if (!(energy.max_error > least_error * size)) return;
  Request request = scenario.request;
  request.parameters = complete(problem.info, request.parameters);
  const std::size_t n = scenario.start_q.size();
  const auto map = problem.step_map(request, n);
  if (!map) return;
  State<double> z;  // the state (q, x, p, y) with its copy (x, y)
  for (const auto* part : {&scenario.start_q, &scenario.start_q, &scenario.start_p, &scenario.start_p}) {
    z.insert(z.end(), part->begin(), part->end());
  }
  const auto frame = [&](std::size_t q, std::size_t p) {
    const auto part = [&](std::size_t k) {
      const auto begin = z.begin() + static_cast<std::ptrdiff_t>(k * n);
      return std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(n));
    };
    Frame found;
    found.q = part(q);
    found.p = part(p);
    return found;
  };
  const UnitGroups groups = unit_groups(problem, n);
  StateSizes sizes;
  sizes.include(scenario.start_q, scenario.start_p);
  const std::int64_t apart = std::max<std::int64_t>(1, steps / looks);
  for (std::int64_t step = apart; step <= std::min(steps, most_steps); step += apart) {
    if (!map->advance(z, scenario.dt, apart)) return;
    const Frame state = frame(0, 2);
    sizes.include(state.q, state.p);
    for (const GroupDistance& group : group_distances(groups, sizes, state, frame(1, 3))) {
      if (!(group.relative.value > most)) continue;
      const bool is_faster_possible = spring_rotation(scenario) < most_spring_rotation / 2;
      const std::string advice = is_faster_possible
                                     ? fmt::format("omega = {:.2g}", most_spring_rotation / std::abs(scenario.dt))
                                     : std::string("a smaller dt and a larger omega, with omega dt below 1/4");
      all.push_back(
          {"parted_copies",
           fmt::format("the two copies of the state are separated by {:.2g} of the size of {} at t = {:.4g}; later "
                       "results of {} are meaningless; try {}",
                       group.relative.value, group.name, static_cast<double>(step) * scenario.dt, request.problem,
                       advice)});
      return;
    }
  }
}

/// Warns if bounces, section points or events are located within steps of half a period or more. A method without
/// sub-steps locates them with its own partial steps, which are then not reliable.
void add_long_search(const Scenario& scenario, const Simulation& simulation, std::vector<Warning>& all) {
  const bool seeks = has_hard_walls(scenario.request) || scenario.section || !scenario.events.empty();
  const auto& walls = scenario.request.walls;
  const bool sees_ends_alone = walls && walls->rule == WallRule::reject;  // walls are only checked at ends of steps
  if (!seeks || simulation.step() == 0 || (simulation.method().own_substeps && !sees_ends_alone)) return;
  if (std::any_of(all.begin(), all.end(), [](const Warning& each) { return each.kind == "long_step"; })) return;
  SectionSearch search({}, [](const SectionPoint&) {});
  search.measure(simulation);
  if (!search.is_long()) return;
  all.push_back(
      {"long_step", fmt::format("dt = {:g} is half a period of the motion or more, so bounces, section points "
                                "and events may be missing or spurious; try a smaller dt",
                                scenario.dt)});
}

/// Warns if two bodies came so close that the motion is no longer nearly a Kepler motion of each body.
void add_close_encounter(const Scenario& scenario, const Simulation& simulation, std::vector<Warning>& all) {
  const auto* const planets = dynamic_cast<const PlanetarySteps*>(&simulation);
  const auto met = planets != nullptr ? planets->first_encounter() : std::nullopt;
  if (!met) return;
  all.push_back({"close_encounter",
                 fmt::format("{} and {} came within 3 Hill radii of each other at t = {:.6g}, where {} is inaccurate; "
                             "try dop853, which adapts its steps, or a smaller dt",
                             body_name(scenario, met->bodies.first), body_name(scenario, met->bodies.second), met->time,
                             simulation.method().name)});
}

/// Warns about invariants that are not finite at the start or at the end, so that their errors are unknown.
void add_no_numbers(const Summary& summary, std::vector<Warning>& all) {
  if (summary.status == "failed") return;  // the failure explains it
  std::vector<std::string> names;
  for (const InvariantSummary& each : summary.invariants) {
    if (!each.max_error()) names.push_back(each.name);
  }
  if (names.empty()) return;
  all.push_back({"no_number", joined(names) + (names.size() == 1 ? " was" : " were") +
                                  " not finite at the start or at the end, so the error is unknown"});
}

double mass_of(const ParticleFacts& particles, std::size_t i) {
  return i < particles.masses.size() ? particles.masses[i] : particles.masses.front();
}

double fastest(const ParticleFacts& particles, const std::vector<double>& p) {
  const std::size_t space = particles.space;
  double most = 0;
  for (std::size_t i = 0; i < p.size() / space; ++i) {
    double square = 0;
    for (std::size_t c = i * space; c < (i + 1) * space; ++c) square += p[c] * p[c];
    most = std::max(most, std::sqrt(square) / mass_of(particles, i));
  }
  return most;
}

/// The two nearest particles, including periodic images in a periodic box.
struct Nearest {
  double distance = std::numeric_limits<double>::infinity();
  std::size_t one = 0, other = 0;
};
/// Returns nullopt for more than 3000 particles, because it would take too long.
std::optional<Nearest> nearest(const ProblemEntry& problem, const ParticleFacts& particles,
                               const std::vector<double>& q) {
  const std::size_t space = particles.space;
  constexpr std::size_t most_particles = 3000;
  const std::size_t count = q.size() / space;
  if (count > most_particles) return {};
  std::vector<double> edges(space, 0.0);
  if (problem.container == ContainerNames::periodic) edges = particles.edges;
  Nearest found;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 1; j < count; ++j) {
      double square = 0;
      for (std::size_t k = 0; k < space; ++k) {
        double d = q[i * space + k] - q[j * space + k];
        if (edges[k] > 0) d -= std::nearbyint(d / edges[k]) * edges[k];
        square += d * d;
      }
      if (square < found.distance) found = {square, i, j};
    }
  }
  found.distance = std::sqrt(found.distance);
  return found;
}

/// Returns whether two particles repel each other so strongly that they cannot pass: on the way to each other the
/// energy changes by more than their kinetic energy. Through a smooth core they may pass.
bool cannot_pass(const Request& request, const ProblemEntry& problem, const ParticleFacts& particles,
                 const std::vector<double>& q, const std::vector<double>& p, const Nearest& two) {
  const std::size_t space = particles.space;
  const auto mass = [&](std::size_t i) { return mass_of(particles, i); };
  std::vector<double> near = q;
  double kinetic = 0;
  for (std::size_t k = 0; k < space; ++k) {
    const std::size_t i = two.one * space + k, j = two.other * space + k;
    near[j] = q[i] + (q[j] - q[i]) / 1024;
    kinetic += p[i] * p[i] / (2 * mass(two.one)) + p[j] * p[j] / (2 * mass(two.other));
  }
  const auto energy = [&](const std::vector<double>& at) { return problem.energy(request.parameters, at, p); };
  return !(std::abs(energy(near) - energy(q)) <= kinetic);
}

}  // namespace

/// Two particles that pass through each other within one step hardly change the energy, so the other checks miss them.
/// A Lennard-Jones pair has a known distance of repulsion; for other laws the smallest distance of a pair is used.
std::string passing_in_a_step(const Request& request, const ProblemEntry& problem, double dt, const Frame& start,
                              const Frame& end) {
  if (!problem.particles || !takes_equal_steps(describe(request.method))) return {};
  const ParticleFacts particles = problem.particles(request.parameters);
  const double speed = std::max(fastest(particles, start.p), fastest(particles, end.p));
  const double move = speed * std::abs(dt);
  if (const double core = particles.repulsion; core != 0) {
    if (!(4 * move > core)) return {};
    return fmt::format(
        "a particle moves {:.3g} in a step, more than a quarter of the repulsion distance {:.3g}, so two particles may "
        "pass through each other; try dt = {:.2g} or less",
        move, core, core / (20 * speed));
  }
  for (const Frame* at : {&start, &end}) {
    const auto two = nearest(problem, particles, at->q);
    if (!two || !(two->distance > 0 && move > two->distance / 2)) continue;
    if (!cannot_pass(request, problem, particles, at->q, at->p, *two)) continue;
    return fmt::format(
        "a particle moves {:.3g} in a step, and the smallest distance of two is {:.3g}, so they may pass through each "
        "other; try dt = {:.2g} or less",
        move, two->distance, two->distance / (20 * speed));
  }
  return {};
}

namespace {

/// Returns a text about two particles of a gas that start so close together that no dt helps; empty if there are none.
std::string overlap_at_start(const Scenario& scenario) {
  const ProblemEntry& problem = *scenario.problem;
  if (!problem.particles) return {};
  const ParticleFacts particles = problem.particles(scenario.request.parameters);
  const double core = particles.repulsion;
  if (core == 0) return {};
  const auto two = nearest(problem, particles, scenario.start_q);
  if (!two || !(two->distance < core / 2)) return {};
  return fmt::format(
      "; particles {} and {} start {:.3g} apart, but a pair repels within {:.3g}, so a smaller dt does not help; start "
      "them farther apart, in a larger container, or with another scale",
      two->one + 1, two->other + 1, two->distance, core);
}

void add_passing_particles(const Scenario& scenario, const Frame& end, std::vector<Warning>& all) {
  Frame start;
  start.q = scenario.start_q;
  start.p = scenario.start_p;
  const std::string passing = passing_in_a_step(scenario.request, *scenario.problem, scenario.dt, start, end);
  if (!passing.empty()) all.push_back({"long_step", passing});
}

/// Returns the product q.p of a state in Cartesian coordinates, whose sign is the sign of the radial velocity.
double radial(const ProblemEntry& problem, const Texts& parameters, const std::vector<double>& q,
              const std::vector<double>& p) {
  Frame at;
  at.q = q;
  at.p = p;
  if (problem.to_reference) at = problem.to_reference(parameters, q, p);
  double sum = 0;
  for (std::size_t i = 0; i < at.q.size(); ++i) sum += at.q[i] * at.p[i];
  return sum;
}

/// Warns if the run ends far from the known orbit of its start. The energy scale of a narrow ellipse is large at the
/// pericentre, so an energy error below the scale can turn the orbit into a hyperbola.
void add_left_orbit(const Scenario& scenario, const WatchedMotion& motion, std::vector<Warning>& all) {
  constexpr double most = 2;  // a distance beyond the orbit by this factor is a wrong motion
  if (motion.orbit == nullptr || motion.orbit->falls_into_centre) return;
  const double smallest = motion.orbit->r_min.value;
  const double largest = motion.orbit->r_max.value;
  Frame at = motion.end;
  if (scenario.problem->to_reference) at = scenario.problem->to_reference(scenario.request.parameters, at.q, at.p);
  double square = 0;
  for (const double x : at.q) square += x * x;
  const double r = std::sqrt(square);
  if (!(r > most * largest) && !(most * r < smallest)) return;
  all.push_back({"left_orbit", fmt::format("the distance from the centre is {:.3g} at the end, but the orbit of this "
                                           "start stays between {:.3g} and {:.3g}, so this result is meaningless; try "
                                           "a smaller dt",
                                           r, smallest, largest)});
}

/// Returns whether an orbit that falls into the centre has reached it by time t. From apocentre to centre it takes half
/// a radial period; a closed form may continue beyond the centre, outwards.
bool has_fallen(const Scenario& scenario, double period, double t) {
  const ProblemEntry& problem = *scenario.problem;
  if (!problem.exact) return std::abs(t) >= period;  // an orbit that first moves outwards needs up to a period
  const auto exact = [&](double time) {
    return problem.exact(scenario.request.parameters, scenario.start_q, scenario.start_p, time);
  };
  const auto end = exact(t);
  if (!end) return exact(0).has_value();  // unknown if there is no closed form at the start either
  const double sense = t < 0 ? -1 : 1;
  const bool goes_out = sense * radial(problem, scenario.request.parameters, scenario.start_q, scenario.start_p) > 0;
  const double least = goes_out ? period / 2 : 0;  // the centre is not reached earlier
  const double most = goes_out ? period : period / 2;
  return std::abs(t) >= most ||
         (std::abs(t) > least && sense * radial(problem, scenario.request.parameters, end->q, end->p) > 0);
}

}  // namespace

bool is_energy_meaningless(const Scenario& scenario, const Excursion& energy, const Frame& end,
                           std::optional<double> typically_exchanged) {
  if (scenario.map) return false;
  const double scale = energy.scale_at_start;
  // For a motion at rest the exchanged energy is only rounding.
  const double exchanged = typically_exchanged.value_or(energy.exchanged);
  if (exchanged > 0 && std::isfinite(exchanged)) return energy.max_error > std::max(exchanged, 0x1p-40 * scale);
  if (!(energy.max_error > scale)) return false;
  // If a pendulum starts horizontally, T and V at the start are only rounding errors. Then the virial at the start
  // gives the scale, and an error that is small compared with the kinetic part of the virial at the end is acceptable.
  // The other part of that virial is useless for a wrong motion: for an angle of a million turns it is a million times
  // the energy.
  const auto of = [&](const std::vector<double>& q, const std::vector<double>& p) {
    return virial(*scenario.problem, scenario.request.parameters, q, p);
  };
  const VirialTerms start = of(scenario.start_q, scenario.start_p);
  return !(energy.max_error <= (start.of_q + start.of_p) / 4 || energy.max_error <= 0.01 * of(end.q, end.p).of_p);
}

std::vector<Warning> warnings_of(const Scenario& scenario, const Summary& summary, const Simulation& simulation,
                                 const TurningPointObserver* turns, std::optional<double> exchanged) {
  WatchedMotion motion{.energy = simulation.energy(),
                       .end = {},
                       .orbit = summary.orbit ? &*summary.orbit : nullptr,
                       .turns = turns,
                       .walls = simulation.wall_counts(),
                       .exchanged = exchanged};
  simulation.look(motion.end);
  motion.steps = motion.end.step;
  if (motion.steps > 0 && motion.end.digits.q.empty()) {
    motion.mean_step = std::abs(motion.end.time) / static_cast<double>(motion.steps);
  }
  std::vector<Warning> all = warnings_of(scenario, motion);
  if (!scenario.map && !is_free_motion(scenario, motion.end)) add_long_search(scenario, simulation, all);
  add_close_encounter(scenario, simulation, all);
  add_no_numbers(summary, all);
  return all;
}

std::vector<Warning> warnings_of(const Scenario& scenario, const WatchedMotion& motion) {
  std::vector<Warning> all;
  if (scenario.map) return all;  // the warnings compare steps with the flow of H, and a map has no flow
  const Excursion& energy = motion.energy;
  const Frame& end = motion.end;
  const double scale = energy.scale_at_start;
  if (is_energy_meaningless(scenario, energy, end, motion.exchanged)) {
    all.push_back(
        {"energy_error", fmt::format("the energy error, {:.3g}, {}, so this result of {} is meaningless; try a smaller "
                                     "dt{}",
                                     energy.max_error,
                                     scale > 0 && !(energy.max_error > scale)
                                         ? fmt::format("exceeds the energy that the motion exchanges between T and V, "
                                                       "{:.3g}",
                                                       motion.exchanged.value_or(energy.exchanged))
                                     : scale > 0 ? fmt::format("exceeds the energy scale of the start, {:.3g}", scale)
                                                 : std::string("has no scale, since the energy is 0 at the start"),
                                     scenario.request.problem,
                                     describe(scenario.request.method).carries_copy ? ", a larger omega" : "") +
                             overlap_at_start(scenario)});
  }
  if (end.step > 0) {
    const auto& exchanged = motion.exchanged;
    const double size = exchanged && *exchanged > 0 ? std::min(*exchanged, scale > 0 ? scale : *exchanged) : scale;
    add_separated_copies(scenario, energy, size, end.step, all);
  }
  if (motion.turns != nullptr && !is_free_motion(scenario, end)) add_long_step(scenario, motion, all);
  if (end.step > 0) add_fast_springs(scenario, all);
  if (all.empty() && end.step > 0) add_passing_particles(scenario, end, all);
  if (all.empty() && end.step > 0) add_left_orbit(scenario, motion, all);
  if (motion.orbit != nullptr && motion.orbit->falls_into_centre &&
      has_fallen(scenario, motion.orbit->radial_period, end.time)) {
    // The apsidal angle is 0 only on a line. If the orbit falls although it has angular momentum, a little more of it
    // does not help.
    const bool on_line = motion.orbit->apsidal_angle.value == 0;
    all.push_back({"falls_into_centre",
                   std::string("the orbit reaches the centre, where H is infinite, before the run ends; later results "
                               "are meaningless; stop earlier, or give the start ") +
                       (on_line ? "some angular momentum" : "enough angular momentum to miss the centre")});
  }
  return all;
}

std::vector<std::string> warning_lines(const std::vector<Warning>& warnings) {
  std::vector<std::string> lines;
  for (const Warning& each : warnings) lines.push_back(each.kind + ": " + each.message);
  return lines;
}

}  // namespace hamflow
