// The T-tube watched through long runs of many starts at once, as block means of kinetic energies: for the late,
// regular motion of [Sonnleitner2010], ch. 3b, by one rule for all of them, fixed before any run, and for its long
// averages.
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
/// So many starts, half of them with eps = 0.6 and half with -0.6. Of 32: 14 at +-0.6I, which part by 1e-9/64, 4 with
/// v = (1, 1), 2 at III, 2 at IV, and 10 with v = (0, 1) at q1 from -0.9 to 0.9.
std::vector<TubeStart> tube_starts(int number);

/// How the runs of a set are carried out.
struct TubeSet {
  TubeRun run;                      // rule, method and dt
  std::vector<std::string> sets{};  // PATH=VALUE
  std::size_t blocks = 0;
  double most_energy_error = 1e300;  // of the start's; a run beyond it is stopped
  std::int64_t block = tube_block;   // steps
  bool both_bodies = false;          // the heavy one's kinetic energy, too
};

/// What is seen of one start.
struct TubeWatch {
  TubeStart start;
  std::vector<double> blocks;  // means of kinetic1
  std::vector<double> heavy;   // and of kinetic2, where both are asked for
  std::int64_t bounces = 0;
  double energy_error = 0;               // at the ends of blocks, of the start's
  bool stopped = false;                  // beyond the energy error allowed, or through a soft wall
  std::vector<double> q, p;              // at the end
  std::vector<std::int64_t> two_to_one;  // of a captured one, by find_two_to_one()
};

/// A motion that the rule "reject" has caught within late_blocks: of one of tube_starts(512), by its number among those
/// of its eps. That it is regular is what experiments find, not what this says.
struct LateMotion {
  const char* name;
  double eps;
  std::size_t start;
  std::vector<double> q, p;  // behind late_blocks
};
inline constexpr std::size_t late_blocks = 12;
/// Runs there, and keeps their scenarios as late_NAME.   @throws Stopped
std::vector<LateMotion> late_motions(Study& study);

/// All of them, in SIMD lanes where the method goes there. What is seen of every 32 is kept in the experiment's folder
/// as NAME_FIRST.json: an experiment that was killed takes it from there.   @throws Stopped
std::vector<TubeWatch> watch_tubes(const Study& study, const std::string& name, const TubeSet& set,
                                   std::span<const TubeStart> starts);

/// The first block from which on, to the end, the means scatter by less than 1e-3 of what they did before, for at least
/// 20 blocks; 0: there is none.
std::size_t regular_from(const std::vector<double>& blocks);

/// Runs the start again by itself, with the rule "reject", through so many blocks, and keeps the steps of rejections
/// whose image R z has a second preimage: where Psi_-h(R z) lies inside.   @throws Stopped
void find_two_to_one(const Study& study, const TubeSet& set, TubeWatch& watch, std::size_t blocks);

/// The scenario of a start with all digits. @param q, p where it begins instead, if given
std::string scenario_of_start(const TubeSet& set, const TubeStart& start, std::int64_t steps,
                              const std::vector<double>& q = {}, const std::vector<double>& p = {});

/// The step Psi_h of the run's method without walls, m = (1, 100).
std::unique_ptr<StepMap> free_tube_step(const TubeRun& run);

}  // namespace hamflow::reproduction
