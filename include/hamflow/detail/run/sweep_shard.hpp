// The part of a sweep that one of several processes runs.
#pragma once

#include <cstddef>

namespace hamflow {

/// Member k belongs to shard k mod count. The default is the whole sweep.
struct SweepShard {
  std::size_t index = 0;  // below count
  std::size_t count = 1;
};

/// Thrown if a stop is requested while members are read, since 10^5 members take seconds.
struct ReadingStopped {};

}  // namespace hamflow
