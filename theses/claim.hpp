// **Claim**: what a thesis prints or says, what was measured of it, and the rule by which the two are judged. No
// verdict is written down anywhere: each is what judge() makes of the numbers.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hamflow {

/// A number, how far it may be off, and by what it was found.
struct Measured {
  double value = 0;
  double uncertainty = 0;  // the number lies within value +- uncertainty
  std::string how{};       // e.g. "cg(1,5), dt = 0.1"; of a claim with several, each by another way
};

/// As many digits of it as the uncertainty leaves: two of it, three at least, and eight of a number that has none.
std::string number_text(const Measured& one);

/// "page 42", "pages 99, 100", "pages 86 to 89".
inline std::string pages_text(const std::string& page) {
  return (page.find_first_not_of("0123456789") == std::string::npos ? "page " : "pages ") + page;
}

/// A claim holds where the number that was measured of it lies within [low, high].
struct Rule {
  std::string text;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

/// A number as it is printed: half a unit of its last digit up or down. @param number e.g. "-0.25", "3.747e-15"
Rule as_printed(const std::string& number);
/// @param why where the limit comes from
Rule at_most(double limit, const std::string& why);
Rule at_least(double limit, const std::string& why);
Rule within(double expected, double tolerance, const std::string& why);
/// For counts of counter-examples: one is enough.
Rule none_of(const std::string& what);

/// What it takes for a claim that was found wrong to be wrong whatever the program.
enum class Grounds {
  program,  // measured once, with a program: printed and measured differ
  ways,     // measured in two independent ways, one of them in more digits or in closed form
  identity  // the number is a discrepancy between printed numbers, or of an identity
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

/// All numbers within the rule by more than they are uncertain: holds. All beyond it: differs, or on good grounds
/// cannot hold; `ways` takes two numbers at least. Anything else, and a number that is none: undecided.
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
  std::string decided_by{};  // for where it is undecided: what run would tell
  Judgement judgement;
};

}  // namespace hamflow
