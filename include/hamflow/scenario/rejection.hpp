// A request that is not accepted, as an exception.
#pragma once

#include "hamflow/core/error.hpp"
#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

/// what() holds the complaints, one line each.
class Rejection : public Error {
 public:
  explicit Rejection(std::vector<Complaint> all);
  std::vector<Complaint> complaints;
};

/// The scenario that was read.   @throws Rejection when something is wrong with it
Scenario accepted(Reading reading);

}  // namespace hamflow
