// Judges the reversal of a part of a run: compares its distance with the distance that rounding explains.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "engine/make_simulation.hpp"
#include "hamflow/core/counter_random.hpp"
#include "hamflow/core/stop_question.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/run/walls.hpp"
#include "hamflow/verify/certificate.hpp"
#include "rounding.hpp"

namespace hamflow {

namespace {

constexpr double moved = 0x1p-36;  // initial distance relative to q and p: 2^16 roundings, but still small
constexpr double smaller_displacement =
    0x1p-40;                              // smaller initial distance, to test whether distances grow in proportion
constexpr double most_disproportion = 4;  // allowed factor: a smooth motion has 1, and roundings add to it
constexpr double parted = 1e-3;           // relative distance that counts as large
constexpr double beyond = 16;             // a distance below this many rounding bounds does not refute a method
constexpr std::int64_t most_stored_states = 64;  // number of states at which two motions are compared
// coordinates in all stored states: 128 MB, together with the momenta
constexpr std::int64_t most_stored_coordinates = std::int64_t{1} << 23;

/// Stores the states of a motion at up to `most_stored_states` steps. For very large systems it stores fewer states,
/// but at least four.
class StoredStates final : public Observer {
 public:
  StoredStates(std::int64_t steps, std::size_t size)
      : apart_(std::max<std::int64_t>(
            1, steps / std::clamp<std::int64_t>(
                           most_stored_coordinates / static_cast<std::int64_t>(std::max<std::size_t>(1, size)), 4,
                           most_stored_states))) {}
  std::int64_t apart() const { return apart_; }
  std::int64_t next_due(std::int64_t step) const override { return (step + apart_ - 1) / apart_ * apart_; }
  Verdict observe(const Frame& frame) override {
    q_.push_back(frame.q);
    p_.push_back(frame.p);
    return Verdict::go_on;
  }
  std::size_t count() const { return q_.size(); }
  const std::vector<double>& q(std::size_t i) const { return q_[i]; }
  const std::vector<double>& p(std::size_t i) const { return p_[i]; }

 private:
  std::int64_t apart_;
  std::vector<std::vector<double>> q_;
  std::vector<std::vector<double>> p_;
};

double largest_of(const std::vector<double>& sizes) {
  return sizes.empty() ? 0 : *std::max_element(sizes.begin(), sizes.end());
}

/// The motion whose reversal is judged.
struct Motion {
  const Request& request;
  const ProblemEntry& problem;
  const Reversal& reversal;
  const StoredStates& way;
  UnitGroups groups;
  GroupSizes sizes = group_sizes(groups, reversal.sizes);
  std::size_t count() const { return sizes.size.size(); }  // number of groups, including groups of momenta
  /// The size by which differences within a group are divided.
  double unit(std::size_t group) const { return sizes.size[group] > 0 ? sizes.size[group] : 1; }
};

/// Measures the distance of another motion from the stored states, at the same steps: the largest difference of two
/// numbers divided by the size of their group, without groups that contain only rounding errors. It stores no states.
class DistancesFrom final : public Observer {
 public:
  explicit DistancesFrom(const Motion& motion) : motion_(motion), of_positions_(motion.groups.count()) {
    const auto& walls = motion.request.walls;
    if (walls && walls->hard()) sides_ = wall_sides<double>(*walls);
  }
  std::int64_t next_due(std::int64_t step) const override { return motion_.way.next_due(step); }
  Verdict observe(const Frame& frame) override { return look(frame.q, frame.p) ? Verdict::go_on : Verdict::stop; }

