// Names and options of the gas of the catalogue.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hamflow/core/problem_info.hpp"

namespace hamflow {

struct Request;

/// The names of the gas: keys of a scenario, choices among its entries, and parameters.
struct GasKeys {
  static constexpr const char* problem = "gas";
  // Choices.
  static constexpr const char* pair = "pair";
  static constexpr const char* container = "container";
  static constexpr const char* cutoff_kind = "cutoff_kind";
  static constexpr const char* typed = "formula";  // the word for a typed pair law
  static constexpr const char* phi = "phi";
  static constexpr const char* parameters = "parameters";
  // Parameters.
  static constexpr const char* masses = "masses";
  static constexpr const char* dimension = "dimension";
  static constexpr const char* scale = "scale";
  static constexpr const char* radius = "radius";      // of the circle
  static constexpr const char* exponent = "exponent";  // of the soft wall
  static constexpr const char* size = "size";          // of a box
  static constexpr const char* cutoff = "cutoff";
  static constexpr const char* inner = "inner";
  static constexpr const char* skin = "skin";
};

/// The keys of [problem] for the gas.
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
/// All options, in the order in which they are shown, including those of pair laws.
const std::vector<OptionInfo>& all_gas_options();

struct GasStarts {
  static constexpr const char* lattice = "lattice";
  static constexpr const char* corner = "corner";
  static constexpr const char* file = "file";
};
struct GasScales {
  static constexpr const char* per_side = "per-side";
  static constexpr const char* listing = "listing";
};

/// The built-in pair laws: names, formulas and parameters.
const std::vector<ProblemInfo>& pair_laws();

}  // namespace hamflow
