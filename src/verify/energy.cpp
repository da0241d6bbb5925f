#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "drift_class.hpp"
#include "hamflow/core/math.hpp"
#include "hamflow/verify/measure.hpp"
#include "measuring_stopped.hpp"
#include "rounding.hpp"

namespace hamflow {

namespace {
constexpr std::uint64_t starts = 32;  // with 32 starts the growth exponent of a random walk is known to about 0.06
constexpr int coarse_blocks = 511;    // nine dyadic windows
constexpr std::int64_t block_steps = 64;
constexpr int fine_factor = 128;
constexpr int fine_blocks = 31;
constexpr std::int64_t fine_block_steps = 1024;

/// Returns the energy error that rounding explains. H is evaluated from rounded coordinates, which costs a few units.
/// The increment of a step is rounded relative to itself, h |v F| eps, and these errors add up like the square root of
/// their number. 16 units of each are allowed. Forces are taken to change the energy by its own size within eight steps
/// of the region, a sixth of a period.
double rounding_level(const Region& region, double h, double steps) {
  return 16 * epsilon * (1 + h / (8 * region.step) * std::sqrt(steps));
}

double scale(const StepMap& map, const Region& region) {
  double largest = 0;
  for (std::uint64_t k = 0; k < starts; ++k) largest = larger(largest, map.energy_scale(random_state(region, k)));
  return largest;
}

/// Returns max |H - H0|; infinite if a run broke down.
double largest_error(const std::vector<double>& energies, std::size_t expected) {
  if (energies.size() < expected) return std::numeric_limits<double>::infinity();
  double largest = 0;
  for (double h : energies) {
    const double error = abs(h - energies.front());
    if (!(error <= std::numeric_limits<double>::max())) return std::numeric_limits<double>::infinity();
    largest = larger(largest, error);
  }
  return largest;
}

/// Counts runs with a given number of blocks, and those that ended early.
struct CompletedRuns {
  int runs = 0;
  int early = 0;
  std::size_t first = 0;  // number of blocks of the shortest run
  bool finite = true;

