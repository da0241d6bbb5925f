// What the reversal of a part of a run proves: its distance beside what rounding explains.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "hamflow/core/counter_random.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/run/make_simulation.hpp"
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

double largest_of(const std::vector<double>& xs) {
  double most = 0;
  for (const double x : xs) most = std::max(most, std::abs(x));
  return most;
}

/// Keeps the states of a motion at up to `most_waypoints` of its steps, of very large systems at fewer: at least four.
class Waypoints final : public Observer {
 public:
  Waypoints(std::int64_t steps, std::size_t size)
      : apart_(std::max<std::int64_t>(
            1, steps / std::clamp<std::int64_t>(most_kept / static_cast<std::int64_t>(std::max<std::size_t>(1, size)),
                                                4, most_waypoints))) {}
  std::int64_t next_due(std::int64_t step) const override { return (step + apart_ - 1) / apart_ * apart_; }
  Verdict observe(const Frame& frame) override {
    q_.push_back(frame.q);
    p_.push_back(frame.p);
    return Verdict::go_on;
  }
  std::size_t count() const { return q_.size(); }
  const std::vector<double>& q(std::size_t i) const { return q_[i]; }
  const std::vector<double>& p(std::size_t i) const { return p_[i]; }
  double size_of(const std::vector<std::vector<double>>& all) const {
    double most = 0;
    for (const auto& x : all) most = std::max(most, largest_of(x));
    return most;
  }
  double q_size() const { return size_of(q_); }
  double p_size() const { return size_of(p_); }

 private:
  std::int64_t apart_;
  std::vector<std::vector<double>> q_;
  std::vector<std::vector<double>> p_;
};

/// How far another motion is from those states, at the same steps. It keeps none of its own.
class DistancesFrom final : public Observer {
 public:
  explicit DistancesFrom(const Waypoints& way) : way_(way) {}
  std::int64_t next_due(std::int64_t step) const override { return way_.next_due(step); }
  Verdict observe(const Frame& frame) override {
    const std::size_t i = distances_.size();
    if (i == way_.count()) return Verdict::stop;
    double distance = 0;
    for (std::size_t k = 0; k < frame.q.size(); ++k) {
      distance = std::max({distance, std::abs(way_.q(i)[k] - frame.q[k]), std::abs(way_.p(i)[k] - frame.p[k])});
    }
    distances_.push_back(distance);
    return Verdict::go_on;
  }
  const std::vector<double>& all() const { return distances_; }

 private:
  const Waypoints& way_;
  std::vector<double> distances_;
};

/// How the start of another motion lies beside that of the first: every coordinate moved by `size` of the largest one,
/// up or down by chance. With `unequal`, by half of it up to the whole: no two particles then move alike, so that the
/// distance of every pair changes, and of a move and the opposite one either brings it nearer.
struct Move {
  double size = moved;
  std::uint64_t seed = 1;
  bool unequal = false;
};

