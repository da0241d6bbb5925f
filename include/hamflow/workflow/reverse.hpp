// Forward, negate the momenta, forward again, negate: what came back of a scenario's start.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "hamflow/scenario/scenario.hpp"
#include "hamflow/verify/certificate.hpp"
#include "hamflow/workflow/run.hpp"

namespace hamflow {

/// The return error of N bodies.   [Sonnleitner2010, p. 72]
struct ReturnError {
  LongNumber position;      // sqrt(sum |difference|^2)/N
  LongNumber momentum;      // the same of the momenta
  LongNumber position_rms;  // sqrt(sum |difference|^2/N)
  LongNumber momentum_rms;  // the same of the momenta
};
/// The part of a reversal that only bodies and particles have.
struct BodiesReturned {
  std::optional<ReturnError> error{};               // none: the reversal did not finish
  std::optional<std::int64_t> pair_evaluations{};   // pair forces computed; none: they are not counted
  std::optional<std::int64_t> force_evaluations{};  // none: pairs are counted instead, or no forces were computed
  std::string note{};                               // why pairs are not counted; else empty
};

/// The results of a reversal, as `hamflow reverse` prints them and reverse.json holds them.
struct ReversalSummary {
  std::string status;  // "done", "interrupted", "failed"
  std::string problem;
  std::string method;
  std::string arithmetic;
  double dt = 0;
  std::int64_t steps = 0;  // each way
  StateSummary start{};
  std::string start_hash{};  // of the stored bits, 16 hexadecimal digits
  // From here to end_hash: absent or empty if the reversal did not finish.
  std::optional<StateSummary> returned{};
  std::optional<LongNumber> distance{};           // |returned - start|, of the group with the largest relative distance
  std::optional<LongNumber> relative_distance{};  // distance/size of this group along the motion
  std::optional<std::vector<GroupDistance>> distances{};  // for each group of numbers with the same unit
  std::optional<bool> bit_exact{};
  std::optional<double> digits_lost{};  // log10 of the relative distance over half of epsilon; 0: no digit is lost
  std::string turn_hash{};
  std::string end_hash{};
  bool method_reversible = false;
  bool expected_bit_exact = false;         // problem, method and arithmetic guarantee that every bit returns
  std::string note{};                      // how to read the distance; empty: no note is needed
  std::optional<BodiesReturned> bodies{};  // none: the problem has no bodies
  std::vector<Warning> warnings{};         // about the motion itself
  std::optional<RunError> error{};         // none: the reversal did not fail
};

/// The text of reverse.json.
std::string reversal_json(const ReversalSummary& summary);
/// The summary for people, one line for each entry.
std::string reversal_text(const ReversalSummary& summary);

/// The result of a reversal. The summary has its numbers; some are repeated here.
struct ReversalReport {
  ReversalSummary summary;
  std::string status;                 // that of the summary
  std::string message;                // of a failure, a sentence
  std::string hint;                   // and what can be done
  Reversal reversal;                  // empty if the reversal was complete before, with Existing::resume
  bool expected_bit_exact = false;    // whether problem, method and arithmetic promise every bit
  std::string note;                   // what a distance means here; empty where it speaks for itself
  std::vector<std::string> warnings;  // what is nonsense about the motion itself
  std::string json;                   // reversal_json(summary)
  std::string text;                   // reversal_text(summary)
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
