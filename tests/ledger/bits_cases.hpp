// The cases of the ledger of bits: short runs of every problem, method and arithmetic, and the variants of them that
// must not change a bit.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace hamflow::test {

/// Computes a text of names and numbers.
using Maker = std::function<std::string()>;

/// A way to compute the numbers of a case that must not change them.
struct Variant {
  std::string name;
  Maker numbers;
};

struct Case {
  std::string name;
  std::string request;  // what is run, for `show`
  Maker numbers;
  std::vector<Variant> variants{};
  bool is_beyond_portable = false;  // in quad or mp(d)
};

/// In a fixed order. A name is PROBLEM/METHOD/ARITHMETIC or longer, without blanks, and stands once. A portable
/// build has none in quad or mp(d).
std::vector<Case> all_cases();

}  // namespace hamflow::test
