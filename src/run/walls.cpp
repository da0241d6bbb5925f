#include "hamflow/run/walls.hpp"

#include <cmath>

namespace hamflow {

const std::vector<std::string>& wall_rules() {
  static const std::vector<std::string> names{"event", "mirror", "reject", "soft"};
  return names;
}

const WallKeys& wall_keys() {
  static const WallKeys keys = [] {
    WallKeys k{
        .wall_rule = {.name = "wall_rule",
                      .default_value = wall_rules().front(),
                      .meaning = "event: locate the time of each bounce; mirror: reflect each drift; reject: discard a "
                                 "step that ends outside and reverse the momentum; soft: add a repulsive term to V",
                      .type = OptionType::word,
                      .words = wall_rules(),
                      .condition = "with walls"},
        .strength = {.name = "strength",
                     .default_value = "1",
                     .meaning = "strength k of the force -k x/(1 - x^2)^e, where x goes from -1 to 1 between the walls",
                     .range = Range::positive,
                     .condition = "with wall_rule = \"soft\""},
        .exponent = {.name = "exponent",
                     .default_value = "2",
                     .meaning = "exponent e of that force, at least 1",
                     .range = {.least = 1},
                     .condition = "with wall_rule = \"soft\""},
        .coordinate = {.name = "coordinate",
                       .meaning = "name of the coordinate",
                       .type = OptionType::word,
                       .required = true},
        .min = {.name = "min", .meaning = "position of the lower wall", .unset = "none", .example = "-1"},
        .max = {.name = "max", .meaning = "position of the upper wall", .unset = "none", .example = "1"}};
    k.walls = {.name = "walls",
               .meaning = "walls as a list of intervals, [{ coordinate, min, max }]",
               .type = OptionType::table,
               .unset = "none",
               .keys = {k.coordinate, k.min, k.max}};
    return k;
  }();
  return keys;
}

double on_half_lattice(double wall, double unit) { return (std::floor(wall / unit) + 0.5) * unit; }

}  // namespace hamflow
