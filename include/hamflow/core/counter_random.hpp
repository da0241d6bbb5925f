// Random numbers without a state: the k-th number of a seed is a function of (seed, k), hence the same in every test,
// thread and order of evaluation.   [SteeleLeaFlood2014, SplitMix64]
#pragma once

#include <cstdint>

namespace hamflow {

/// SplitMix64's output function at position k of the sequence that begins at `seed`.
constexpr std::uint64_t counter_bits(std::uint64_t seed, std::uint64_t k) {
  std::uint64_t x = seed + (k + 1) * 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// Uniform in [-1, 1), 53 bits.
constexpr double counter_uniform(std::uint64_t seed, std::uint64_t k) {
  return static_cast<double>(counter_bits(seed, k) >> 11) * 0x1p-52 - 1;
}

}  // namespace hamflow
