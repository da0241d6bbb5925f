// hamflow verify METHOD...|--all [--problem P] [--json]: the property table, measured.
#pragma once

#include <string>
#include <vector>

struct VerifyOptions {
  std::vector<std::string> methods;  // as on the command line, e.g. "stv4", "cg(1,5)"
  bool all = false;                  // every method of the catalogue instead
  std::string problem;               // empty: the default ones
  bool json = false;
};

/// Prints the table. @return 0: every claim agrees with its measurement, 1: one does not, 2: the request was wrong
int run_verify(const VerifyOptions& options);