std::vector<std::string> moved_by(const std::vector<double>& x, double size, const Move& move, std::uint64_t seed) {
  std::vector<std::string> texts;
  texts.reserve(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const std::uint64_t random = counter_bits(seed, i);
    const double sign = random % 2 == 0 ? 1 : -1;
    const double share = move.unequal ? 0.5 + 0.5 * static_cast<double>(random >> 11U) * 0x1p-53 : 1;
    texts.push_back(shortest(x[i] + sign * share * move.size * size));
  }
  return texts;
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

/// How far two motions part that begin `Move::size` apart.
struct Parting {
  bool measured = false;
  double root_mean_square = 0;  // over the way, in that
  double furthest = 0;          // as it is
};

/// In double: what is small beside the motion grows alike in every arithmetic.
Parting parting(const Request& request, const Reversal& reversal, const Waypoints& way, const GoOn& go_on,
                const Move& move = {}) {
  Request other = request;
  other.watch = false;
  other.arithmetic = "double";
  other.threads = 1;
  other.start = {};
  other.start.q = moved_by(reversal.start.q, way.q_size(), move, move.seed);
  other.start.p = moved_by(reversal.start.p, way.p_size(), move, move.seed + 1);
  DistancesFrom beside(way);
  Observer* const watch[] = {&beside};
  const auto simulation = make_simulation_of(std::move(other));
  Parting found;
  const Outcome outcome = run(*simulation, reversal.steps, watch, pulse_of(go_on));
  if (outcome != Outcome::done || beside.all().size() != way.count()) return found;
  double squares = 0;
  for (const double distance : beside.all()) {
    if (!std::isfinite(distance)) return found;
    found.furthest = std::max(found.furthest, distance);
    squares += distance * distance;
  }
  found.measured = true;
  found.root_mean_square = std::sqrt(squares / static_cast<double>(way.count())) / std::abs(move.size);
  return found;
}

/// The distance that rounding explains. A rounding of step j, on the way there or back, is carried by the way back from
/// j to the start. Of a symplectic map the inverse has the norm of the map, so that it grows as a small difference at
/// the start does on the way to j, which is measured. Roundings of unit size u then add up like a walk: to u
/// sqrt(2 a sum_j g_j^2) for a actions a step; four of them,
/// which is more than six times what reversible methods were found to need (tools/confusion_table.py).
/// @param bounds so many times that
LongNumber explained_by_rounding(const Request& request, const Reversal& reversal, const Parting& parting,
                                 const Waypoints& way, double actions, double bounds = 1) {
  const double factor =
      bounds * 4 * (1 + std::sqrt(2 * actions * static_cast<double>(reversal.steps))) * parting.root_mean_square;
  const int digits = digits_beyond_double(request.arithmetic);
  if (digits > 0) return times_power_of_ten(factor, 1 - digits);
  if (request.arithmetic != "lattice") return factor * epsilon;
  const auto over = [](double unit, double size) { return size > 0 ? unit / size : 0; };
  return factor *
         std::max({epsilon, over(request.position_unit, way.q_size()), over(request.momentum_unit, way.p_size())});
}

std::string brief(const LongNumber& x) { return x.text.empty() ? fmt::format("{:.1e}", x.value) : x.text; }

/// Whether a motion begins on a hard wall, to rounding. There it comes back to the wall with the momentum of before or
/// behind the bounce, which of them decides the last bit of the time.
bool begins_on_a_wall(const Request& request, const Frame& start, double size) {
  const auto walls = walls_among(request.variant);
  if (!walls || !walls->hard()) return false;
  const auto sides = wall_sides<double>(*walls);
  return std::any_of(sides.begin(), sides.end(), [&](const WallSide<double>& side) {
    return std::abs(side.beyond(start.q[side.coordinate])) <= 8 * epsilon * std::max(size, std::abs(side.at));
  });
}

/// Why what rounding becomes is not known; empty where small differences grow in proportion to themselves, as those of
/// every motion do that depends on its start smoothly. Where a force jumps between two motions that are close, one of
/// them takes a kick that the other does not, however close they are. A rounding then does as much as the move here.
/// Bodies of unlike masses part by unlike factors in unlike directions: what is not in proportion to the first move is
/// compared with a larger move in its own direction. The furthest that is seen is then what rounding may become.
/// @param apart how the first move parts; becomes the furthest parting seen
std::string out_of_proportion(const Request& request, const Reversal& reversal, const Waypoints& way, Parting& apart,
                              const GoOn& go_on) {
  const auto alike = [](const Parting& nearer, const Parting& wider) {
    const double ratio = nearer.root_mean_square / wider.root_mean_square;
    return ratio <= in_proportion && ratio * in_proportion >= 1;
  };
  const char* const unmeasured = "but how far rounding is carried could not be measured";
  for (const double sign : {1.0, -1.0}) {
    const Parting nearer = parting(request, reversal, way, go_on, {sign * moved_less, 3, true});
    if (!nearer.measured) return unmeasured;
    if (alike(nearer, apart)) continue;
    if (reversal.distance.value > beyond * std::max(apart.furthest, nearer.furthest)) continue;  // no jump did that
    const Parting wider = parting(request, reversal, way, go_on, {sign * moved, 3, true});
    if (!wider.measured) return unmeasured;
    if (alike(nearer, wider)) {
      apart.root_mean_square = std::max(apart.root_mean_square, wider.root_mean_square);
      apart.furthest = std::max(apart.furthest, wider.furthest);
      continue;
    }
    return fmt::format(
        "but what rounding becomes is not known: motions that begin {:.1e} apart part by {:.1e}, those that begin "
        "{:.1e} apart in the same direction by {:.1e}, which is not in proportion, as where a force jumps and a "
        "rounding decides on which side it is taken",
        moved * std::max(way.q_size(), way.p_size()), wider.furthest, moved_less * std::max(way.q_size(), way.p_size()),
        nearer.furthest);
  }
  return {};
}

/// What is proved, and why.
std::pair<ReversalProof, std::string> judged(const Request& request, const ProblemEntry& problem,
                                             const Reversal& reversal, const Waypoints& way, double scale,
                                             double actions, const GoOn& go_on) {
  const MethodInfo method = describe(request.method);
  const Frame* const states[] = {&reversal.start, &reversal.turn};
  if (!even_in_momenta(problem, request.parameters, states, scale)) {
    return {ReversalProof::nothing,
            "H(q, -p) is another H than H(q, p): the motion itself is not reversed by negating the momenta"};
  }
  if (reversal.bit_exact) {
    if (method.reversible) return {ReversalProof::every_bit, "every bit came back"};
    return {ReversalProof::nothing,
            "every bit came back, but " + method.name + " is not reversible: its defect is below rounding"};
  }
  Parting apart = parting(request, reversal, way, go_on);
  const double size = std::max(way.q_size(), way.p_size());
  if (!apart.measured) return {ReversalProof::nothing, "how far rounding is carried could not be measured"};
  const auto parts_too_far = [&] {
    return fmt::format(
        "{} off, but motions that begin close to each other part by a factor of {:.0e}: what rounding "
        "becomes is not known",
        brief(reversal.distance), apart.furthest / (moved * size));
  };
  if (apart.furthest > parted * size) return {ReversalProof::nothing, parts_too_far()};
  if (reversal.distance.text.empty() && reversal.distance.value == 0 && method.reversible) {
    return {ReversalProof::to_rounding,
            "q and p came back with every digit, but not the sign of a zero or what the steps carry beside them"};
  }
  Parting nothing_grows = apart;  // what is below the bound of such a motion needs no other one
  nothing_grows.root_mean_square = std::min(apart.root_mean_square, size);
  if (!at_most(reversal.distance, explained_by_rounding(request, reversal, nothing_grows, way, actions))) {
    const std::string unknown = out_of_proportion(request, reversal, way, apart, go_on);
    if (!unknown.empty()) return {ReversalProof::nothing, brief(reversal.distance) + " off, " + unknown};
    if (apart.furthest > parted * size) return {ReversalProof::nothing, parts_too_far()};
  }
  const LongNumber rounding = explained_by_rounding(request, reversal, apart, way, actions);
  const std::string explained =
      fmt::format("{} off, of which rounding explains {}", brief(reversal.distance), brief(rounding));
  if (!at_most(reversal.distance, rounding)) {
    if (method.reversible &&
        at_most(reversal.distance, explained_by_rounding(request, reversal, apart, way, actions, beyond))) {
      return {
          ReversalProof::nothing,
          explained + fmt::format(", and less than {:g} times that is no proof: a stiff step rounds by more than is "
                                  "estimated, and an arithmetic of more digits would tell",
                                  beyond)};
    }
    if (!begins_on_a_wall(request, reversal.start, size)) return {ReversalProof::not_reversible, explained};
    return {ReversalProof::nothing, explained +
                                        ", but the motion begins on a wall, where the state before the bounce "
                                        "and that behind it are one"};
  }
  if (rounding.value > parted * size) return {ReversalProof::nothing, explained + ", which is too much to tell"};
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

}  // namespace

bool depends_on_time(const ProblemEntry& problem) { return problem.structure && problem.structure->time; }

bool even_in_momenta(const ProblemEntry& problem, const Texts& parameters, std::span<const Frame* const> states,
                     double scale) {
  const Texts all = complete(problem.info, parameters);
  return std::all_of(states.begin(), states.end(), [&](const Frame* frame) {
    std::vector<double> p = frame->p;
    for (double& x : p) x = -x;
    return std::abs(problem.energy(all, frame->q, frame->p) - problem.energy(all, frame->q, p)) <= 64 * epsilon * scale;
  });
}

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
  const double at_least = std::min(period ? std::ceil(*period) : 1000.0, 1000.0);
  auto simulation = simulation_beside_the_run(request);
  Frame start;
  simulation->look(start);
  const auto most = static_cast<std::int64_t>(1e8 / static_cast<double>(std::max<std::size_t>(1, start.q.size())));
  found.steps = std::max(steps_taken / 200, static_cast<std::int64_t>(at_least));
  const bool walled = has_hard_walls(request);
  if (walled) found.steps = std::max(found.steps, first_bounce(request, std::min(steps_taken, most), go_on));
  found.steps = std::max<std::int64_t>(1, std::min({found.steps, steps_taken, most}));
  found.share = static_cast<double>(found.steps) / static_cast<double>(steps_taken);

  simulation->tell_bounces([&](const Bounce& bounce) { found.bounces += bounce.step <= found.steps ? 1 : 0; });
  Waypoints way(found.steps, start.q.size());
  Observer* const watch[] = {&way};
  Reversal reversal;
  if (go_on()) reversal = reverse(*simulation, found.steps, pulse_of(go_on), watch);
  if (!stopped && reversal.outcome != Outcome::done) {
    found.reason = "a step of the way there or back failed: " +
                   (reversal.failure.empty() ? std::string(message(reversal.outcome)) : reversal.failure);
  } else if (!stopped) {
    found.distance = reversal.distance;
    found.relative = reversal.relative_distance;
    found.bit_exact = reversal.bit_exact;
    const Effort effort = simulation->effort();
    const double actions =
        std::max(1.0, static_cast<double>(effort.force + effort.gradient) / static_cast<double>(2 * found.steps));
    const double scale = simulation->energy_scale();
    simulation.reset();  // another one is made, and two of a million particles need not have their lists at a time
    reversal.end = {};
    std::tie(found.proves, found.reason) = judged(request, problem, reversal, way, scale, actions, go_on);
  }
  if (stopped) {
    ReversalEvidence none;
    none.was_stopped = true;
    none.reason = "the reversal was left out: it was stopped before it had come to its end";
    return none;
  }
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
