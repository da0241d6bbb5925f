#include "recorded_step.hpp"

namespace hamflow {

namespace detail {
std::vector<CarriedField> carried_fields(const TracedFields& before, const TracedFields& after,
                                         const std::vector<bool>& counts) {
  if (before.others.size() != after.others.size() || counts.size() != after.others.size()) return {};
  std::vector<CarriedField> fields;
  for (std::size_t i = 0; i < after.others.size(); ++i) {
    if (!after.others[i]) {
      fields.push_back({CarriedField::Kind::carried, 0});
    } else if (counts[i]) {
      fields.push_back({CarriedField::Kind::counter, *after.others[i] - *before.others[i]});
    } else if (*after.others[i] == *before.others[i]) {
      fields.push_back({CarriedField::Kind::kept, *after.others[i]});
    } else {
      return {};
    }
  }
  return fields;
}
}  // namespace detail

}  // namespace hamflow
