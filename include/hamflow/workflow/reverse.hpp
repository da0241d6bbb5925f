// Forward, negate the momenta, forward again, negate: what came back of a scenario's start.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "hamflow/scenario/scenario.hpp"
#include "hamflow/verify/certificate.hpp"

namespace hamflow {

struct ReversalReport {
  std::string status;   // "done", "interrupted", "failed"
  std::string message;  // of a failure, a sentence
  std::string hint;     // and what can be done
  Reversal reversal;
  bool expected_bit_exact = false;  // whether problem, method and arithmetic promise every bit
  std::string note;                 // what a distance means here; empty where it speaks for itself
  std::string json;
  std::string text;  // for people
};

/// @param pulse called with the steps taken both ways; returns false to stop   @throws Error
ReversalReport reverse_scenario(const Scenario& scenario, const std::function<bool(std::int64_t step)>& pulse = {});

/// A folder that keeps a reversal: reverse.json, and reverse.h5 with the states at the start, the turn and the end.
class ReversalFolder {
 public:
  /// @param force replaces an earlier reversal, and nothing else   @throws FileError when the folder exists, or cannot
  /// be made
  ReversalFolder(const std::filesystem::path& folder, bool force);
  /// @throws FileError
  void keep(const Scenario& scenario, const ReversalReport& report) const;

 private:
  std::filesystem::path folder_;
  std::shared_ptr<const void> lock_;
};

}  // namespace hamflow