  void look(const std::vector<double>& energies, std::size_t expected) {
    ++runs;
    const bool whole = energies.size() >= expected;
    const bool ends_finite = std::all_of(energies.begin(), energies.end(), [](double h) { return std::isfinite(h); });
    finite = finite && ends_finite;
    if (whole && ends_finite) return;
    first = early == 0 ? energies.size() - 1 : std::min(first, energies.size() - 1);
    ++early;
  }
  std::string interruption(std::int64_t per_block, std::size_t expected, double h) const {
    if (early == 0) return {};
    const auto steps = [&](std::size_t blocks) { return static_cast<std::int64_t>(blocks) * per_block; };
    return fmt::format("{} of {} runs with step {:.3g} {}, the shortest within {} steps after step {} of {}", early,
                       runs, h,
                       finite ? "ended early, because a step failed or was not finite" : "were no longer finite",
                       per_block, steps(first), steps(expected - 1));
  }
};

/// Returns the energy error over a fixed time of 128 steps of the region, sampled once in each of these steps whatever
/// h is.
double short_level(const StepMap& map, const Region& region, double h) {
  const auto per_look = std::max<std::int64_t>(1, std::llround(region.step / h));
  const int looks = static_cast<int>(std::lround(128 * region.step / (static_cast<double>(per_look) * h)));
  double largest = 0;
  for (std::uint64_t k = 0; k < 4; ++k) {
    const auto energies = map.energies(random_state(region, k), h, looks, per_look);
    largest = larger(largest, largest_error(energies, static_cast<std::size_t>(looks) + 1));
  }
  return largest;
}

/// Returns the step size with which the energy error is measured, normally that of the region. For an implicit method
/// of high order that does not claim to conserve the energy, the defect may be below rounding at that step size. Then
/// the first of twice, four times, .. 16 times that step size (a third of a period) is taken at which a defect shows.
/// With larger steps, Newton's iteration may find roots from which orbits escape.
double energy_test_step(const StepMap& map, const Region& region, double unit) {
  const MethodInfo claims = map.claims();
  if (claims.explicit_step || claims.energy_conserving != Conservation::no) return region.step;
  for (int k = 0; k <= 4; ++k) {
    throw_if_stopped();
    const double h = std::ldexp(region.step, k);
    const double level = short_level(map, region, h) / unit;
    if (!(level < 1)) break;  // this step is too large
    if (level > 0x1p10 * rounding_level(region, h, 128 * region.step / h)) return h;
  }
  return region.step;
}

/// Returns the exponent of the energy error in h, from the four smallest step sizes between 4 h and h/8 at which the
/// error is above rounding.
double step_exponent(const StepMap& map, const Region& region, double telling, double unit) {
  std::vector<double> log_step;
  std::vector<double> log_level;
  for (int k = 2; k >= -3; --k) {
    throw_if_stopped();
    const double h = std::ldexp(telling, k);
    const double level = short_level(map, region, h) / unit;
    if (!(level < 1)) continue;  // this step is too large
    if (level < 16 * rounding_level(region, h, 128 * region.step / h))
      break;  // the error has less than four binary digits above rounding
    log_step.push_back(std::log2(h));
    log_level.push_back(std::log2(level));
  }
  const std::size_t surplus = log_step.size() > 4 ? log_step.size() - 4 : 0;
  log_step.erase(log_step.begin(), log_step.begin() + static_cast<std::ptrdiff_t>(surplus));
  log_level.erase(log_level.begin(), log_level.begin() + static_cast<std::ptrdiff_t>(surplus));
  return log_step.size() < 2 ? std::numeric_limits<double>::quiet_NaN() : fitted_slope(log_step, log_level);
}

/// Returns H after each block. If the length of a block is nearly a multiple of the period, the orbit is sampled at a
/// phase that moves slowly, and its bounded oscillation looks like a drift. Blocks of another length show a real drift
/// again, but not an oscillation.
std::vector<double> watched(const StepMap& map, const State<double>& z, double h) {
  constexpr std::int64_t other_steps = 59;  // a prime number
  std::vector<double> energies = map.energies(z, h, coarse_blocks, block_steps);
  const auto drifts = [](const std::vector<double>& series) {
    return series.size() == coarse_blocks + 1 &&
           increments_p_value(series) * static_cast<double>(starts) < DriftStatistics::level;
  };
  if (!drifts(energies)) return energies;
  std::vector<double> others = map.energies(z, h, coarse_blocks, other_steps);
  return others.size() == energies.size() && !drifts(others) ? others : energies;
}
}  // namespace

EnergyMeasurement measure_energy(const StepMap& map, const Region& region) {
  EnergyMeasurement found;
  const double unit = scale(map, region);
  const double h = energy_test_step(map, region, unit);
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::vector<double>> energies;
  CompletedRuns ended;
  for (std::uint64_t k = 0; k < starts; ++k) {
    throw_if_stopped();
    energies.push_back(watched(map, random_state(region, k), h));
    ended.look(energies.back(), coarse_blocks + 1);
    found.level = larger(found.level, largest_error(energies.back(), coarse_blocks + 1) / unit);
  }
  // A run with an explicit step ends early only if its numbers become infinite, so its energy was not conserved.
  const bool leaves = map.claims().explicit_step;
  const double early_level = leaves ? std::numeric_limits<double>::infinity() : unknown;
  if (ended.early > 0) found.level = early_level;
  found.reason = ended.interruption(block_steps, coarse_blocks + 1, h);
  found.step = h;
  found.rounding = rounding_level(region, h, static_cast<double>(coarse_blocks * block_steps));
  found.drift = classify_drift(energies);
  if (leaves && !found.drift.drift) found.drift = {0, std::numeric_limits<double>::infinity(), DriftClass::linear};

  const double fine_step = region.step / fine_factor;
  CompletedRuns fine_ended;
  for (std::uint64_t k = 0; k < starts / 4; ++k) {  // a few starts are enough for a level
    throw_if_stopped();
    const auto fine = map.energies(random_state(region, k), fine_step, fine_blocks, fine_block_steps);
    fine_ended.look(fine, fine_blocks + 1);
    found.fine_level = larger(found.fine_level, largest_error(fine, fine_blocks + 1) / unit);
  }
  if (fine_ended.early > 0) found.fine_level = early_level;
  if (found.reason.empty()) found.reason = fine_ended.interruption(fine_block_steps, fine_blocks + 1, fine_step);
  found.fine_rounding = rounding_level(region, fine_step, static_cast<double>(fine_blocks * fine_block_steps));
  found.step_exponent = step_exponent(map, region, h, unit);
  return found;
}

std::optional<Conservation> EnergyMeasurement::conserving(int order, bool even_in_momenta) const {
  if (!drift.drift || std::isnan(level)) return std::nullopt;
  if (level <= rounding) {
    if (std::isnan(fine_level) && drift.drift != DriftClass::linear) return std::nullopt;
    return fine_level <= fine_rounding && drift.drift != DriftClass::linear ? Conservation::yes : Conservation::no;
  }
  // A method of order r without any conservation has a level ~ h^r; cg(k) with s > k quadrature points has h^(2 s),
  // where 2 s >= r + 2. If H is even in p, the error of the quadrature has no preferred direction, because it cancels
  // in a reversal. Growth with time is not judged here: near a resonance and in chaos the error does grow.
  if (even_in_momenta && drift.p_value < DriftStatistics::level) return Conservation::no;
  return step_exponent >= order + 1.5 ? Conservation::up_to_quadrature : Conservation::no;
}

}  // namespace hamflow
