#include "hamflow/verify/certificate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "energy_size.hpp"
#include "engine/make_simulation.hpp"
#include "hamflow/core/counter_random.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/run/walls.hpp"
#include "rounding.hpp"

namespace hamflow {

namespace {
constexpr std::size_t most_watched = 5000;  // coordinates whose turns are counted; each takes 270 bytes
constexpr std::uint64_t seed = 1686;        // arbitrary but fixed, because the places of the samples affect the result

/// Returns a place in the first half of the k-th block. After two blocks are joined, it is still in the first half.
std::int64_t place(std::int64_t k, std::int64_t block_steps) {
  const std::int64_t room = std::max<std::int64_t>(1, block_steps / 2);
  if (k == 0) return 0;
  const auto random = counter_bits(seed, static_cast<std::uint64_t>(k));
  return k * block_steps + static_cast<std::int64_t>(random % static_cast<std::uint64_t>(room));
}

/// Keeps every second element, starting with the first.
template <class T>
void thin(std::vector<T>& all) {
  for (std::size_t i = 1; 2 * i < all.size(); ++i) all[i] = std::move(all[2 * i]);
  all.resize((all.size() + 1) / 2);
}

double largest(const std::vector<double>& xs) {
  double most = 0;
  for (const double x : xs) most = std::max(most, std::abs(x));
  return most;
}
double norm(const std::vector<double>& xs) {
  double squares = 0;
  for (const double x : xs) squares += x * x;
  return std::sqrt(squares);
}
double sum_of_sizes(const std::vector<double>& xs) {
  double sum = 0;
  for (const double x : xs) sum += std::abs(x);
  return sum;
}
}  // namespace

LongNumber largest_error(const InvariantExcursion& seen) {
  const bool is_too_small = seen.max_error < std::numeric_limits<double>::min() && !seen.max_error_digits.empty();
  return is_too_small ? times(1, seen.max_error_digits) : LongNumber(seen.max_error);
}

std::int64_t EnergyBlocks::next_due(std::int64_t step) const { return std::max(step, state_.next); }

void EnergyExchange::look(double kinetic, double potential) {
  if (!std::isfinite(kinetic) || !std::isfinite(potential)) return;
  if (samples == 0) {
    first_kinetic = std::abs(kinetic);
    first_potential = potential;
  }
  const double change = std::abs(potential - first_potential);
  sum_of_kinetic += std::abs(kinetic);
  sum_of_change += change;
  ++samples;
}
std::optional<double> EnergyExchange::typical() const {
  if (samples == 0) return std::nullopt;
  return std::max(first_kinetic, std::min(sum_of_kinetic, sum_of_change) / static_cast<double>(samples));
}

EnergyBlocks::Energy energy_for_blocks(const Request& request, const ProblemEntry& problem, std::size_t coordinates) {
  constexpr std::size_t most_coordinates = 200;
  if (coordinates > most_coordinates || depends_on_time(problem) || !problem.energy) return {};
  return [&problem, all = complete(problem.info, request.parameters)](
             const std::vector<double>& q, const std::vector<double>& p) { return problem.energy(all, q, p); };
}

Verdict EnergyBlocks::observe(const Frame& frame) {
  if (frame.step < state_.next) return Verdict::go_on;
  if (energy_) {
    const double potential = energy_(frame.q, std::vector<double>(frame.p.size(), 0.0));
    state_.exchange.look(energy_(frame.q, frame.p) - potential, potential);
  }
  auto& energies = state_.energies;
  energies.push_back(frame.energy);
  if (!frame.digits.energy.empty()) state_.digits.push_back(frame.digits.energy);
  const std::size_t n = frame.q.size();
  const std::size_t watched = std::min(n, most_watched);
  state_.swings.resize(2 * watched);
  for (std::size_t k = 0; k < watched; ++k) {
    const std::size_t i = k * n / watched;
    state_.swings[k].look(frame.step, frame.q[i]);
    state_.swings[watched + k].look(frame.step, frame.p[i]);
  }
  const double p_sum = sum_of_sizes(frame.p);
  const double p_most = largest(frame.p);
  const double sizes[] = {largest(frame.q), p_most, p_sum, sum_of_sizes(frame.q) * p_most, norm(frame.q) * p_most};
  state_.magnitudes.resize(std::size(sizes));  // older checkpoints have only four
  for (std::size_t i = 0; i < std::size(sizes); ++i) state_.magnitudes[i] = std::max(state_.magnitudes[i], sizes[i]);
  if (energies.size() > most_blocks) {
    thin(energies);
    thin(state_.digits);
    state_.block_steps *= 2;
  }
  state_.next = place(static_cast<std::int64_t>(energies.size()), state_.block_steps);
  return Verdict::go_on;
}

namespace {
/// Returns for each invariant I (its largest component) the sum of |x dI/dx| over all coordinates and momenta x, at the
/// start or the end of a run, whichever is larger. A rounding of each x by one unit changes I by as many units. The
/// result is empty for systems with many coordinates.
std::vector<double> sizes_of_invariants(const Request& request, const Frame& end) {
  constexpr std::size_t most_coordinates = 64;
  constexpr double part = 0x1p-20;
  if (end.q.empty() || end.q.size() > most_coordinates) return {};
  Request other = request;
  other.arithmetic = "double";
  other.record = false;
  other.threads = 1;
  const auto invariants_at = [&](const std::vector<double>& q, const std::vector<double>& p) {
    other.start = {};
    for (const double x : q) other.start.q.push_back(shortest(x));
    for (const double x : p) other.start.p.push_back(shortest(x));
    return make_simulation(other)->invariants();
  };
  Frame start;
  make_simulation(request)->look(start);
  std::vector<double> sizes;
  try {
    for (const Frame* const at : {static_cast<const Frame*>(&start), &end}) {
      std::vector<double> here;
      for (std::size_t k = 0; k < 2 * at->q.size(); ++k) {
        std::vector<double> q = at->q, p = at->p;
        double& x = k < q.size() ? q[k] : p[k - q.size()];
        const double kept = x;
        x = kept * (1 + part);
        const auto above = invariants_at(q, p);
        x = kept * (1 - part);
        const auto below = invariants_at(q, p);
        here.resize(above.size());
        for (std::size_t i = 0; i < above.size(); ++i) {
          double most = 0;
          for (std::size_t c = 0; c < above[i].initial.size(); ++c) {
            most = std::max(most, std::abs(above[i].initial[c] - below[i].initial[c]) / (2 * part));
          }
          here[i] += most;
        }
      }
      sizes.resize(here.size());
      for (std::size_t i = 0; i < here.size(); ++i) sizes[i] = std::max(sizes[i], here[i]);
    }
  } catch (const Error&) {  // a displaced state is not allowed, so the sizes are unknown
    return {};
  }
  return sizes;
}
}  // namespace

/// Each kick and each drift rounds a position or a momentum once, by at most half a unit. This changes an invariant
/// with terms of size T by about epsilon T. n roundings make a random walk of sqrt(n) such changes, and evaluating the
/// invariant adds a few roundings. The bound is 16 of each: the maximum of a walk over the whole run is rarely above
/// four standard deviations, and in every operation two coordinates of a body, or two bodies, are rounded. The centre
/// of mass also integrates the walk of the momentum over the time of the run.
///
/// Angular momentum sums the roundings of all bodies, which are independent: a kick changes it by |q| |dp| with norms
/// instead of sums. For 121 particles the sum of sizes is 13 times larger and could hide a drift of the method. So
/// `conserved` means below four standard deviations of this walk: a rounding is at most half a unit, its standard
/// deviation is 0.29 units, and four of them for q and p together are 1.6 sqrt(n); 2 times two units are used.
/// Evaluating the invariant adds as many terms as there are coordinates, each at most of its own size. Between this
/// bound and the sum of sizes the cause is undecided, rounding or method, because stages and iterations round more than
/// once.
///
/// The cause is also undecided if n roundings of one unit to the same side could explain the error. Such roundings
/// occur: a free body moves by the same number in every step, and is rounded to the same side until its exponent
/// changes.
std::vector<MomentumMap> momentum_maps(const Simulation& simulation, const ProblemEntry& problem,
                                       const std::vector<double>& magnitudes, const Request& request) {
  std::vector<MomentumMap> all;
  const std::vector<InvariantExcursion> invariants = simulation.invariants();
  const Effort effort = simulation.effort();
  const double roundings =
      std::max(static_cast<double>(effort.force + effort.gradient), static_cast<double>(simulation.step()));
  const double walk = 16 * (1 + std::sqrt(roundings));
  const double to_one_side = std::max(1.0, roundings / walk);
  const int digits = digits_beyond_double(request.arithmetic);
  // Bounds are computed in units of rounding, because the rounding itself may be below the range of double.
  const double unit = digits > 0 ? 1 : epsilon;
  const auto in_arithmetic = [&](double units) {
    return digits > 0 ? times_power_of_ten(units, 1 - digits) : LongNumber(units);
  };
  const bool lattice = request.arithmetic == "lattice";
  const double q_unit = std::max(unit, lattice ? request.position_unit / std::max(magnitudes[0], 1e-300) : 0);
  const double p_unit = std::max(unit, lattice ? request.momentum_unit / std::max(magnitudes[1], 1e-300) : 0);
  const std::vector<InvariantInfo>& infos = problem.info.invariants;
  Frame end;
  simulation.look(end);
  const bool any_typed =
      std::any_of(infos.begin(), infos.end(), [](const InvariantInfo& info) { return info.terms == Terms::other; });
  const std::vector<double> sizes =
      any_typed && end.step > 0 ? sizes_of_invariants(request, end) : std::vector<double>{};
  for (std::size_t i = 0; i < invariants.size() && i < infos.size(); ++i) {
    MomentumMap map{infos[i].name, largest_error(invariants[i]), 0, {}};
    double size = largest(invariants[i].initial);
    switch (infos[i].terms) {
      case Terms::moments: {
        const double reading = 4 * std::sqrt(static_cast<double>(end.q.size())) * unit * size;
        size = std::max(size, magnitudes[3]);
        const double most = walk * (q_unit + p_unit) * size;
        map.rounding = in_arithmetic(std::min(most, walk / 8 * (q_unit + p_unit) * magnitudes[4] + reading));
        map.doubtful = in_arithmetic(to_one_side * most);
        break;
      }
      case Terms::momentum:
        map.rounding = in_arithmetic(walk * p_unit * size);
        map.doubtful = in_arithmetic(to_one_side * walk * p_unit * size);
        break;
      case Terms::momenta:
        size = std::max(size, magnitudes[2]);
        map.rounding = in_arithmetic(walk * p_unit * size);
        map.doubtful = in_arithmetic(to_one_side * walk * p_unit * size);
        break;
      case Terms::centre_of_mass: {
        if (!problem.total_mass) break;
        const double mass = problem.total_mass(complete(problem.info, request.parameters), end.q.size());
        size = std::max(size, magnitudes[0]);
        // Evaluating the centre of mass sums as many terms as there are bodies, and each addition rounds a sum of full
        // size.
        const double reading = 4 * std::sqrt(static_cast<double>(end.q.size()));
        const double most =
            (walk + reading) * q_unit * size + walk * p_unit * magnitudes[2] / mass * std::abs(end.time);
        map.rounding = in_arithmetic(most);
        map.doubtful = in_arithmetic(to_one_side * most);
        break;
      }
      case Terms::other: {
        if (sizes.size() <= i || !(sizes[i] > 0)) break;
        size = std::max(size, sizes[i]);
        map.rounding = in_arithmetic(walk * std::max(q_unit, p_unit) * sizes[i]);
        map.doubtful = in_arithmetic(to_one_side * walk * std::max(q_unit, p_unit) * sizes[i]);
        break;
      }
    }
    map.relative = size > 0 ? quotient(map.max_error, size) : map.max_error;
    if (simulation.step() == 0) map.rounding.reset();  // without steps nothing is known about conservation
    all.push_back(map);
  }
  return all;
}

namespace {

/// From this many coordinates on, the run and its reversal are not in memory at the same time, because each has
/// neighbour lists.
constexpr std::size_t coordinates_in_memory_once = 100'000;

double roundings_of(const Simulation& simulation) {
  const Effort effort = simulation.effort();
  return std::max(static_cast<double>(effort.force + effort.gradient), static_cast<double>(simulation.step()));
}

/// Returns the coordinates without a turn since their range last doubled, and the angles that have made a full turn.
std::vector<std::size_t> growing_coordinates(const ProblemEntry& problem, const std::vector<OscillationCounter>& swings,
                                             std::int64_t steps_taken) {
  const std::vector<std::string>& names = problem.info.coordinates;
  const std::vector<std::string>& angles = problem.info.angles;
  std::vector<std::size_t> growing;
  for (std::size_t i = 0; 2 * i < swings.size(); ++i) {
    const bool angle = i < names.size() && std::find(angles.begin(), angles.end(), names[i]) != angles.end();
    const bool round = angle && swings[i].range() > 2 * std::numbers::pi;
    if (round || !swings[i].seen(steps_taken)) growing.push_back(i);
  }
  return growing;
}

/// Finds the slowest oscillation. An angle that has made a full turn does not oscillate. A momentum is only used if its
/// coordinate has not turned: on an eccentric orbit the momentum peaks at each pericentre, too briefly for the samples,
/// and the coordinate has the same period.
void find_periods(const ProblemEntry& problem, const std::vector<OscillationCounter>& swings, std::int64_t steps_taken,
                  EnergySeries& series) {
  const std::vector<std::string>& names = problem.info.coordinates;
  const std::vector<std::string>& angles = problem.info.angles;
  std::optional<double> earlier;
  bool goes_on = false;
  std::int64_t last_turn = 0;
  for (std::size_t i = 0; i < swings.size(); ++i) {
    const bool angle =
        i < names.size() && 2 * i < swings.size() && std::find(angles.begin(), angles.end(), names[i]) != angles.end();
    if (angle && swings[i].range() > 2 * std::numbers::pi) continue;
    const std::size_t half = swings.size() / 2;
    const auto of_coordinate = i < half ? std::nullopt : swings[i - half].seen(steps_taken);
    const auto seen = swings[i].seen(steps_taken);
    if (seen && of_coordinate && of_coordinate->periods > seen->periods && !of_coordinate->is_over) continue;
    if (seen) {
      series.periods = std::min(series.periods.value_or(seen->periods), seen->periods);
      goes_on = goes_on || !seen->is_over;
      last_turn = std::max(last_turn, seen->last_turn);
    }
    const double before = swings[i].earlier_periods();
    if (before > 0) earlier = std::min(earlier.value_or(before), before);
    series.outgrown = series.outgrown || (!seen && before > 0);
  }
  if (series.periods) {
    const double whole = static_cast<double>(steps_taken);
    if (!goes_on) series.still = (whole - static_cast<double>(last_turn)) / whole;
    return;
  }
  series.periods = earlier;  // a widening orbit turned before its range last doubled
  series.steady = false;
}

/// Returns whether the energy of a method has no drift: the method is symplectic, takes equal steps, and solves its
/// equations to rounding. Cut-off forces of many particles may cause a drift nevertheless.
bool has_no_energy_drift(const Request& request, const ProblemEntry& problem, const MethodInfo& method) {
  return method.symplectic && takes_equal_steps(method) && !method.carries_copy && !has_hard_walls(request) &&
         request.method.options.count(tolerance_option) == 0 && !problem.particles;
}

/// Returns whether the run has bounced off walls at which the energy makes a random walk (docs/design/walls.md).
bool has_random_walk_at_walls(const Request& request, const Simulation& simulation) {
  const auto& walls = request.walls;
  if (!walls || !(walls->rule == WallRule::event || walls->rule == WallRule::reject)) return false;
  const std::vector<WallCount> counts = simulation.wall_counts();
  return simulation.method().energy_conserving == Conservation::no &&
         std::any_of(counts.begin(), counts.end(), [](const WallCount& wall) { return wall.bounces > 0; });
}

/// Returns the differences of the energies from the first one, and their unit.
std::pair<EnergySeries, std::string> series_of(const Request& request, const ProblemEntry& problem,
                                               const Simulation& simulation, const EnergyBlockState& state,
                                               const RunEnds& ends, double size) {
  EnergySeries series;
  // The scale of the energy determines its rounding error, unless large terms cancel at the start: these are rounded,
  // too.
  const double scale = simulation.energy_scale();
  const double dt = evaluate_number<double>(request.dt);
  const double at_start =
      std::max(size > scale ? virial_per_size * size : scale, rounding_of_state(request, problem, ends, dt));
  // If not every coordinate is observed, `ends` is empty.
  const double growing =
      rounding_of_growing(request, problem, ends, growing_coordinates(problem, state.swings, simulation.step()), dt);
  const double rounded = at_start + growing;
  series.rounding_grows = growing > at_start / 4;  // in a run 16 times as long this part would dominate
  const int digits = digits_beyond_double(request.arithmetic);
  std::string unit = "1";
  if (!state.digits.empty()) {
    ScaledDifferences differences = differences_to_first(state.digits);
    series.deviations = std::move(differences.values);
    unit = differences.unit;
    const auto in_unit = [&](const LongNumber& x) { return quotient(x, times(1, unit)).value; };
    series.scale = in_unit(size);
    series.rounding = in_unit(times_power_of_ten(rounded, 1 - digits));
  } else {
    for (const double h : state.energies) series.deviations.push_back(h - state.energies.front());
    series.scale = size;
    series.rounding = std::max(epsilon * rounded, energy_of_units(request, problem, ends));
  }
  series.roundings = roundings_of(simulation);
  series.symplectic = has_no_energy_drift(request, problem, simulation.method());
  series.bounces = has_random_walk_at_walls(request, simulation);
  series.copies = simulation.method().carries_copy;
  find_periods(problem, state.swings, simulation.step(), series);
  return {series, unit};
}

}  // namespace

RunCertificate certify(const Request& request, const ProblemEntry& problem, std::unique_ptr<Simulation>& of_the_run,
                       const EnergyBlocks& blocks, std::int64_t steps_taken, const ContinueQuestion& go_on) {
  const Simulation& simulation = *of_the_run;
  RunCertificate found;
  found.typically_exchanged = blocks.state().exchange.typical();
  const double scale = simulation.energy_scale();
  const RunEnds ends = problem.energy ? ends_of(request, simulation) : RunEnds{};
  // A constant in H must not change the class, because it does not change the motion.
  const double exchanged = found.typically_exchanged.value_or(0);
  const bool is_motion = simulation.energy().max_error < exchanged && std::isfinite(exchanged);
  const double energy_size =
      is_motion ? std::max(exchanged, 0x1p-40 * scale) : size_of_energy(request, problem, ends, scale);
  const auto [series, unit] = series_of(request, problem, simulation, blocks.state(), ends, energy_size);
  found.drift = classify_run(series);
  const std::size_t size = request.start.q.size();
  if (const std::size_t watched = blocks.state().swings.size() / 2; watched > 0 && watched < size) {
    found.drift.reason +=
        "; oscillations were searched in " + std::to_string(watched) + " of " + std::to_string(size) + " coordinates";
  }
  found.mean_increment = times(found.drift.mean_increment, unit);
  found.mean_increment_error = times(found.drift.mean_increment_error, unit);
  const auto block_steps = static_cast<double>(blocks.state().block_steps);
  found.trend_not_excluded = scale > 0 ? quotient(times(found.drift.trend_not_excluded / block_steps, unit), scale)
                                       : LongNumber(std::numeric_limits<double>::quiet_NaN());
  if (found.drift.drift == DriftClass::random_walk && scale > 0) {
    const LongNumber& least = found.trend_not_excluded;
    found.drift.reason +=
        fmt::format("; in {} steps a trend below {} of the scale per step cannot be excluded", steps_taken,
                    least.text.empty() ? fmt::format("{:.1e}", least.value) : least.text);
  }
  LongNumber error = simulation.energy().max_error;
  // The error is below the range of double, so the largest difference of the samples is used.
  if (error.value == 0 && !blocks.state().digits.empty()) error = times(1, unit);
  // If the scale is 0 up to rounding, there is no relative error.
  constexpr double rounding_of_zero = 0x1p-40;
  if (scale > rounding_of_zero * energy_size) {
    found.energy_level = quotient(error, scale);
  } else if (error.value != 0 || !error.text.empty()) {
    found.energy_level = std::numeric_limits<double>::quiet_NaN();
  }
  found.momentum_maps = momentum_maps(simulation, problem, blocks.state().magnitudes, request);
  if (steps_taken > 0) {
    std::optional<double> period;
    if (found.drift.periods) period = static_cast<double>(steps_taken) / *found.drift.periods;
    const bool is_large = size > coordinates_in_memory_once && (!go_on || go_on());
    std::vector<std::byte> saved;
    if (is_large) {
      saved = of_the_run->save();
      of_the_run.reset();
    }
    found.reversal = reversal_evidence(request, problem, steps_taken, period, go_on);
    if (is_large) {
      of_the_run = make_simulation(request);
      of_the_run->restore(saved);
    }
  }
  return found;
}

}  // namespace hamflow
