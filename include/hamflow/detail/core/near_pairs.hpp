// Neighbour lists for loops over pairs in any arithmetic: pairs i < j that can be within a distance of each other,
// found by the cell lists with skin of the bulk forces. The loop itself decides which pairs are in range. A pair that
// is left out is beyond the distance and contributes exactly 0; the others come in the order of a loop over all pairs.
// Sums therefore have the bits of that loop, whatever the skin, the age of the lists and the number of threads.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "hamflow/detail/core/thread_team.hpp"

namespace hamflow {

namespace bulk {
class Neighbours;
}

/// The partners j > i of a particle i in ascending order: those of a neighbour list, or all.
class PartnerRow {
 public:
  PartnerRow(std::size_t i, std::size_t particles) : first_(i + 1), size_(particles - 1 - i) {}
  PartnerRow(const std::uint32_t* listed, std::size_t count) : listed_(listed), size_(count) {}
  std::size_t size() const { return size_; }
  std::size_t operator[](std::size_t k) const { return listed_ != nullptr ? listed_[k] : first_ + k; }

 private:
  const std::uint32_t* listed_ = nullptr;
  std::size_t first_ = 0;
  std::size_t size_;
};

/// Takes the place of NearPairs::Turn if no pair is left out.
struct AllPairs {
  struct Row {
    std::size_t first;
    std::size_t count;
    std::size_t size() const { return count; }
    std::size_t operator[](std::size_t k) const { return first + k; }
  };
  std::size_t particles;
  Row operator[](std::size_t i) const { return {i + 1, particles - 1 - i}; }
};

class NearPairs {
 public:
  /// The range and the box, in the units of the coordinates.
  struct Reach {
    std::size_t space = 2;
    std::size_t particles = 0;
    double radius = 0;
    double skin = 0;
    std::array<double, 3> edges{};    // of the periodic box, centred at the origin; 0: not periodic
    bool rebuild_every_time = false;  // for tests
  };
  /// Exclusive access to the pairs at the given positions; other callers wait until it is destroyed.
  class Turn {
   public:
    explicit Turn(std::size_t particles) : particles_(particles) {}
    PartnerRow operator[](std::size_t i) const {
      if (pairs_ == nullptr || pairs_->all_) return {i, particles_};
      return {pairs_->partners_.data() + pairs_->begins_[i], pairs_->counts_[i]};
    }
    /// Changes when the lists change.
    std::uint64_t version() const { return pairs_ == nullptr || pairs_->all_ ? 0 : pairs_->lists_; }

   private:
    friend class NearPairs;
    explicit Turn(NearPairs& pairs) : pairs_(&pairs), particles_(pairs.reach_.particles), turn_(pairs.busy_) {}
    const NearPairs* pairs_ = nullptr;
    std::size_t particles_;
    std::unique_lock<std::mutex> turn_{};
  };

  explicit NearPairs(const Reach& reach) : reach_(reach) {}

  /// @param position the k-th coordinate, convertible to double @param team threads that make lists; null: the caller's
  /// thread
  template <class Position>
  Turn at(const Position& position, ThreadTeam* team = nullptr) {
    Turn turn(*this);
    positions_.resize(reach_.space * reach_.particles);
    for (std::size_t k = 0; k < positions_.size(); ++k) positions_[k] = static_cast<double>(position(k));
    find(team);
    return turn;
  }
  /// The number of lists made since construction.
  std::uint64_t lists() const { return lists_; }

 private:
  void find(ThreadTeam* team);
  void take_rows();

  std::mutex busy_;
  Reach reach_;
  std::shared_ptr<bulk::Neighbours> neighbours_;
  std::size_t workers_ = 0;
  std::vector<double> positions_;
  bool all_ = true;
  std::vector<std::size_t> begins_;  // the index at which the row of each particle begins
  std::vector<std::uint32_t> counts_;
  std::vector<std::uint32_t> partners_;
  std::uint64_t lists_ = 0;
};

}  // namespace hamflow
