#include "hamflow/detail/core/near_pairs.hpp"

#include <cmath>

#include "neighbours.hpp"

namespace hamflow {

void NearPairs::find(ThreadTeam* team) {
  // Converting positions to double and wrapping them rounds by a few times 2^-53 of their size. Lists have a margin of
  // 1e-9 of their range for this. If a position is farther out or NaN, all pairs are visited.
  const double far = 1e5 * (reach_.radius + reach_.skin);
  all_ = false;
  for (const double x : positions_) all_ = all_ || !(std::abs(x) <= far);
  if (all_) return;
  if (!neighbours_) neighbours_ = std::make_shared<bulk::Neighbours>();
  const std::size_t workers = team != nullptr ? team->size() : 1;
  if (workers > workers_) {
    neighbours_->prepare({reach_.space, reach_.edges, reach_.radius, reach_.skin}, reach_.particles, workers);
    workers_ = workers;
  }
  const double* const q = positions_.data();
  if (neighbours_->place(q, team) && !reach_.rebuild_every_time) return;
  neighbours_->make(q, bulk::widest().near[reach_.space - 2], team);
  take_rows();
  ++lists_;
}

/// Takes the second half of each row, because lists contain every pair twice.
void NearPairs::take_rows() {
  const auto blocks = neighbours_->blocks();
  std::size_t most = 0;
  for (const auto& block : blocks) most += block.slots.size();
  if (partners_.size() < most) partners_.resize(most + most / 4);
  begins_.resize(reach_.particles);
  counts_.resize(reach_.particles);
  bulk::Rows rows;
  neighbours_->show(rows);
  std::size_t used = 0;
  for (const auto& block : blocks) {
    for (std::size_t slot = block.first; slot < block.last; ++slot) {
      const std::uint32_t i = rows.number[slot];
      const std::uint32_t* const slots = block.slots.data() + block.begins[slot - block.first];
      begins_[i] = used;
      for (std::size_t c = 0; c < block.counts[slot - block.first]; ++c) {
        const std::uint32_t j = rows.number[slots[c]];
        partners_[used] = j;
        used += j > i ? 1 : 0;
      }
      counts_[i] = static_cast<std::uint32_t>(used - begins_[i]);
    }
  }
}

}  // namespace hamflow
