// Experiments. A file of experiments/, for example kepler_orbits.cpp, defines `kepler_orbits_experiments()`. Its other
// names are in the namespace `kepler_orbits`, because several files are compiled as one.
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
  /// The text of its source file. If it changes, the experiment runs again.
  std::string source{};
};

/// The experiments of all files, in the order of the theses.
const std::vector<Experiment>& all_experiments();
/// @throws Error if no experiment has this ID
const Experiment& experiment_of(const std::string& id);

/// An experiment for drawings of a thesis, which contain nothing to measure.
Experiment drawing(const char* thesis, const std::string& id, const std::string& page, const std::string& title);

}  // namespace hamflow::reproduction
