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
                      .meaning = "event: the time of the bounce is located; mirror: each drift is reflected; reject: "
                                 "a step that leaves is not taken; soft: a term of V",
                      .type = OptionType::word,
                      .words = wall_rules(),
                      .condition = "with walls"},
        .strength = {.name = "strength",
                     .default_value = "1",
                     .meaning = "k of the force -k x/(1 - x^2)^e, x from -1 to 1 between the walls",
                     .range = Range::positive,
                     .condition = "with wall_rule = \"soft\""},
        .exponent = {.name = "exponent",
                     .default_value = "2",
                     .meaning = "e of that force, at least 1",
                     .range = {.least = 1},
                     .condition = "with wall_rule = \"soft\""},
        .coordinate = {.name = "coordinate", .meaning = "its name", .type = OptionType::word, .required = true},
        .min = {.name = "min", .meaning = "the wall below", .unset = "none", .example = "-1"},
        .max = {.name = "max", .meaning = "the wall above", .unset = "none", .example = "1"}};
    k.walls = {.name = "walls",
               .meaning = "a list of intervals of coordinates, [{ coordinate, min, max }]",
               .type = OptionType::table,
               .unset = "none",
               .keys = {k.coordinate, k.min, k.max}};
    return k;
  }();
  return keys;
}

double on_half_lattice(double wall, double unit) { return (std::floor(wall / unit) + 0.5) * unit; }

}  // namespace hamflow
