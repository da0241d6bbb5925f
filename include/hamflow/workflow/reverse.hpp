// Tests time reversibility: integrates forward, negates the momenta, integrates forward again, negates the momenta, and
// compares the result with the start.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "hamflow/scenario/scenario.hpp"
#include "hamflow/verify/certificate.hpp"
#include "hamflow/workflow/run.hpp"

namespace hamflow {

/// Error of N bodies after a reversal.   [Sonnleitner2010, p. 72]
struct BodyReversalError {
  LongNumber position;      // sqrt(sum |difference|^2)/N
  LongNumber momentum;      // the same for momenta
  LongNumber position_rms;  // sqrt(sum |difference|^2/N)
  LongNumber momentum_rms;  // the same for momenta
};
/// Results that only reversals of bodies and particles have.
struct BodyReversalSummary {
  std::optional<BodyReversalError> error{};         // nullopt: the reversal did not finish
  std::optional<std::int64_t> pair_evaluations{};   // number of pair forces; nullopt: they are not counted
  std::optional<std::int64_t> force_evaluations{};  // nullopt: pairs are counted instead, or no forces were computed
  std::string note{};                               // explains why pairs are not counted; else empty
};

/// Results of a reversal, as `hamflow reverse` prints them and reverse.json contains them.
struct ReversalSummary {
  std::string status;  // "done", "interrupted", "failed"
  std::string problem;
  std::string method;
  std::string arithmetic;
  double dt = 0;
  std::int64_t steps = 0;  // in each direction
  StateSummary start{};
  std::string start_hash{};  // hash of the stored bits, 16 hexadecimal digits
  // The entries from here to end_hash are nullopt or empty if the reversal did not finish.
  std::optional<StateSummary> returned{};
  std::optional<LongNumber> distance{};           // |returned - start| of the group with the largest relative distance
  std::optional<LongNumber> relative_distance{};  // distance divided by the size of this group along the motion
  std::optional<std::vector<GroupDistance>> distances{};  // one for each group of numbers with the same unit
  std::optional<bool> bit_exact{};
  // log10 of the relative distance divided by half of epsilon; 0: no digit is lost
  std::optional<double> digits_lost{};
  std::string turn_hash{};
  std::string end_hash{};
  bool method_reversible = false;
  bool expected_bit_exact = false;              // problem, method and arithmetic guarantee a bit-exact reversal
  std::string note{};                           // explains how to read the distance; empty: no note is needed
  std::optional<BodyReversalSummary> bodies{};  // nullopt: the problem has no bodies
  std::vector<Warning> warnings{};              // warnings about the motion itself
  std::optional<RunError> error{};              // nullopt: the reversal did not fail
};

/// Returns the text of reverse.json.
std::string reversal_json(const ReversalSummary& summary);
/// Returns the summary as text, one line for each entry.
std::string reversal_text(const ReversalSummary& summary);

/// Result of a reversal. Some numbers of the summary are repeated here.
struct ReversalReport {
  ReversalSummary summary;
  std::string status;                 // status of the summary
  std::string message;                // after a failure: says what failed
  std::string hint;                   // after a failure: what can be tried
  Reversal reversal;                  // empty if Existing::resume found a complete reversal
  bool expected_bit_exact = false;    // problem, method and arithmetic guarantee a bit-exact reversal
  std::string note;                   // explains how to read the distance; empty: no note is needed
  std::vector<std::string> warnings;  // warnings about the motion itself
  std::string json;                   // reversal_json(summary)
  std::string text;                   // reversal_text(summary)
};

/// @param pulse called with the number of steps taken over both halves; returns false to stop   @throws Error
ReversalReport reverse_scenario(const Scenario& scenario, const std::function<bool(std::int64_t step)>& pulse = {});

/// Settings that do not change the result of a reversal.
struct ReversalSettings {
  /// Output folder. It gets reverse.json, reverse.h5 with the states at the start, the turning point and the end, and
  /// during the reversal the checkpoint reversal.bin. Empty: nothing is written.
  std::filesystem::path folder{};
  Existing existing = Existing::refuse;
  /// Called several times a second with the number of steps taken over both halves; returns false to stop.
  std::function<bool(std::int64_t step)> pulse{};
  /// Called with each note, a sentence.
  std::function<void(const std::string& note)> note{};
};

/// @throws Rejection if a reversal shall be resumed and the one in the folder has another scenario
/// @throws FileError if the folder cannot be used   @throws Error
ReversalReport reverse_scenario(const Scenario& scenario, const ReversalSettings& settings);

}  // namespace hamflow
