// One experiment. A file of experiments/, say kepler_orbits.cpp, defines `kepler_orbits_experiments()`; its other names
// stand in the namespace `kepler_orbits`, since several files are compiled as one.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "claim.hpp"
#include "reproduce.hpp"
#include "study.hpp"

namespace hamflow::reproduction {

inline const char* const gross = "Gross";
inline const char* const sonnleitner = "Sonnleitner";

struct Experiment {
  ExperimentInfo info;
  std::function<void(Study&)> carry_out;
  /// Of the file that it stands in: an experiment that was changed is carried out again.
  std::string source{};
};

/// Those of all files, in the order of the theses.
const std::vector<Experiment>& all_experiments();
/// @throws Error where there is none of that ID
const Experiment& experiment_of(const std::string& id);

/// The drawings of a thesis, of which there is nothing to measure.
Experiment drawing(const char* thesis, const std::string& id, const std::string& page, const std::string& title);

}  // namespace hamflow::reproduction
