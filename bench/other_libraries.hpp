// Other libraries on the same orbits. Each library is optional. If it is missing, bench/CMakeLists.txt reports it, and
// its list is empty.
#pragma once

#include "contender.hpp"

namespace bench {

struct OtherLibraryMethod {
  std::string library;  // "odeint", "gsl", "arkode"
  std::string stepper;  // the name of the method in that library
  std::string method;   // the method of hamflow that is the same map; empty: none
  int order = 0;
  double slack = 1;  // the factor of the bound for its end state
  Runner run;
};

std::vector<OtherLibraryMethod> odeint_peers();
std::vector<OtherLibraryMethod> gsl_peers();
std::vector<OtherLibraryMethod> arkode_peers();
/// The versions of the libraries, or "missing".
std::string odeint_version();
std::string gsl_version();
std::string arkode_version();

/// Adds the steppers of other libraries that are the same method.
void add_other_libraries(Workload& workload, const Task& task);

}  // namespace bench
