// The keys of [problem] with the gas.
#pragma once

#include <vector>

#include "hamflow/core/option_info.hpp"

namespace hamflow {

struct GasOptions {
  OptionInfo particles_per_side, start, file, seed, masses, dimension, pair, phi, parameters, scale, container, cutoff;
  struct Container {
    OptionInfo kind, radius, exponent, size;
  } of_container;
  struct Cutoff {
    OptionInfo radius, kind, inner, skin;
  } of_cutoff;
};
const GasOptions& gas_options();
/// All of them, in the order in which they are shown, those of pair laws too.
std::vector<OptionInfo> all_gas_options();

struct GasStarts {
  static constexpr const char* lattice = "lattice";
  static constexpr const char* corner = "corner";
  static constexpr const char* file = "file";
};
struct GasScales {
  static constexpr const char* per_side = "per-side";
  static constexpr const char* listing = "listing";
};

}  // namespace hamflow