  /// Compares the next state. Returns false if all stored states have been compared.
  bool look(const std::vector<double>& q, const std::vector<double>& p) {
    if (looks_ == motion_.way.count()) return false;
    const std::vector<double>& way_q = motion_.way.q(looks_);
    const std::vector<double>& way_p = motion_.way.p(looks_);
    const std::size_t n = motion_.groups.count();
    double here = 0;
    const auto relative = [&](std::size_t group, double distance) {
      if (!std::isfinite(distance)) finite_ = false;
      distance /= motion_.unit(group);
      if (!motion_.sizes.is_rounding[group] && distance > here) {
        here = distance;
        if (here > furthest_) widest_ = group;
      }
      return distance;
    };
    for (std::size_t k = 0; k < q.size(); ++k) {
      double& most = of_positions_[motion_.groups.group(k)];
      most = std::max(most, relative(motion_.groups.group(k), std::abs(way_q[k] - q[k])));
    }
    for (std::size_t k = 0; k < p.size(); ++k) {
      const double apart = std::abs(way_p[k] - p[k]);
      // When two motions meet a wall, one of them bounces first. Until the other one bounces, their momenta are
      // opposite.
      const double turned = is_on_wall(k, way_q[k], q[k]) ? std::abs(way_p[k] + p[k]) : apart;
      (void)relative(n + motion_.groups.group(k), std::min(apart, turned));
    }
    furthest_ = std::max(furthest_, here);
    squares_ += here * here;
    ++looks_;
    return true;
  }
  bool is_complete() const { return finite_ && looks_ == motion_.way.count(); }
  double furthest() const { return furthest_; }
  std::size_t widest() const { return widest_; }  // group with the largest distance
  double mean_square() const { return squares_ / static_cast<double>(looks_); }

 private:
  /// Returns whether both states are about as close to a wall as the motions are to each other.
  bool is_on_wall(std::size_t coordinate, double a, double b) const {
    const std::size_t group = motion_.groups.group(coordinate);
    const double near = 16 * std::max(moved, of_positions_[group]) * motion_.unit(group);
    return std::any_of(sides_.begin(), sides_.end(), [&](const WallSide<double>& side) {
      return side.coordinate == coordinate && std::abs(side.beyond(a)) <= near && std::abs(side.beyond(b)) <= near;
    });
  }

  const Motion& motion_;
  std::vector<WallSide<double>> sides_;
  std::vector<double> of_positions_;  // largest distance of each group of coordinates
  double furthest_ = 0;
  std::size_t widest_ = 0;
  double squares_ = 0;
  std::size_t looks_ = 0;
  bool finite_ = true;
};

/// How to displace the start of another motion: every coordinate moves by `size` times its size along the motion, with
/// a random sign. On a lattice, where all roundings are equal, the size of the largest coordinate is used. With
/// `unequal` the displacements are between half and the whole of this. Then no two particles move alike, the distance
/// of every pair changes, and either a displacement or the opposite one reduces it.
struct Move {
  double size = moved;
  std::uint64_t seed = 1;
  bool unequal = false;
};

std::vector<double> moved_by(const std::vector<double>& x, const std::vector<double>& sizes, const Move& move,
                             std::uint64_t seed, bool on_lattice) {
  std::vector<double> out = x;
  const double largest = largest_of(sizes);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const std::uint64_t random = counter_bits(seed, i);
    const double sign = random % 2 == 0 ? 1 : -1;
    const double share = move.unequal ? 0.5 + 0.5 * static_cast<double>(random >> 11U) * 0x1p-53 : 1;
    out[i] += sign * share * move.size * (on_lattice ? largest : sizes[i]);
  }
  return out;
}

std::function<bool(std::int64_t)> pulse_of(const ContinueQuestion& go_on) {
  if (!go_on) return {};
  return [&go_on](std::int64_t) { return go_on(); };
}

/// Makes a second simulation. If no further threads can be started, it uses one thread, which gives the same bits.
std::unique_ptr<Simulation> second_simulation(const Request& request) {
  Request plain = request;
  plain.watch = false;
  try {
    return make_simulation(plain);
  } catch (const Error&) {
    plain.threads = 1;
    return make_simulation(plain);
  }
}

/// Separation of two motions that start at a distance of `Move::size`, relative to the sizes of the groups.
struct Separation {
  bool measured = false;
  double root_mean_square = 0;  // along the motion, divided by Move::size
  double furthest = 0;
  std::size_t widest = 0;  // group with the largest distance
};

std::vector<std::string> all_texts(const std::vector<double>& x) {
  std::vector<std::string> texts;
  texts.reserve(x.size());
  for (const double number : x) texts.push_back(shortest(number));
  return texts;
}

/// Follows the motion that starts at (q, p) for a method that carries a second copy of the state. The copy starts from
/// another displaced state. In a run both copies start equal, but rounding acts on each of them differently.
void follow_with_copy(const Motion& motion, const std::vector<double>& q, const std::vector<double>& p,
                      const Move& move, DistancesFrom& beside, const ContinueQuestion& go_on) {
  const Reversal& reversal = motion.reversal;
  const std::size_t n = q.size();
  Request request = motion.request;
  request.parameters = complete(motion.problem.info, request.parameters);
  const auto map = motion.problem.step_map(request, n);
  if (!map) return;
  // The state is (q, x, p, y). The copy (x, y) is the start with other random displacements.
  const StateSizes& sizes = motion.reversal.sizes;
  const std::vector<double> x = moved_by(reversal.start.q, sizes.q, move, move.seed + 16, false);
  const std::vector<double> y = moved_by(reversal.start.p, sizes.p, move, move.seed + 17, false);
  State<double> z = q;
  for (const auto* part : {&x, &p, &y}) z.insert(z.end(), part->begin(), part->end());
  const auto h = evaluate_number<double>(request.dt);
  const auto part = [&](std::size_t k) {
    const auto begin = z.begin() + static_cast<std::ptrdiff_t>(k * n);
    return std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(n));
  };
  while (beside.look(part(0), part(2))) {
    if ((go_on && !go_on()) || !map->advance(z, h, motion.way.apart())) return;
  }
}

