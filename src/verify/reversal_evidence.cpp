// What the reversal of a part of a run proves: its distance beside what rounding explains.
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

constexpr double moved = 0x1p-36;       // of the size of q and of p: 2^16 roundings, and far from where motions part
constexpr double moved_less = 0x1p-40;  // the same for the motions that tell whether what parts is in proportion
constexpr double in_proportion = 4;     // up to such a factor: a smooth motion has 1, and roundings add to it
constexpr double parted = 1e-3;         // of the size: no longer a small difference
constexpr double beyond = 16;           // bounds of rounding: what is within so many is no proof against a method
constexpr std::int64_t most_waypoints = 64;                // at which two motions are compared
constexpr std::int64_t most_kept = std::int64_t{1} << 23;  // coordinates of all of them: 128 MB, with momenta

/// Keeps the states of a motion at up to `most_waypoints` of its steps, of very large systems at fewer: at least four.
class Waypoints final : public Observer {
 public:
  Waypoints(std::int64_t steps, std::size_t size)
      : apart_(std::max<std::int64_t>(
            1, steps / std::clamp<std::int64_t>(most_kept / static_cast<std::int64_t>(std::max<std::size_t>(1, size)),
                                                4, most_waypoints))) {}
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
  const Waypoints& way;
  UnitGroups groups;
  GroupSizes sizes = group_sizes(groups, reversal.sizes);
  std::size_t count() const { return sizes.size.size(); }  // of groups, those of momenta included
  /// What a difference within a group is relative to.
  double unit(std::size_t group) const { return sizes.size[group] > 0 ? sizes.size[group] : 1; }
};

/// How far another motion is from those states, at the same steps: the largest difference of a number over the size of
/// its group, where that is more than rounding. It keeps no states of its own.
class DistancesFrom final : public Observer {
 public:
  explicit DistancesFrom(const Motion& motion) : motion_(motion), of_positions_(motion.groups.count()) {
    const auto& walls = motion.request.walls;
    if (walls && walls->hard()) sides_ = wall_sides<double>(*walls);
  }
  std::int64_t next_due(std::int64_t step) const override { return motion_.way.next_due(step); }
  Verdict observe(const Frame& frame) override { return look(frame.q, frame.p) ? Verdict::go_on : Verdict::stop; }

  /// The next state. False: there is none left to compare it with.
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
      // Of two motions that meet a wall one is the first to bounce. Until the other has, their momenta are opposite.
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
  std::size_t widest() const { return widest_; }  // the group that is
  double mean_square() const { return squares_ / static_cast<double>(looks_); }

 private:
  /// Both are as near to a wall as the motions are to each other, some times over.
  bool is_on_wall(std::size_t coordinate, double a, double b) const {
    const std::size_t group = motion_.groups.group(coordinate);
    const double near = 16 * std::max(moved, of_positions_[group]) * motion_.unit(group);
    return std::any_of(sides_.begin(), sides_.end(), [&](const WallSide<double>& side) {
      return side.coordinate == coordinate && std::abs(side.beyond(a)) <= near && std::abs(side.beyond(b)) <= near;
    });
  }

  const Motion& motion_;
  std::vector<WallSide<double>> sides_;
  std::vector<double> of_positions_;  // the furthest of each group of coordinates
  double furthest_ = 0;
  std::size_t widest_ = 0;
  double squares_ = 0;
  std::size_t looks_ = 0;
  bool finite_ = true;
};

/// How the start of another motion lies beside that of the first: every coordinate moved by `size` of its own size
/// along the motion, up or down by chance. On a lattice, whose roundings have one size, of the largest coordinate's.
/// With `unequal`, by half of it up to the whole: no two particles then move alike, so that the distance of every pair
/// changes, and of a move and the opposite one either brings it nearer.
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

std::function<bool(std::int64_t)> pulse_of(const GoOn& go_on) {
  if (!go_on) return {};
  return [&go_on](std::int64_t) { return go_on(); };
}

/// The run itself has all threads that can be started here: one thread gives the same bits.
std::unique_ptr<Simulation> simulation_beside_the_run(const Request& request) {
  Request plain = request;
  plain.watch = false;
  try {
    return make_simulation(plain);
  } catch (const Error&) {
    plain.threads = 1;
    return make_simulation(plain);
  }
}

/// How far two motions part that begin `Move::size` apart, relative to the sizes of the groups.
struct Parting {
  bool measured = false;
  double root_mean_square = 0;  // over the way, over Move::size
  double furthest = 0;
  std::size_t widest = 0;  // the group in which that is
};

