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
  std::int64_t record_every = 0;  // 0: the end only

  int particles() const { return side * side; }
  /// S; "listing" takes the number of particles for that of a side.
  double scale_number() const;
};
std::string name_of(const GasRun& run);
std::string gas_scenario(const GasRun& run);

/// What came back of a start, in the measure of the listing, page 72: sqrt(sum |difference|^2)/N.
struct Return {
  bool done = false;
  std::int64_t failed_at = 0;  // the step that was not taken, of those there and back
  std::string message;
  double position = 0;
  double momentum = 0;
  double digits_lost = 0;
  bool bit_exact = false;
  double pair_evaluations = 0;
  Frame start, turn, end;
};
Return there_and_back(Study& study, const GasRun& run);

/// Decimal digits of an arithmetic, as its runs have them: of the powers of 1/2, the last that a free motion still
/// adds to 1.
double digits_of(Study& study, const std::string& arithmetic);

/// How far the particle that moved farthest is from its start. @param a, b x, y of each
double farthest(const std::vector<double>& a, const std::vector<double>& b);

/// x, y of particles that stand one after the other, as marks.
struct Places {
  std::string name;
  std::vector<double> xy;
  std::string colour;
  int shape = 7;  // as of a Mark
};
figures::Panel places(const std::string& x_label, const std::string& y_label, const std::vector<Places>& all);

}  // namespace hamflow::reproduction