/// Measures the separation in double, because small differences grow equally in every arithmetic.
Separation parting(const Motion& motion, const ContinueQuestion& go_on, const Move& move = {}) {
  const Reversal& reversal = motion.reversal;
  const StateSizes& sizes = motion.reversal.sizes;
  const bool on_lattice = motion.request.arithmetic == "lattice";
  const std::vector<double> q = moved_by(reversal.start.q, sizes.q, move, move.seed, on_lattice);
  const std::vector<double> p = moved_by(reversal.start.p, sizes.p, move, move.seed + 1, on_lattice);
  DistancesFrom beside(motion);
  if (describe(motion.request.method).carries_copy) {
    follow_with_copy(motion, q, p, move, beside, go_on);
  } else {
    Request other = motion.request;
    other.watch = false;
    other.arithmetic = "double";
    other.threads = 1;
    other.start = {};
    other.start.q = all_texts(q);
    other.start.p = all_texts(p);
    Observer* const watch[] = {&beside};
    const auto simulation = make_simulation_of(std::move(other));
    if (run(*simulation, reversal.steps, watch, pulse_of(go_on)) != Outcome::done) return {};
  }
  if (!beside.is_complete()) return {};
  return {true, std::sqrt(beside.mean_square()) / std::abs(move.size), beside.furthest(), beside.widest()};
}

/// Returns the distance that rounding explains, relative to the size of a group. The second half amplifies a rounding
/// of step j on the way from j to the start. The inverse of a symplectic map has the same norm as the map, so the
/// amplification g_j equals the growth of a small difference from the start to j, which is measured. Roundings of size
/// u add up like a random walk, to u sqrt(2 a sum_j g_j^2) for a operations per step. The bound is four times this,
/// more than six times the distances that reversible methods showed (tools/confusion_table.py).
/// @param growth Separation::root_mean_square   @param bounds factor for the result
LongNumber explained_by_rounding(const Motion& motion, double growth, double actions, double bounds = 1) {
  const Request& request = motion.request;
  const double factor = bounds * 4 * (1 + std::sqrt(2 * actions * static_cast<double>(motion.reversal.steps))) * growth;
  const int digits = digits_beyond_double(request.arithmetic);
  if (digits > 0) return times_power_of_ten(factor, 1 - digits);
  if (request.arithmetic != "lattice") return factor * epsilon;
  const auto over = [](double unit, double size) { return size > 0 ? unit / size : 0; };
  const StateSizes& sizes = motion.reversal.sizes;
  return factor * std::max({epsilon, over(request.position_unit, largest_of(sizes.q)),
                            over(request.momentum_unit, largest_of(sizes.p))});
}

/// Returns whether the distance of the reversal is below `bounds` times this bound.
bool within_rounding(const Motion& motion, double growth, double actions, double bounds = 1) {
  return at_most(motion.reversal.relative_distance, explained_by_rounding(motion, growth, actions, bounds));
}

std::string brief(const LongNumber& x) { return x.text.empty() ? fmt::format("{:.1e}", x.value) : x.text; }

