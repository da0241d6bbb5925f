#include "hamflow/scenario/rejection.hpp"

namespace hamflow {

Scenario accepted(Reading reading) {
  if (!reading.scenario) throw Rejection(std::move(reading.complaints));
  return *std::move(reading.scenario);
}

}  // namespace hamflow
