// Forward, negate the momenta, forward again, negate: what came back of a scenario's start.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "hamflow/scenario/scenario.hpp"
#include "hamflow/verify/certificate.hpp"
#include "hamflow/workflow/run.hpp"

namespace hamflow {

struct ReversalReport {
  std::string status;   // "done", "interrupted", "failed"
  std::string message;  // of a failure, a sentence
  std::string hint;     // and what can be done
  Reversal reversal;
  bool expected_bit_exact = false;    // whether problem, method and arithmetic promise every bit
  std::string note;                   // what a distance means here; empty where it speaks for itself
  std::vector<std::string> warnings;  // what is nonsense about the motion itself
  std::string json;
  std::string text;  // for people
};

/// @param pulse called with the steps taken both ways; returns false to stop   @throws Error
ReversalReport reverse_scenario(const Scenario& scenario, const std::function<bool(std::int64_t step)>& pulse = {});

/// How a reversal is carried out. None of it changes a bit of it.
struct ReversalSettings {
  /// Keeps reverse.json, reverse.h5 with the states at the start, the turn and the end, and on the way reversal.bin,
  /// from which it goes on; empty: nothing is written.
  std::filesystem::path folder{};
  Existing existing = Existing::refuse;
  /// Called several times a second with the steps taken both ways; returns false to stop.
  std::function<bool(std::int64_t step)> pulse{};
  /// Called with what is worth a note, a sentence each.
  std::function<void(const std::string& note)> note{};
};

/// @throws Rejection when the scenario is not that of the reversal in the folder, which is to go on   @throws FileError
/// when the folder cannot be used   @throws Error
ReversalReport reverse_scenario(const Scenario& scenario, const ReversalSettings& settings);

}  // namespace hamflow
