#include "iterated_family.hpp"

namespace hamflow {

bool IteratedFamily::add_parameter_set(std::size_t set, const IteratedMember& member) {
  if (const auto found = recorded_.find(set); found != recorded_.end()) return true;
  if (refused_.contains(set)) return false;
  if (auto recorded = member.recorded_iteration()) {
    const auto added = recorded_.emplace(set, std::make_shared<const RecordedIteration>(*std::move(recorded))).first;
    if (load()) return true;
    recorded_.erase(added);
    if (!recorded_.empty()) (void)load();
  }
  refused_.insert(set);
  return false;
}

/// Compiles the loops for all parameter sets that were added.
bool IteratedFamily::load() {
  std::vector<std::size_t> sets;
  for (const auto& [set, recorded] : recorded_) sets.push_back(set);
  return correct_.load(steps(&RecordedIteration::correct, sets)) &&
         finish_.load(steps(&RecordedIteration::finish, sets));
}

FamilyLoop::Steps IteratedFamily::steps(Part part, std::span<const std::size_t> sets) const {
  FamilyLoop::Steps all;
  for (const std::size_t set : sets) {
    const std::shared_ptr<const RecordedIteration>& of = recorded_.at(set);
    all.emplace_back(of, &(of.get()->*part));
  }
  return all;
}

LaneNumbers IteratedFamily::constants_of_correct(std::span<const std::size_t> sets) const {
  return correct_.constants(steps(&RecordedIteration::correct, sets));
}
LaneNumbers IteratedFamily::constants_of_finish(std::span<const std::size_t> sets) const {
  return finish_.constants(steps(&RecordedIteration::finish, sets));
}

}  // namespace hamflow
