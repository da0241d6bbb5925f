// Misuse throws an exception with a full message; a numerical failure is a value (outcome.hpp).
#pragma once

#include <stdexcept>
#include <string>

namespace hamflow {

/// The request was wrong. The message says what was given, what is allowed and what to do.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file or folder could not be read or written.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace hamflow
