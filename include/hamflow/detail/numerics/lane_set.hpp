#pragma once

#include <string_view>

namespace hamflow {

/// The instruction set of lanes. Results do not depend on it.
enum class LaneSet { none, generic, avx2, avx512 };

constexpr std::string_view name(LaneSet set) {
  switch (set) {
    case LaneSet::none:
      return "none";
    case LaneSet::generic:
      return "generic";
    case LaneSet::avx2:
      return "avx2";
    case LaneSet::avx512:
      return "avx512";
  }
  return "unknown";
}

}  // namespace hamflow
