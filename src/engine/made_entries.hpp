// Entries that are made from what is asked for, kept while they are asked for again.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// The members of a sweep over a wall's position, or over a number inside a formula, are each a problem of their own:
/// a cache of all of them would grow by some 25 kB a member. So it keeps the last few; who holds an older one keeps it.
template <class Key>
class MadeEntries {
 public:
  /// The entry of a key, made by make() where it is not kept.
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
