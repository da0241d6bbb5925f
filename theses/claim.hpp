// A **claim** consists of a statement of a thesis, the numbers measured for it, and a rule. judge() computes each
// verdict from the numbers; no verdict is stored in the source.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hamflow {

/// A measured number, its uncertainty and how it was measured.
struct Measured {
  double value = 0;
  double uncertainty = 0;  // the number lies within value +- uncertainty
  std::string how{};       // e.g. "cg(1,5), dt = 0.1"; the numbers of one claim are measured in different ways
};

/// Writes the number to two digits of its uncertainty, with at least three digits; with eight digits if the uncertainty
/// is 0.
std::string number_text(const Measured& one);

/// Returns "page 42", "pages 99, 100" or "pages 86 to 89".
inline std::string pages_text(const std::string& page) {
  return (page.find_first_not_of("0123456789") == std::string::npos ? "page " : "pages ") + page;
}

/// A claim holds if its measured number is within [low, high].
struct Rule {
  std::string text;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

/// The measured number has to round to the printed one: half a unit of the last digit up or down.
/// @param number e.g. "-0.25", "3.747e-15"
Rule as_printed(const std::string& number);
/// @param why the reason for the limit
Rule at_most(double limit, const std::string& why);
Rule at_least(double limit, const std::string& why);
Rule within(double expected, double tolerance, const std::string& why);
/// The rule for counts of counter-examples: a single one refutes the claim.
Rule none_of(const std::string& what);

/// How a claim was measured. This decides whether a number outside of the rule gives "differs" or "cannot hold".
enum class Grounds {
  program,  // by one program: "differs"
  ways,     // in two independent ways, one of them with more digits or in closed form: "cannot hold"
  identity  // as a contradiction between printed numbers, or to an identity: "cannot hold"
};

enum class ClaimVerdict { holds, differs, cannot_hold, undecided, nothing_to_test };
constexpr std::string_view name(ClaimVerdict verdict) {
  switch (verdict) {
    case ClaimVerdict::holds:
      return "holds";
    case ClaimVerdict::differs:
      return "differs";
    case ClaimVerdict::cannot_hold:
      return "cannot hold";
    case ClaimVerdict::undecided:
      return "undecided";
    case ClaimVerdict::nothing_to_test:
      break;
  }
  return "nothing to test";
}
inline constexpr ClaimVerdict all_claim_verdicts[] = {ClaimVerdict::holds, ClaimVerdict::differs,
                                                      ClaimVerdict::cannot_hold, ClaimVerdict::undecided,
                                                      ClaimVerdict::nothing_to_test};

struct Judgement {
  ClaimVerdict verdict = ClaimVerdict::undecided;
  std::string reason;
};

/// Judges a claim. If the uncertainties of all numbers are inside of the rule, it holds. If they are all outside, it
/// differs, or it cannot hold, depending on the grounds; Grounds::ways needs at least two numbers. Otherwise, or if a
/// number is NaN, it is undecided.
Judgement judge(const Rule& rule, std::span<const Measured> measured, Grounds grounds);

struct Claim {
  std::string id;      // EXPERIMENT/name
  std::string thesis;  // "Gross", "Sonnleitner"
  std::string page;
  std::string statement;
  std::string printed;
  std::vector<Measured> measured;  // the first one is the claim's `measured` and `uncertainty`
  Rule rule;
  Grounds grounds = Grounds::program;
  std::string decided_by{};  // the run that could decide the claim, shown if it is undecided
  Judgement judgement;
};

}  // namespace hamflow
