#include "hamflow/run/walls.hpp"

#include <algorithm>
#include <cmath>

#include "hamflow/core/text.hpp"

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

std::optional<Walls> walls_among(const std::map<std::string, std::string>& choices) {
  const auto given = choices.find(wall_keys().walls.name);
  if (given == choices.end() || given->second.empty()) return std::nullopt;
  Walls walls;
  for (const std::string& text : split_list(given->second)) {
    const std::vector<std::string> parts = split_list(text.substr(1, text.size() - 2));  // without its brackets
    walls.intervals.push_back({parts.at(0), std::stoul(parts.at(1)), parts.at(2), parts.at(3)});
  }
  const auto rule = choices.find(wall_keys().wall_rule.name);
  if (rule != choices.end()) {
    const auto& names = wall_rules();
    walls.rule = static_cast<WallRule>(std::find(names.begin(), names.end(), rule->second) - names.begin());
  }
  const auto text = [&](const std::string& key, std::string& to) {
    const auto found = choices.find(key);
    if (found != choices.end()) to = found->second;
  };
  text(wall_keys().strength.name, walls.strength);
  text(wall_keys().exponent.name, walls.exponent);
  return walls;
}

void put_among(const Walls& walls, std::map<std::string, std::string>& choices) {
  std::string text;
  for (const Walls::Interval& i : walls.intervals) {
    text += (text.empty() ? "[" : ", [") + i.coordinate + ", " + std::to_string(i.index) + ", " + i.min + ", " + i.max +
            "]";
  }
  choices[wall_keys().walls.name] = text;
  choices[wall_keys().wall_rule.name] = wall_rules()[static_cast<std::size_t>(walls.rule)];
  if (walls.hard()) return;
  choices[wall_keys().strength.name] = walls.strength;
  choices[wall_keys().exponent.name] = walls.exponent;
}

std::map<std::string, std::string> without_walls(std::map<std::string, std::string> choices) {
  for (const std::string& key :
       {wall_keys().walls.name, wall_keys().wall_rule.name, wall_keys().strength.name, wall_keys().exponent.name})
    choices.erase(key);
  return choices;
}

double on_half_lattice(double wall, double unit) { return (std::floor(wall / unit) + 0.5) * unit; }

}  // namespace hamflow