/// Returns whether a motion starts on a hard wall, to rounding. Then it returns with the momentum before or after the
/// bounce, depending on the last bit of the time.
bool begins_on_a_wall(const Motion& motion) {
  const auto& walls = motion.request.walls;
  if (!walls || !walls->hard()) return false;
  const auto sides = wall_sides<double>(*walls);
  return std::any_of(sides.begin(), sides.end(), [&](const WallSide<double>& side) {
    const double size = motion.unit(motion.groups.group(side.coordinate));
    return std::abs(side.beyond(motion.reversal.start.q[side.coordinate])) <=
           8 * epsilon * std::max(size, std::abs(side.at));
  });
}

/// Returns whether a force may be discontinuous: at a hard wall, at the cut-off of a pair energy, or with abs() in a
/// typed H. All other forces depend smoothly on the state wherever H is finite.
bool force_may_jump(const Request& request, const ProblemEntry& problem) {
  const auto& choices = request.variant;
  return has_hard_walls(request) || problem.has_cutoff ||
         std::any_of(choices.begin(), choices.end(),
                     [](const auto& choice) { return choice.second.find("abs") != std::string::npos; });
}

/// Explains why the amplification of rounding errors is unknown; empty if small differences grow in proportion to their
/// size, as they do for every motion that depends smoothly on its start. At a discontinuity of the force, one of two
/// motions may get a kick that the other one does not get, however close they are; then a rounding has the same effect
/// as the displacement here. Bodies with different masses separate by different factors in different directions.
/// Therefore, if a separation is not in proportion to the first displacement, it is compared with that for a larger
/// displacement in the same direction, and the largest separation is used.
/// @param apart separation for the first displacement; becomes the largest separation
std::string why_not_proportional(const Motion& motion, Separation& apart, const ContinueQuestion& go_on) {
  const auto alike = [](const Separation& nearer, const Separation& wider) {
    return nearer.root_mean_square <= most_disproportion * wider.root_mean_square &&
           wider.root_mean_square <= most_disproportion * nearer.root_mean_square;
  };
  const char* const unmeasured = "but the amplification of rounding errors could not be measured";
  for (const double sign : {1.0, -1.0}) {
    const Separation nearer = parting(motion, go_on, {sign * smaller_displacement, 3, true});
    if (!nearer.measured) return unmeasured;
    if (alike(nearer, apart)) continue;
    if (motion.reversal.relative_distance.value > beyond * std::max(apart.furthest, nearer.furthest)) continue;
    const Separation wider = parting(motion, go_on, {sign * moved, 3, true});
    if (!wider.measured) return unmeasured;
    if (alike(nearer, wider)) {
      apart.root_mean_square = std::max(apart.root_mean_square, wider.root_mean_square);
      if (wider.furthest > apart.furthest) apart.widest = wider.widest;
      apart.furthest = std::max(apart.furthest, wider.furthest);
      continue;
    }
    return fmt::format(
        "but the amplification of rounding errors is unknown: motions that start {:.1e} apart (relative) separate to "
        "{:.1e}, those that start {:.1e} apart in the same direction to {:.1e}, which is not proportional; {}stiff "
        "steps "
        "with larger rounding errors can be the cause",
        moved, wider.furthest, smaller_displacement, nearer.furthest,
        force_may_jump(motion.request, motion.problem) ? "a discontinuous force or " : "");
  }
  return {};
}

