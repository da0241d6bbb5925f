// Copies a run.h5 with states in other coordinates. Everything is copied except the scenario, names of coordinates, /q,
// /p, /digits, and tables of states at other times than the samples. Objects that a user has added are copied
// unchanged.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "run_file.hpp"

namespace hamflow {

/// The data that replace those of the source.
struct ConvertedStates {
  std::string scenario;
  std::vector<std::string> coordinates;  // names of coordinates
  std::vector<std::string> momenta;
  Table table;  // q and p; beyond double also digits/q, digits/p, digits/energy, digits/t
};

/// Tables and objects that the copy does not contain.
struct OmittedFromCopy {
  std::vector<std::string> tables;  // tables of events and sections, because their states are in the old coordinates
  std::vector<std::string> others;  // "/mine/link (why)": objects of a user that cannot be copied
};

/// @param source may also be a run that is still running or was cut short   @param target replaced if it exists
/// @throws FileError
OmittedFromCopy copy_run_file(const std::filesystem::path& source, const std::filesystem::path& target,
                              const ConvertedStates& states);

}  // namespace hamflow
