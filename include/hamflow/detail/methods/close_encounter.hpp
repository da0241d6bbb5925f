// Close encounters of bodies that move about the first one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "hamflow/core/vector.hpp"
#include "hamflow/detail/core/pool.hpp"

namespace hamflow {

/// A list that a copied method holds. A simulation copies its method at each call, and the pool keeps the memory.
template <class T>
using PooledList = std::vector<T, PoolAllocator<T>>;

/// Two bodies, by index, neither of which is the first.
using EncounterOfTwo = std::pair<std::size_t, std::size_t>;

/// What a method keeps of its first encounter.
struct FirstEncounter {
  long long step = 0;  // the number of steps taken when that step was done; 0: there was no encounter
  std::uint64_t one = 0;
  std::uint64_t other = 0;
};

/// Finds the first pair of bodies within 3 Hill radii of one of them: d < 3 r (m/(3 m_0))^(1/3), with the mass m of
/// that body and its distance r from the centre of its orbit.   [MurrayDermott1999, ch. 3]
template <class R>
class EncounterWatch {
 public:
  explicit EncounterWatch(const PooledList<R>& masses) : within_(masses.size()) {
    // The condition is d^6 < 81 (m/m_0)^2 r^6, without roots.
    for (const R& mass : masses) factors_.push_back(R(81) * (mass / masses[0]) * (mass / masses[0]));
  }

  /// Begins to watch, or ends it.
  void watch(bool watches) {
    watches_ = watches;
    first_.reset();
  }
  /// The first pair since watch(); nullopt if there was none.
  const std::optional<EncounterOfTwo>& first() const { return first_; }

  /// Prepares for the pairs of a state. Returns false if they are not watched.
  /// @param positions of each body, from the centre of its orbit
  bool begin(const PooledList<Vector<R, 3>>& positions) {
    if (!watches_ || first_) return false;
    for (std::size_t i = 1; i < within_.size(); ++i) {
      if (!(R(0) < factors_[i])) continue;
      R square(0);
      for (std::size_t k = 0; k < 3; ++k) square += positions[i][k] * positions[i][k];
      within_[i] = factors_[i] * (square * square * square);
    }
    return true;
  }

  /// @param square of the distance of bodies i and j
  void look(std::size_t i, std::size_t j, const R& square) {
    const R sixth = square * square * square;
    if (!first_ && (sixth < within_[i] || sixth < within_[j])) first_ = {i < j ? i : j, i < j ? j : i};
  }

 private:
  PooledList<R> factors_;
  PooledList<R> within_;  // the sixth power of 3 Hill radii
  bool watches_ = false;
  std::optional<EncounterOfTwo> first_;
};

}  // namespace hamflow