/// Returns the conclusion and its reason.
std::pair<ReversalProof, std::string> judged(const Motion& motion, double actions, const ContinueQuestion& go_on) {
  const Reversal& reversal = motion.reversal;
  const MethodInfo method = describe(motion.request.method);
  const Frame* const states[] = {&reversal.start, &reversal.turn};
  const std::string why_not =
      why_not_reversed(parity_in_momenta(motion.problem, motion.request.parameters, motion.reversal.sizes, states));
  if (!why_not.empty()) return {ReversalProof::nothing, why_not};
  if (reversal.bit_exact) {
    if (method.reversible) return {ReversalProof::every_bit, "every bit returned"};
    return {ReversalProof::nothing,
            "every bit returned, but " + method.name + " is not reversible; its defect is below rounding"};
  }
  Separation apart = parting(motion, go_on);
  if (!apart.measured) {
    return {ReversalProof::nothing, "the amplification of rounding errors could not be measured"};
  }
  const auto off = [&](std::size_t group) {
    const GroupDistance& there = reversal.distances[group];
    return fmt::format("distance {} in {}", brief(there.distance), there.name);
  };
  const auto separation_too_large = [&] {
    const std::size_t g = apart.widest;
    return std::pair{
        ReversalProof::nothing,
        fmt::format("{}, but motions that start close together separate by a factor of {:.0e}, so the effect "
                    "of rounding is unknown",
                    off(g), apart.furthest / moved)};
  };
  const auto separation_is_large = [&] { return apart.furthest > parted; };
  if (separation_is_large()) return separation_too_large();
  if (reversal.distance.text.empty() && reversal.distance.value == 0 && method.reversible) {
    return {
        ReversalProof::to_rounding,
        "every digit of q and p returned, but not the sign of a zero or digits that the steps carry below the last"};
  }
  std::size_t worst = 0;  // group with the largest relative distance
  for (std::size_t g = 1; g < motion.count(); ++g) {
    if (!at_most(reversal.distances[g].relative, reversal.distances[worst].relative)) worst = g;
  }
  // If the distance is below the bound without amplification, no further motion is needed.
  if (!within_rounding(motion, std::min(apart.root_mean_square, 1.0), actions)) {
    const std::string unknown = why_not_proportional(motion, apart, go_on);
    if (!unknown.empty()) return {ReversalProof::nothing, off(worst) + ", " + unknown};
    if (separation_is_large()) return separation_too_large();
  }
  const double growth = apart.root_mean_square;
  const LongNumber rounding = explained_by_rounding(motion, growth, actions);
  const LongNumber in_its_unit = rounding.text.empty() ? LongNumber(rounding.value * motion.unit(worst))
                                                       : times(motion.unit(worst), rounding.text);
  const std::string explained = fmt::format("{}, rounding explains up to {}", off(worst), brief(in_its_unit));
  if (!within_rounding(motion, growth, actions)) {
    if (method.reversible && within_rounding(motion, growth, actions, beyond)) {
      return {
          ReversalProof::nothing,
          explained +
              fmt::format("; a distance below {:g} times this proves nothing, since stiff steps have larger rounding "
                          "errors; an arithmetic with more digits would decide",
                          beyond)};
    }
    if (!begins_on_a_wall(motion)) return {ReversalProof::not_reversible, explained};
    return {ReversalProof::nothing, explained +
                                        ", but the motion starts on a wall, where the states before and after the "
                                        "bounce cannot be distinguished"};
  }
  if (rounding.value > parted) return {ReversalProof::nothing, explained + ", which is too large for a conclusion"};
  if (!method.reversible) {
    return {ReversalProof::nothing,
            explained + "; " + method.name + " is not reversible, but its defect is below this bound"};
  }
  return {ReversalProof::to_rounding, explained};
}

/// Returns the step of the first bounce; 0: no bounce within `steps`.
std::int64_t first_bounce(const Request& request, std::int64_t steps, const ContinueQuestion& go_on) {
  const auto simulation = second_simulation(request);
  std::int64_t first = 0;
  simulation->on_bounce([&](const Bounce& bounce) {
    if (first == 0) first = bounce.step;
  });
  (void)run(*simulation, steps, {}, [&](std::int64_t) { return first == 0 && (!go_on || go_on()); });
  return first;
}

ReversalEvidence stopped_evidence() {
  ReversalEvidence none;
  none.was_stopped = true;
  none.reason = "the reversal was interrupted before it finished";
  return none;
}

/// Returns the approximate cost of an operation in another arithmetic, relative to double.
double slowness_of(const std::string& arithmetic) {
  if (const int digits = mp_digits(arithmetic); digits > 0) return 200 * (1 + std::pow(digits / 300.0, 1.7));
  if (digits_beyond_double(arithmetic) > 0) return 50;
  return arithmetic == "lattice" ? 4 : 1;
}

/// Returns the number of steps in each direction for which the whole test takes about a second. Work is counted in
/// pairs of bodies and in coordinates, at about 10 ns each in double. Time is not measured, so the conclusion does not
/// depend on the machine.
double steps_of_a_second(const Request& request, const ProblemEntry& problem, std::size_t size) {
  constexpr double work = 1e8;
  // forward, back, up to five displaced motions, and the search for the first bounce
  constexpr double motions = 8;
  constexpr double of_implicit = 20;      // evaluations of an implicit step
  constexpr double of_coordinate = 10;    // also for a gas with a cut-off
  constexpr double numbers_of_pair = 16;  // n numbers have n^2/18 pairs of bodies in space
  const auto numbers = static_cast<double>(size);
  const bool all_pairs = problem.has_pairwise_forces && !problem.has_cutoff;
  const double force = std::max(of_coordinate * numbers, all_pairs ? numbers * numbers / numbers_of_pair : 0);
  const int stages = describe(request.method).forces_per_step;
  return work / (motions * force * (stages > 0 ? stages : of_implicit) * slowness_of(request.arithmetic));
}

}  // namespace

