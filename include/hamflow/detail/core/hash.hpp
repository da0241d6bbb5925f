// **Hash** of bytes, to compare states and to detect damaged files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace hamflow {

/// The hash of no bytes.
constexpr std::uint64_t fnv1a_of_nothing = 0xcbf29ce484222325u;

/// FNV-1a, 64 bits: detects damage, not manipulation.   [RFC9923]
/// @param hash of the bytes before these
constexpr std::uint64_t fnv1a(std::span<const std::byte> bytes, std::uint64_t hash = fnv1a_of_nothing) {
  for (const std::byte b : bytes) hash = (hash ^ static_cast<std::uint64_t>(b)) * 0x100000001b3u;
  return hash;
}

}  // namespace hamflow
