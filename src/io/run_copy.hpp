// A run.h5 with other coordinates: everything is copied but the scenario, the names of coordinates, /q, /p and /digits.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "run_file.hpp"

namespace hamflow {

/// What differs. As in RunSamples q[i][k] is coordinate i at sample k.
struct ConvertedStates {
  std::string scenario;
  std::vector<std::string> coordinates;  // names
  std::vector<std::string> momenta;
  std::vector<std::vector<double>> q;
  std::vector<std::vector<double>> p;
  RunDigits digits;               // all of them; empty of a run in double
  std::size_t digits_length = 0;  // characters of each
};

/// @param source may also be a run that goes on or was cut short   @param target is replaced when it exists
/// @throws FileError
void copy_run_file(const std::filesystem::path& source, const std::filesystem::path& target,
                   const ConvertedStates& states);

}  // namespace hamflow