bool depends_on_time(const ProblemEntry& problem) { return problem.structure && problem.structure->time; }

ReversalEvidence reversal_evidence(const Request& request, const ProblemEntry& problem, std::int64_t steps_taken,
                                   std::optional<double> period, const ContinueQuestion& asked) {
  ReversalEvidence found;
  bool stopped = false;
  const ContinueQuestion go_on = [&] {
    stopped = stopped || (asked && !asked());
    return !stopped;
  };
  if (depends_on_time(problem)) {
    found.reason = "H depends on t, and t keeps increasing, so negating the momenta does not reverse the motion";
    return found;
  }
  if (!go_on()) return stopped_evidence();
  const StopQuestion question(go_on);  // a step in many digits can take minutes
  const double at_least = std::min(period ? std::ceil(*period) : 1000.0, 1000.0);
  auto simulation = second_simulation(request);
  Frame start;
  simulation->look(start);
  const std::size_t size = std::max<std::size_t>(1, start.q.size());
  const auto most = static_cast<std::int64_t>(1e8 / static_cast<double>(size));
  const double affordable = steps_of_a_second(request, problem, size);
  found.steps = std::max(steps_taken / 200, static_cast<std::int64_t>(std::min(at_least, affordable)));
  if (found.steps == 0) {
    found.reason = "not tested: one step forward and back would take more than a second and a tenth of the run";
    return found;
  }
  const bool walled = has_hard_walls(request);
  if (walled) {
    const auto bounded = static_cast<std::int64_t>(std::min(1e15, affordable));
    const std::int64_t searched = std::min({steps_taken, most, std::max(steps_taken / 200, bounded)});
    found.steps = std::max(found.steps, first_bounce(request, searched, go_on));
  }
  found.steps = std::max<std::int64_t>(1, std::min({found.steps, steps_taken, most}));
  found.share = static_cast<double>(found.steps) / static_cast<double>(steps_taken);

  simulation->on_bounce([&](const Bounce& bounce) { found.bounces += bounce.step <= found.steps ? 1 : 0; });
  StoredStates way(found.steps, start.q.size());
  Observer* const watch[] = {&way};
  Reversal reversal;
  const UnitGroups groups = unit_groups(problem, start.q.size());
  if (go_on()) reversal = reverse(*simulation, found.steps, pulse_of(go_on), watch, groups);
  if (!stopped && reversal.outcome != Outcome::done) {
    const Frame* const states[] = {&reversal.start, &reversal.turn};
    const MomentumParity parity = parity_in_momenta(problem, request.parameters, reversal.sizes, states);
    found.reason = !parity.is_defined
                       ? why_not_reversed(parity)
                       : "a step of the reversal failed: " +
                             (reversal.failure.empty() ? std::string(message(reversal.outcome)) : reversal.failure);
  } else if (!stopped) {
    found.distance = reversal.distance;
    found.relative = reversal.relative_distance;
    found.bit_exact = reversal.bit_exact;
    const Effort effort = simulation->effort();
    const double actions =
        std::max(1.0, static_cast<double>(effort.force + effort.gradient) / static_cast<double>(2 * found.steps));
    // frees memory before another simulation is made, for example neighbour lists of a million particles
    simulation.reset();
    reversal.end = {};
    const Motion motion{request, problem, reversal, way, groups};
    std::tie(found.proves, found.reason) = judged(motion, actions, go_on);
  }
  if (stopped) return stopped_evidence();
  if (walled && found.bounces == 0) found.reason += "; no bounce occurred";
  if (found.steps < steps_taken) {
    found.reason += fmt::format("; the other {} steps of the run were not tested", steps_taken - found.steps);
  }
  if (period && static_cast<double>(found.steps) < *period) {
    const bool turned_once = *period >= 2 * static_cast<double>(steps_taken);
    found.reason += turned_once ? "; no complete period of the slowest oscillation was seen"
                                : "; the test is shorter than one period of the slowest oscillation";
  }
  return found;
}

}  // namespace hamflow
