// A run.h5 with other coordinates: everything is copied but the scenario, the names of coordinates, /q, /p, /digits and
// tables of states at other times than those of the samples. What its user has added is copied as it is.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "run_file.hpp"

namespace hamflow {

/// What differs.
struct ConvertedStates {
  std::string scenario;
  std::vector<std::string> coordinates;  // names
  std::vector<std::string> momenta;
  Table table;  // q, p and, of a run beyond double, digits/q, digits/p, digits/energy, digits/t
};

/// What is not in the copy.
struct LeftOut {
  std::vector<std::string> tables;  // of events and sections: their states are in the coordinates left behind
  std::vector<std::string> others;  // "/mine/link (why)": what a user has added and cannot be copied
};

/// @param source may also be a run that goes on or was cut short   @param target is replaced when it exists
/// @throws FileError
LeftOut copy_run_file(const std::filesystem::path& source, const std::filesystem::path& target,
                      const ConvertedStates& states);

}  // namespace hamflow
