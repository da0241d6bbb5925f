// Names and options of the problem `socket`, whose energy and forces another program computes.
#pragma once

#include <vector>

#include "hamflow/core/error.hpp"
#include "hamflow/core/problem_info.hpp"

namespace hamflow {

/// The program that computes the forces did not connect, ended, took too long or answered wrongly. A simulation throws
/// it from advance() and keeps the state after the last complete step.
class ClientError : public Error {
 public:
  using Error::Error;
};

struct SocketKeys {
  static constexpr const char* problem = "socket";
  static constexpr const char* address = "address";  // a choice; the other keys are parameters
  static constexpr const char* masses = "masses";
  static constexpr const char* cell = "cell";
  static constexpr const char* length_unit = "length_unit";
  static constexpr const char* energy_unit = "energy_unit";
  static constexpr const char* timeout = "timeout";
};

/// The keys of [problem] for the problem `socket`.
const std::vector<OptionInfo>& socket_options();
/// The error of an address: "found ...; allowed ..."; empty if it is accepted.
std::string refused_address(const std::string& address);

}  // namespace hamflow
