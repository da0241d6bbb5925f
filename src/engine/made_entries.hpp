// A cache of entries that are made on request.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// Each member of a sweep over the position of a wall, or over a number in a formula, is a separate problem, and a
/// cache of all would grow by some 25 kB per member. So it keeps only the last few; older entries exist as long as they
/// are used.
template <class Key>
class MadeEntries {
 public:
  /// The entry of a key, made by make() if it is not in the cache.
  template <class Make>
  std::shared_ptr<const ProblemEntry> find(const Key& key, const Make& make) {
    constexpr std::size_t most = 64;
    const std::scoped_lock lock(mutex_);
    if (const auto found = entries_.find(key); found != entries_.end()) return found->second;
    auto made = std::make_shared<const ProblemEntry>(make());
    if (entries_.size() >= most) entries_.clear();
    entries_.emplace(key, made);
    return made;
  }

 private:
  std::mutex mutex_;
  std::map<Key, std::shared_ptr<const ProblemEntry>> entries_;
};

}  // namespace hamflow
