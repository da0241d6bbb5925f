#include "container.hpp"
#include "cutoff.hpp"
#include "hamflow/run/gas.hpp"

namespace hamflow {

namespace {

GasOptions declared() {
  GasOptions o;
  o.particles_per_side = {.name = "particles_per_side",
                          .meaning = "n particles on each side: n^2 in the plane, n^3 in space",
                          .range = Range::whole_from(2, 100000),
                          .unset = "the number in the file or in initial",
                          .example = "11"};
  o.start = {.name = "start",
             .default_value = GasStarts::lattice,
             .meaning =
                 "lattice: particles on a lattice in [-1, 1]^2, momenta uniform in [-1, 1); corner: particles on a "
                 "lattice in [0, 1]^2, at rest; file: particles from a file",
             .type = OptionType::word,
             .words = {GasStarts::lattice, GasStarts::corner, GasStarts::file},
             .condition = "without initial"};
  o.file = {.name = "file",
            .meaning =
                "path relative to the scenario: a CSV with the columns x, y(, z), p_x, p_y(, p_z)(, mass) named in its "
                "first row, or a run.h5, from which the last sample is taken",
            .type = OptionType::text,
            .condition = "with start = \"file\"",
            .example = "start.csv"};
  o.seed = {
      .name = "seed",
      .default_value = "1",
      .meaning =
          "seed of the random momenta. Momentum k = 0, 1, ... is 2e-5*m - 1, a decimal of five places, where "
          "m = floor(1e5*(x >> 11)*2^-53) and x is computed in whole numbers modulo 2^64 (SplitMix64): x = seed + (k + "
          "1)*0x9e3779b97f4a7c15, x = (x xor x >> 30)*0xbf58476d1ce4e5b9, x = (x xor x >> 27)*0x94d049bb133111eb, "
          "x = x xor x >> 31. The order is p_x, p_y(, p_z) of one particle after another; the first coordinate of the "
          "lattice changes fastest",
      .range = Range::whole_from(0, 0x1p53),
      .condition = "with start = \"lattice\""};
  o.masses = {.name = GasKeys::masses,
              .default_value = "1",
              .meaning =
                  "mass of all particles, or a mass for each. Masses do not enter phi, which is the same for every "
                  "pair (for gravity between unequal masses use n-body)",
              .range = Range::positive,
              .type = OptionType::number_or_list};
  o.dimension = {.name = GasKeys::dimension,
                 .default_value = "2",
                 .meaning = "dimension of space",
                 .range = Range::whole_from(2, 3)};
  o.pair = {.name = GasKeys::pair,
            .default_value = "lennard-jones",
            .meaning = "the pair potential phi; with formula, it is given by phi = \"...\"",
            .type = OptionType::word};
  for (const ProblemInfo& law : pair_laws()) o.pair.words.push_back(law.name);
  o.pair.words.emplace_back(GasKeys::typed);
  o.phi = {.name = GasKeys::phi,
           .meaning = "phi, a formula of r and the parameters",
           .type = OptionType::text,
           .condition = "with pair = \"formula\"",
           .example = "r^-9 - a*r^-6"};
  o.parameters = {.name = GasKeys::parameters,
                  .meaning = "numbers and lists by name",
                  .type = OptionType::table,
                  .unset = "none",
                  .condition = "with pair = \"formula\"",
                  .example = "{ a = 1 }"};
  o.scale = {.name = GasKeys::scale,
             .meaning =
                 "S: how many length units of the potential make one unit of the coordinates; per-side: neighbours of "
                 "the start are one unit of the potential apart; listing: (N - 1)/2 with N particles",
             .range = Range::positive,
             .words = {GasScales::per_side, GasScales::listing},
             .unset = "per-side; 1 without particles_per_side",
             .example = GasScales::per_side};
  o.of_container = {
      .kind = {.name = "kind",
               .default_value = ContainerNames::circle,
               .meaning = "circle: a soft wall (in space a sphere); box: hard walls; periodic: a periodic box, in "
                          "which particles interact with nearest images; none",
               .type = OptionType::word,
               .words = {ContainerNames::circle, ContainerNames::box, ContainerNames::periodic, ContainerNames::none}},
      .radius = {.name = GasKeys::radius,
                 .default_value = "1.5",
                 .meaning = "radius of the circle",
                 .range = Range::positive,
                 .condition = "with kind = \"circle\""},
      .exponent = {.name = GasKeys::exponent,
                   .default_value = "1",
                   .meaning = "exponent e of the wall, V = 1/(2 S^(2+2e)) sum 1/(radius^2 - |q|^2)^e",
                   .range = {.least = 1},
                   .condition = "with kind = \"circle\""},
      .size = {.name = GasKeys::size,
               .meaning = "edges of the box, which is centred at the origin",
               .range = Range::positive,
               .type = OptionType::list,
               .condition = "with kind = \"box\", \"periodic\"",
               .example = "[2, 2]"}};
  o.container = {.name = GasKeys::container,
                 .meaning = "the container of the particles",
                 .type = OptionType::table,
                 .unset = "a circle",
                 .example = "{ kind = \"circle\", radius = 1.5, exponent = 1 }",
                 .keys = {o.of_container.kind, o.of_container.radius, o.of_container.exponent, o.of_container.size}};
  o.of_cutoff = {.radius = {.name = "radius",
                            .meaning = "R, in length units of the potential",
                            .range = Range::positive,
                            .required = true,
                            .example = "2.5"},
                 .kind = {.name = "kind",
                          .default_value = CutoffNames::shifted,
                          .meaning = "shifted: phi is shifted to 0 at R; force-shifted: phi and its force are shifted "
                                     "to 0 at R; smooth: phi is reduced to 0 from inner to R by a factor of class C^4",
                          .type = OptionType::word,
                          .words = {CutoffNames::shifted, CutoffNames::force_shifted, CutoffNames::smooth}},
                 .inner = {.name = GasKeys::inner,
                           .meaning = "distance from which phi is reduced smoothly to 0",
                           .range = Range::positive,
                           .condition = "with kind = \"smooth\"",
                           .example = "2"},
                 .skin = {.name = GasKeys::skin,
                          .default_value = "0.3",
                          .meaning = "skin of the neighbour lists; does not change results",
                          .range = Range::positive}};
  o.cutoff = {.name = GasKeys::cutoff,
              .meaning = "the cut-off distance R of phi, or { radius = R, kind, inner, skin }",
              .type = OptionType::table,
              .unset = "no cut-off: all pairs interact",
              .example = "{ radius = 2.5, kind = \"smooth\", inner = 2 }",
              .keys = {o.of_cutoff.radius, o.of_cutoff.kind, o.of_cutoff.inner, o.of_cutoff.skin}};
  return o;
}

}  // namespace

const GasOptions& gas_options() {
  static const GasOptions options = declared();
  return options;
}

const std::vector<OptionInfo>& all_gas_options() {
  static const std::vector<OptionInfo> options = [] {
    const GasOptions& o = gas_options();
    std::vector<OptionInfo> all{o.particles_per_side, o.start, o.file, o.seed, o.masses, o.dimension, o.pair};
    for (const ProblemInfo& law : pair_laws()) {
      for (OptionInfo option : law.parameters) {
        option.condition = "with pair = \"" + law.name + "\"";
        all.push_back(option);
      }
    }
    all.insert(all.end(), {o.phi, o.parameters, o.scale, o.container, o.cutoff});
    return all;
  }();
  return options;
}

}  // namespace hamflow