std::vector<std::string> all_texts(const std::vector<double>& x) {
  std::vector<std::string> texts;
  texts.reserve(x.size());
  for (const double number : x) texts.push_back(shortest(number));
  return texts;
}

/// The motion that begins at (q, p), and its second copy with it at states of its own: a run keeps them together at the
/// start, but what rounding does to one it does not do to the other.
void follow_with_copy(const Motion& motion, const std::vector<double>& q, const std::vector<double>& p,
                      const Move& move, DistancesFrom& beside, const GoOn& go_on) {
  const Reversal& reversal = motion.reversal;
  const std::size_t n = q.size();
  Request request = motion.request;
  request.parameters = complete(motion.problem.info, request.parameters);
  const auto map = motion.problem.step_map(request, n);
  if (!map) return;
  // (q, x, p, y): the copy of the start itself, moved by other chances.
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

/// In double: what is small beside the motion grows alike in every arithmetic.
Parting parting(const Motion& motion, const GoOn& go_on, const Move& move = {}) {
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

/// The distance that rounding explains, relative to the size of a group. A rounding of step j, on the
/// way there or back, is carried by the way back from j to the start. Of a symplectic map the inverse has the norm of
/// the map, so that it grows as a small difference at the start does on the way to j, which is measured. Roundings of
/// unit size u then add up like a walk: to u sqrt(2 a sum_j g_j^2) for a actions a step; four of them,
/// which is more than six times what reversible methods were found to need (tools/confusion_table.py).
/// @param growth Parting::root_mean_square   @param bounds so many times that
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

/// Whether what came back is within so many of those bounds.
bool within_rounding(const Motion& motion, double growth, double actions, double bounds = 1) {
  return at_most(motion.reversal.relative_distance, explained_by_rounding(motion, growth, actions, bounds));
}

std::string brief(const LongNumber& x) { return x.text.empty() ? fmt::format("{:.1e}", x.value) : x.text; }

/// Whether a motion begins on a hard wall, to rounding. There it comes back to the wall with the momentum of before or
/// behind the bounce, which of them decides the last bit of the time.
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

/// Whether a force may jump: at a hard wall, where the energy of a pair is cut off, where a typed H has an abs(). All
/// others depend smoothly on the state wherever H is finite.
bool force_may_jump(const Request& request, const ProblemEntry& problem) {
  const auto& choices = request.variant;
  return has_hard_walls(request) || problem.has_cutoff ||
         std::any_of(choices.begin(), choices.end(),
                     [](const auto& choice) { return choice.second.find("abs") != std::string::npos; });
}

/// Why what rounding becomes is not known; empty where small differences grow in proportion to themselves, as those of
/// every motion do that depends on its start smoothly. Where a force jumps between two motions that are close, one of
/// them takes a kick that the other does not, however close they are. A rounding then does as much as the move here.
/// Bodies of unlike masses part by unlike factors in unlike directions: what is not in proportion to the first move is
/// compared with a larger move in its own direction. The furthest that is seen is then what rounding may become.
/// @param apart how the first move parts; becomes the furthest parting seen
std::string out_of_proportion(const Motion& motion, Parting& apart, const GoOn& go_on) {
  const auto alike = [](const Parting& nearer, const Parting& wider) {
    return nearer.root_mean_square <= in_proportion * wider.root_mean_square &&
           wider.root_mean_square <= in_proportion * nearer.root_mean_square;
  };
  const char* const unmeasured = "but how far rounding is carried could not be measured";
  for (const double sign : {1.0, -1.0}) {
    const Parting nearer = parting(motion, go_on, {sign * moved_less, 3, true});
    if (!nearer.measured) return unmeasured;
    if (alike(nearer, apart)) continue;
    if (motion.reversal.relative_distance.value > beyond * std::max(apart.furthest, nearer.furthest)) continue;
    const Parting wider = parting(motion, go_on, {sign * moved, 3, true});
    if (!wider.measured) return unmeasured;
    if (alike(nearer, wider)) {
      apart.root_mean_square = std::max(apart.root_mean_square, wider.root_mean_square);
      if (wider.furthest > apart.furthest) apart.widest = wider.widest;
      apart.furthest = std::max(apart.furthest, wider.furthest);
      continue;
    }
    return fmt::format(
        "but what rounding becomes is not known: motions that begin {:.1e} of their size apart part by {:.1e} of it, "
        "those that begin {:.1e} apart in the same direction by {:.1e}, which is not in proportion, as where {}stiff "
        "steps round by more than that",
        moved, wider.furthest, moved_less, nearer.furthest,
        force_may_jump(motion.request, motion.problem)
            ? "a force jumps and a rounding decides on which side it is taken, or where "
            : "");
  }
  return {};
}

/// What is proved, and why.
std::pair<ReversalProof, std::string> judged(const Motion& motion, double actions, const GoOn& go_on) {
  const Reversal& reversal = motion.reversal;
  const MethodInfo method = describe(motion.request.method);
  const Frame* const states[] = {&reversal.start, &reversal.turn};
  const std::string why_not =
      why_not_reversed(parity_in_momenta(motion.problem, motion.request.parameters, motion.reversal.sizes, states));
  if (!why_not.empty()) return {ReversalProof::nothing, why_not};
  if (reversal.bit_exact) {
    if (method.reversible) return {ReversalProof::every_bit, "every bit came back"};
    return {ReversalProof::nothing,
            "every bit came back, but " + method.name + " is not reversible: its defect is below rounding"};
  }
  Parting apart = parting(motion, go_on);
  if (!apart.measured) return {ReversalProof::nothing, "how far rounding is carried could not be measured"};
  const auto off = [&](std::size_t group) {
    const GroupDistance& there = reversal.distances[group];
    return fmt::format("{} {} off", there.name, brief(there.distance));
  };
  const auto parts_too_far = [&] {
    const std::size_t g = apart.widest;
    return std::pair{ReversalProof::nothing,
                     fmt::format("{}, but motions that begin close to each other part by a factor of {:.0e}: what "
                                 "rounding becomes is not known",
                                 off(g), apart.furthest / moved)};
  };
  const auto has_parted = [&] { return apart.furthest > parted; };
  if (has_parted()) return parts_too_far();
  if (reversal.distance.text.empty() && reversal.distance.value == 0 && method.reversible) {
    return {ReversalProof::to_rounding,
            "q and p came back with every digit, but not the sign of a zero or what the steps carry beside them"};
  }
  std::size_t worst = 0;  // the group that is furthest off
  for (std::size_t g = 1; g < motion.count(); ++g) {
    if (!at_most(reversal.distances[g].relative, reversal.distances[worst].relative)) worst = g;
  }
  // What is below the bound of a motion in which nothing grows needs no other one.
  if (!within_rounding(motion, std::min(apart.root_mean_square, 1.0), actions)) {
    const std::string unknown = out_of_proportion(motion, apart, go_on);
    if (!unknown.empty()) return {ReversalProof::nothing, off(worst) + ", " + unknown};
    if (has_parted()) return parts_too_far();
  }
  const double growth = apart.root_mean_square;
  const LongNumber rounding = explained_by_rounding(motion, growth, actions);
  const LongNumber in_its_unit = rounding.text.empty() ? LongNumber(rounding.value * motion.unit(worst))
                                                       : times(motion.unit(worst), rounding.text);
  const std::string explained = fmt::format("{}, of which rounding explains {}", off(worst), brief(in_its_unit));
  if (!within_rounding(motion, growth, actions)) {
    if (method.reversible && within_rounding(motion, growth, actions, beyond)) {
      return {
          ReversalProof::nothing,
          explained + fmt::format(", and less than {:g} times that is no proof: a stiff step rounds by more than is "
                                  "estimated, and an arithmetic of more digits would tell",
                                  beyond)};
    }
    if (!begins_on_a_wall(motion)) return {ReversalProof::not_reversible, explained};
    return {ReversalProof::nothing, explained +
                                        ", but the motion begins on a wall, where the state before the bounce "
                                        "and that behind it are one"};
  }
  if (rounding.value > parted) return {ReversalProof::nothing, explained + ", which is too much to tell"};
  if (!method.reversible) {
    return {ReversalProof::nothing,
            explained + "; " + method.name + " is not reversible, but its defect is below that"};
  }
  return {ReversalProof::to_rounding, explained};
}

/// The step of the first bounce; 0: there is none in so many steps.
std::int64_t first_bounce(const Request& request, std::int64_t steps, const GoOn& go_on) {
  const auto simulation = simulation_beside_the_run(request);
  std::int64_t first = 0;
  simulation->tell_bounces([&](const Bounce& bounce) {
    if (first == 0) first = bounce.step;
  });
  (void)run(*simulation, steps, {}, [&](std::int64_t) { return first == 0 && (!go_on || go_on()); });
  return first;
}

ReversalEvidence stopped_evidence() {
  ReversalEvidence none;
  none.was_stopped = true;
  none.reason = "the reversal was left out: it was stopped before it had come to its end";
  return none;
}

/// How many times as long as in double an operation takes in another arithmetic, roughly.
double slowness_of(const std::string& arithmetic) {
  if (const int digits = mp_digits(arithmetic); digits > 0) return 200 * (1 + std::pow(digits / 300.0, 1.7));
  if (digits_beyond_double(arithmetic) > 0) return 50;
  return arithmetic == "lattice" ? 4 : 1;
}

/// The steps each way of which all evidence takes about a second. Work is counted, not timed, so that what is proved
/// does not depend on the machine: in pairs of bodies and in coordinates, of about 10 ns in double.
double steps_of_a_second(const Request& request, const ProblemEntry& problem, std::size_t size) {
  constexpr double work = 1e8;
  constexpr double motions = 8;           // there and back, up to five beside it, the way to the first bounce
  constexpr double of_implicit = 20;      // evaluations of an iterated step
  constexpr double of_coordinate = 10;    // also of a gas with a cut-off
  constexpr double numbers_of_pair = 16;  // pairs of bodies in space: a half of a ninth of the numbers' square
  const auto numbers = static_cast<double>(size);
  const bool all_pairs = problem.has_pairwise_forces && !problem.has_cutoff;
  const double force = std::max(of_coordinate * numbers, all_pairs ? numbers * numbers / numbers_of_pair : 0);
  const int stages = describe(request.method).forces_per_step;
  return work / (motions * force * (stages > 0 ? stages : of_implicit) * slowness_of(request.arithmetic));
}

}  // namespace

bool depends_on_time(const ProblemEntry& problem) { return problem.structure && problem.structure->time; }

ReversalEvidence reversal_evidence(const Request& request, const ProblemEntry& problem, std::int64_t steps_taken,
                                   std::optional<double> period, const GoOn& asked) {
  ReversalEvidence found;
  bool stopped = false;
  const GoOn go_on = [&] {
    stopped = stopped || (asked && !asked());
    return !stopped;
  };
  if (depends_on_time(problem)) {
    found.reason = "H depends on t, which goes on: the motion itself is not reversed by negating the momenta";
    return found;
  }
  if (!go_on()) return stopped_evidence();
  const StopQuestion question(go_on);  // a step in many digits can take minutes
  const double at_least = std::min(period ? std::ceil(*period) : 1000.0, 1000.0);
  auto simulation = simulation_beside_the_run(request);
  Frame start;
  simulation->look(start);
  const std::size_t size = std::max<std::size_t>(1, start.q.size());
  const auto most = static_cast<std::int64_t>(1e8 / static_cast<double>(size));
  const double affordable = steps_of_a_second(request, problem, size);
  found.steps = std::max(steps_taken / 200, static_cast<std::int64_t>(std::min(at_least, affordable)));
  if (found.steps == 0) {
    found.reason = "left out: one step there and back would take more than a second and than a tenth of the run";
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

  simulation->tell_bounces([&](const Bounce& bounce) { found.bounces += bounce.step <= found.steps ? 1 : 0; });
  Waypoints way(found.steps, start.q.size());
  Observer* const watch[] = {&way};
  Reversal reversal;
  const UnitGroups groups = unit_groups(problem, start.q.size());
  if (go_on()) reversal = reverse(*simulation, found.steps, pulse_of(go_on), watch, groups);
  if (!stopped && reversal.outcome != Outcome::done) {
    const Frame* const states[] = {&reversal.start, &reversal.turn};
    const MomentumParity parity = parity_in_momenta(problem, request.parameters, reversal.sizes, states);
    found.reason = !parity.is_defined
                       ? why_not_reversed(parity)
                       : "a step of the way there or back failed: " +
                             (reversal.failure.empty() ? std::string(message(reversal.outcome)) : reversal.failure);
  } else if (!stopped) {
    found.distance = reversal.distance;
    found.relative = reversal.relative_distance;
    found.bit_exact = reversal.bit_exact;
    const Effort effort = simulation->effort();
    const double actions =
        std::max(1.0, static_cast<double>(effort.force + effort.gradient) / static_cast<double>(2 * found.steps));
    simulation.reset();  // another one is made, and two of a million particles need not have their lists at a time
    reversal.end = {};
    const Motion motion{request, problem, reversal, way, groups};
    std::tie(found.proves, found.reason) = judged(motion, actions, go_on);
  }
  if (stopped) return stopped_evidence();
  if (walled && found.bounces == 0) found.reason += "; no bounce was met";
  if (found.steps < steps_taken) {
    found.reason += fmt::format("; the other {} steps of the run were left out", steps_taken - found.steps);
  }
  if (period && static_cast<double>(found.steps) < *period) {
    const bool turned_once = *period >= 2 * static_cast<double>(steps_taken);
    found.reason += turned_once ? "; no whole period of the slowest oscillation was seen"
                                : "; shorter than one period of the slowest oscillation";
  }
  return found;
}

}  // namespace hamflow
