// Other libraries on the same orbits. Each is optional: without it (as bench/CMakeLists.txt reports) its list is empty.
#pragma once

#include "contender.hpp"

namespace bench {

struct Peer {
  std::string library;  // "odeint", "gsl", "arkode"
  std::string stepper;  // its name there
  std::string method;   // ours, when it is the same map
  int order = 0;
  double slack = 1;  // its end state may lie so many bounds away
  Runner run;
};

std::vector<Peer> odeint_peers();
std::vector<Peer> gsl_peers();
std::vector<Peer> arkode_peers();
/// Their versions, or that they are missing.
std::string odeint_version();
std::string gsl_version();
std::string arkode_version();

/// Appends the peers that do the same method.
void add_peers(Workload& workload, const Task& task);

}  // namespace bench
