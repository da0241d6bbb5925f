// Runs of the T-tube for the experiments of [Sonnleitner2010], ch. 3b: m = (1, 100), Q = (0.01, 1.1), hard walls.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "study.hpp"

namespace hamflow::reproduction {

struct TubeRun {
  double eps = -0.6;
  std::string v1 = "0";  // velocity of the light body at the start; v2 is the velocity of the heavy one
  std::string rule = "reject";
  std::string method = "stv4";
  std::string dt = "0.01";
  std::int64_t steps = 0;
  std::int64_t record_every = 0;  // 0: only the end
  std::string v2 = "1";
};
/// Returns a name such as "-0.6 v=(6,1) reject stv4 0.01".
std::string name_of(const TubeRun& run);
std::string tube_scenario(const TubeRun& run);
/// @param start the keys of problem.initial, e.g. "q = [0.01, 1.1], v = [0, 1]"
std::string tube_scenario_from(const TubeRun& run, const std::string& start);

/// The result of a member of an ensemble.
struct TubeMember {
  bool done = false;
  double kinetic1 = 0;  // at the start
  double kinetic2 = 0;
  double change1 = 0;  // mean of kinetic1 over all steps, minus its value at the start
  double change2 = 0;
  double energy_error = 0;  // the largest, divided by the scale
  std::vector<double> q;    // at the end
  std::vector<double> p;
};
/// Runs an ensemble.   @param varied see SweepRequest   @throws Stopped
std::vector<TubeMember> ensemble(Study& study, const TubeRun& run, const std::vector<std::string>& varied);
/// Continues the members of an ensemble for as many steps again. The order of the members is kept. Members that were
/// not done stay so. Changes are relative to the start of the continuation.   @throws Stopped
std::vector<TubeMember> continued(Study& study, const TubeRun& run, const std::vector<TubeMember>& members);

/// The mean and the standard deviation of numbers, one for each member that is done.
struct Spread {
  double mean = 0;
  double deviation = 0;
  int members = 0;
  double standard_error() const;
};
Spread spread_of(const std::vector<double>& numbers);

}  // namespace hamflow::reproduction
