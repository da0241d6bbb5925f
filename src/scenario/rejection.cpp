#include "hamflow/scenario/rejection.hpp"

namespace hamflow {

namespace {
std::string lines_of(const std::vector<Complaint>& complaints) {
  std::string all;
  for (const Complaint& complaint : complaints) all += (all.empty() ? "" : "\n") + complaint.text();
  return all;
}
}  // namespace

Rejection::Rejection(std::vector<Complaint> all) : Error(lines_of(all)), complaints(std::move(all)) {}

Scenario accepted(Reading reading) {
  if (!reading.scenario) throw Rejection(std::move(reading.complaints));
  return *std::move(reading.scenario);
}

}  // namespace hamflow
