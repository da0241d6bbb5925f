// Runs of the gas for the experiments of [Sonnleitner2010], ch. 3a: side x side particles in a circle with a soft wall.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "hamflow/figures/panel_axes.hpp"
#include "study.hpp"

namespace hamflow::reproduction {

struct GasRun {
  int side = 11;
  std::string start = "lattice";
  std::string scale = "per-side";
  std::string dt = "0.0001";
  int exponent = 1;
  std::int64_t steps = 200;
  std::string arithmetic = "double";
  int seed = 1;
  std::int64_t record_every = 0;  // 0: only the end

  int particles() const { return side * side; }
  /// The scale S. For "listing" it is computed with the number of all particles in place of the number of one side.
  double scale_number() const;
};
std::string name_of(const GasRun& run);
std::string gas_scenario(const GasRun& run);

/// The result of a reversal: distances from the start in the norm of the listing (page 72), sqrt(sum |difference|^2)/N.
struct Return {
  bool done = false;
  std::int64_t failed_at = 0;  // the step that failed, counted over both directions
  std::string message;
  double position = 0;
  double momentum = 0;
  double digits_lost = 0;
  bool bit_exact = false;
  double pair_evaluations = 0;
  Frame start, turn, end;
};
Return there_and_back(Study& study, const GasRun& run);

/// Measures the decimal digits of an arithmetic with runs: the smallest power of 1/2 that a free motion can add to 1.
double digits_of(Study& study, const std::string& arithmetic);

/// The largest distance between two places of one particle. @param a, b x and y of each particle
double farthest(const std::vector<double>& a, const std::vector<double>& b);

/// Particles to be drawn as marks: x and y of each in turn.
struct Places {
  std::string name;
  std::vector<double> xy;
  std::string colour;
  int shape = 7;  // see figures::Mark
};
figures::Panel places(const std::string& x_label, const std::string& y_label, const std::vector<Places>& all);

}  // namespace hamflow::reproduction
