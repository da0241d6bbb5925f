// Block means of kinetic energies over long runs of many starts of the T-tube. Experiments use them for the late,
// regular motion of [Sonnleitner2010], ch. 3b, with one criterion that was fixed before any run, and for long averages.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "t_tube_runs.hpp"

namespace hamflow::reproduction {

inline constexpr std::int64_t tube_block = 1000000;  // steps
inline constexpr std::size_t tube_least_blocks = 20;

struct TubeStart {
  double eps = 0.6;
  double q1 = 0.01;
  double v1 = 0;
};
/// Returns `number` starts, half of them with eps = 0.6 and half with -0.6. Every 32 starts of one eps are 14 at
/// +-0.6I, 1e-9/64 apart, 4 with v = (1, 1), 2 at III, 2 at IV, and 10 with v = (0, 1) at q1 from -0.9 to 0.9.
std::vector<TubeStart> tube_starts(int number);

/// The settings that all runs of a set share.
struct TubeSet {
  TubeRun run;                      // rule, method and dt
  std::vector<std::string> sets{};  // PATH=VALUE
  std::size_t blocks = 0;
  double most_energy_error = 1e300;  // relative to the energy at the start; a run with a larger error stops
  std::int64_t block = tube_block;   // steps
  bool both_bodies = false;          // whether to record kinetic2 of the heavy body, too
};

/// The results for one start.
struct TubeWatch {
  TubeStart start;
  std::vector<double> blocks;  // means of kinetic1
  std::vector<double> heavy;   // means of kinetic2, with TubeSet::both_bodies
  std::int64_t bounces = 0;
  double energy_error = 0;               // largest at the ends of blocks, relative to the energy at the start
  bool stopped = false;                  // too large an energy error, or through a soft wall
  std::vector<double> q, p;              // at the end
  std::vector<std::int64_t> two_to_one;  // the steps that find_two_to_one() found
};

/// A motion that becomes regular with the rule "reject" within late_blocks. It begins at one of tube_starts(512);
/// `start` is its number among the starts with this eps. Experiments test whether it is regular.
struct LateMotion {
  const char* name;
  double eps;
  std::size_t start;
  std::vector<double> q, p;  // after late_blocks
};
inline constexpr std::size_t late_blocks = 12;
/// Runs the starts to their late motions, and stores their scenarios as late_NAME.   @throws Stopped
std::vector<LateMotion> late_motions(Study& study);

/// Runs all starts, in SIMD lanes if the method allows. The results of every 32 starts are stored in the folder of the
/// experiment as NAME_FIRST.json, from which a killed experiment continues.   @throws Stopped
std::vector<TubeWatch> watch_tubes(const Study& study, const std::string& name, const TubeSet& set,
                                   std::span<const TubeStart> starts);

/// Returns the first block from which the motion is regular: from there to the end, at least 20 blocks, the standard
/// deviation of the means is below 1e-3 of the one before. Returns 0 if there is none.
std::size_t regular_from(const std::vector<double>& blocks);

/// Runs one start again over `blocks` blocks, with the rule "reject". Stores the steps of those rejections whose image
/// R z has a second preimage, because Psi_-h(R z) is in the domain.   @throws Stopped
void find_two_to_one(const Study& study, const TubeSet& set, TubeWatch& watch, std::size_t blocks);

/// Returns the scenario of a start, with all digits. @param q, p another state to begin at; may be empty
std::string scenario_of_start(const TubeSet& set, const TubeStart& start, std::int64_t steps,
                              const std::vector<double>& q = {}, const std::vector<double>& p = {});

/// Returns the step Psi_h of the method without walls, for m = (1, 100).
std::unique_ptr<StepMap> free_tube_step(const TubeRun& run);

}  // namespace hamflow::reproduction
