// Errors in a request. Each one is a value from the place that finds it to the place that prints it; no code parses the
// printed sentence.
#pragma once

#include <compare>
#include <string>
#include <vector>

#include "hamflow/core/error.hpp"

namespace hamflow {

/// One thing wrong with a request.
struct Complaint {
  std::string file;  // that holds it; or the option that gave it, "--set", "--vary"; empty: neither
  int line = 0;      // 0: it stands in no file
  int column = 0;
  std::string key;      // a dotted path, e.g. "problem.orbit.r_per"; an option, "--out"; a word of the usage, "METHOD"
  std::string message;  // "found ...; allowed ...; did you mean ...?"

  /// What gave it: file, or an option.
  std::string origin() const;
  /// FILE:LINE:COL: error: KEY: message; --set: error: KEY: message; --out: error: message; error: KEY: message.
  std::string text() const;

  auto operator<=>(const Complaint&) const = default;
};

/// A request that is not accepted, as an exception.
class Rejection : public Error {
 public:
  explicit Rejection(std::vector<Complaint> all);
  /// One thing wrong with an option of a command, or a word of its usage.
  Rejection(std::string option, std::string message);
  std::vector<Complaint> complaints;
};

}  // namespace hamflow
