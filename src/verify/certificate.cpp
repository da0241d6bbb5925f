#include "hamflow/verify/certificate.hpp"

#include <algorithm>
#include <cmath>

#include "hamflow/verify/counter_random.hpp"
#include "rounding.hpp"

namespace hamflow {

namespace {
constexpr std::uint64_t seed = 1686;  // any number: the places of the samples are part of the result

/// In the first half of the k-th block, where it still is when two blocks become one.
std::int64_t place(std::int64_t k, std::int64_t block_steps) {
  const std::int64_t room = std::max<std::int64_t>(1, block_steps / 2);
  if (k == 0) return 0;
  const auto random = counter_bits(seed, static_cast<std::uint64_t>(k));
  return k * block_steps + static_cast<std::int64_t>(random % static_cast<std::uint64_t>(room));
}

double largest(const std::vector<double>& xs) {
  double most = 0;
  for (const double x : xs) most = std::max(most, std::abs(x));
  return most;
}
double sum_of_sizes(const std::vector<double>& xs) {
  double sum = 0;
  for (const double x : xs) sum += std::abs(x);
  return sum;
}
}  // namespace

std::int64_t EnergyBlocks::next_due(std::int64_t step) const { return std::max(step, state_.next); }

Verdict EnergyBlocks::observe(const Frame& frame) {
  if (frame.step < state_.next) return Verdict::go_on;
  auto& energies = state_.energies;
  energies.push_back(frame.energy);
  const double p_sum = sum_of_sizes(frame.p);
  const double sizes[] = {largest(frame.q), largest(frame.p), p_sum, sum_of_sizes(frame.q) * largest(frame.p)};
  for (std::size_t i = 0; i < 4; ++i) state_.magnitudes[i] = std::max(state_.magnitudes[i], sizes[i]);
  if (energies.size() > most_blocks) {
    for (std::size_t i = 0; 2 * i < energies.size(); ++i) energies[i] = energies[2 * i];
    energies.resize((energies.size() + 1) / 2);
    state_.block_steps *= 2;
  }
  state_.next = place(static_cast<std::int64_t>(energies.size()), state_.block_steps);
  return Verdict::go_on;
}

/// Each kick and each drift rounds a position or a momentum once, by half a unit at most, which moves an invariant with
/// terms of size T by about epsilon T; n roundings walk sqrt(n) of them, and reading the invariant rounds a few times.
/// 16 of each: the largest of a walk over the whole run is rarely above four standard deviations, and two coordinates
/// of a body, or two bodies, are rounded in every action. The centre of mass takes the walk of the momentum along for
/// the time of the run.
std::vector<MomentumMap> momentum_maps(const Simulation& simulation, const ProblemEntry& problem,
                                       const std::vector<double>& magnitudes, const Request& request) {
  std::vector<MomentumMap> all;
  const std::vector<InvariantExcursion> invariants = simulation.invariants();
  const Effort effort = simulation.effort();
  const double roundings =
      std::max(static_cast<double>(effort.force + effort.gradient), static_cast<double>(simulation.step()));
  const double walk = 16 * (1 + std::sqrt(roundings));
  const int digits = digits_beyond_double(request.arithmetic);
  const double unit = digits > 0 ? std::pow(10.0, 1 - digits) : epsilon;
  const bool lattice = request.arithmetic == "lattice";
  const double q_unit = std::max(unit, lattice ? request.position_unit / std::max(magnitudes[0], 1e-300) : 0);
  const double p_unit = std::max(unit, lattice ? request.momentum_unit / std::max(magnitudes[1], 1e-300) : 0);
  const std::vector<InvariantInfo>& infos = problem.info.invariants;
  Frame end;
  simulation.look(end);
  for (std::size_t i = 0; i < invariants.size() && i < infos.size(); ++i) {
    MomentumMap map{infos[i].name, invariants[i].max_error, 0, {}};
    double size = largest(invariants[i].initial);
    switch (infos[i].terms) {
      case Terms::moments:
        size = std::max(size, magnitudes[3]);
        map.rounding = walk * (q_unit + p_unit) * size;
        break;
      case Terms::momentum:
        map.rounding = walk * p_unit * size;
        break;
      case Terms::momenta:
        size = std::max(size, magnitudes[2]);
        map.rounding = walk * p_unit * size;
        break;
      case Terms::centre_of_mass: {
        if (!problem.total_mass) break;
        const double mass = problem.total_mass(complete(problem.info, request.parameters), end.q.size());
        size = std::max(size, magnitudes[0]);
        map.rounding = walk * (q_unit * size + p_unit * magnitudes[2] / mass * std::abs(end.time));
        break;
      }
      case Terms::other:
        break;
    }
    map.relative = size > 0 ? map.max_error / size : map.max_error;
    all.push_back(map);
  }
  return all;
}

RunCertificate certify(const Request& request, const ProblemEntry& problem, const Simulation& simulation,
                       const EnergyBlocks& blocks, std::int64_t steps_taken) {
  RunCertificate found;
  found.drift = blocks.drift();
  const double scale = simulation.energy_scale();
  const double error = simulation.energy().max_error;
  found.energy_level = scale > 0 ? error / scale : error;
  found.momentum_maps = momentum_maps(simulation, problem, blocks.state().magnitudes, request);
  if (steps_taken > 0) {  // there and back together a hundredth of the run
    found.reversal = reversal_of(request, std::clamp<std::int64_t>(steps_taken / 200, 1, 1000));
  }
  return found;
}

}  // namespace hamflow
