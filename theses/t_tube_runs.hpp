// Runs of the T-tube for the experiments of [Sonnleitner2010], ch. 3b: m = (1, 100), Q = (0.01, 1.1), hard walls.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "study.hpp"

namespace hamflow::reproduction {

struct TubeRun {
  double eps = -0.6;
  std::string v1 = "0";  // start velocity of the light body; that of the heavy one is v2
  std::string rule = "reject";
  std::string method = "stv4";
  std::string dt = "0.01";
  std::int64_t steps = 0;
  std::int64_t record_every = 0;  // 0: the end only
  std::string v2 = "1";
};
/// "-0.6 v=(6,1) reject stv4 0.01"
std::string name_of(const TubeRun& run);
std::string tube_scenario(const TubeRun& run);
/// @param start as in problem.initial, e.g. "q = [0.01, 1.1], v = [0, 1]"
std::string tube_scenario_from(const TubeRun& run, const std::string& start);

/// What came of a member of an ensemble.
struct TubeMember {
  bool done = false;
  double kinetic1 = 0;  // at the start
  double kinetic2 = 0;
  double change1 = 0;  // mean over every step minus that of the start
  double change2 = 0;
  double energy_error = 0;  // the largest, of the scale
  std::vector<double> q;    // at the end
  std::vector<double> p;
};
/// @param varied as in SweepRequest   @throws Stopped
std::vector<TubeMember> ensemble(Study& study, const TubeRun& run, const std::vector<std::string>& varied);
/// As many steps more, from where the members ended; their places are kept, and those that were not done are not.
/// Changes are against the start of these steps.   @throws Stopped
std::vector<TubeMember> continued(Study& study, const TubeRun& run, const std::vector<TubeMember>& members);

/// Mean and standard deviation of a number of the members that are done.
struct Spread {
  double mean = 0;
  double deviation = 0;
  int members = 0;
  double standard_error() const;
};
Spread spread_of(const std::vector<double>& numbers);

}  // namespace hamflow::reproduction
