// Errors in a request. An error is a value from the place that finds it to the place that prints it, so that no code
// parses the printed sentence.
#pragma once

#include <compare>
#include <string>
#include <vector>

#include "hamflow/core/error.hpp"

namespace hamflow {

/// One error in a request.
struct Complaint {
  std::string file;  // the file at fault, or the option, "--set", "--vary"; empty: neither
  int line = 0;      // 0: not in a file
  int column = 0;
  std::string key;  // a dotted path, e.g. "problem.orbit.r_per"; an option, "--out"; a positional argument, "METHOD"
  std::string message;  // "found ...; allowed ...; did you mean ...?"

  /// The file or the option at fault.
  std::string origin() const;
  /// FILE:LINE:COL: error: KEY: message; --set: error: KEY: message; --out: error: message; error: KEY: message.
  std::string text() const;

  auto operator<=>(const Complaint&) const = default;
};

/// The exception for a refused request.
class Rejection : public Error {
 public:
  explicit Rejection(std::vector<Complaint> all);
  /// One error in an option or positional argument of a command.
  Rejection(std::string option, std::string message);
  std::vector<Complaint> complaints;
};

}  // namespace hamflow
