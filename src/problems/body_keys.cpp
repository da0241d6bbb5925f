#include "hamflow/detail/problems/body_keys.hpp"

#include <algorithm>
#include <map>

namespace hamflow {

namespace {

/// Units and their sizes in SI, as formulas of numbers.
using Sizes = std::vector<std::pair<std::string, std::string>>;

const Sizes& lengths() {
  static const Sizes all{
      {"m", "1"}, {"km", "1000"}, {"AU", "149597870700"}, {"R_earth", "6378100"}, {"pc", "(648000/pi*149597870700)"}};
  return all;
}
const Sizes& times() {
  static const Sizes all{{"s", "1"}, {"day", "86400"}, {"yr", "31557600"}, {"Myr", "31557600e6"}};
  return all;
}
/// G times the mass.
const Sizes& masses() {
  static const Sizes all{
      {"kg", "6.67430e-11"}, {"Msun", "1.3271244e20"}, {"Mjupiter", "1.2668653e17"}, {"Mearth", "3.986004e14"}};
  return all;
}

std::vector<std::string> names_of(const Sizes& sizes) {
  std::vector<std::string> names;
  for (const auto& [name, size] : sizes) names.push_back(name);
  return names;
}

const std::string& size_of(const std::string& name, const Sizes& sizes) {
  return std::find_if(sizes.begin(), sizes.end(), [&](const auto& unit) { return unit.first == name; })->second;
}

OptionInfo unit_key(const char* name, const Sizes& sizes, const char* meaning, const char* example) {
  return {.name = name,
          .meaning = meaning,
          .type = OptionType::word,
          .required = true,
          .words = names_of(sizes),
          .example = example};
}

OptionInfo element(const char* name, const char* usual, const char* meaning, const Range& range = Range::any,
                   const char* unset = "") {
  return {.name = name, .default_value = usual, .meaning = meaning, .range = range, .unset = unset};
}

/// An angle is a number in radians or a text with a unit.
OptionInfo angle_element(const char* name, const char* usual, const char* meaning, const char* unset = "") {
  OptionInfo key = element(name, usual, meaning, Range::any, unset);
  key.unit = "radians, or a text such as \"20 deg\"";
  return key;
}

OptionInfo vector_key(const char* name, const char* meaning) {
  return {.name = name, .meaning = meaning, .type = OptionType::list, .unset = "from the orbit"};
}

}  // namespace

const std::vector<OptionInfo>& unit_keys() {
  static const std::vector<OptionInfo> keys{
      unit_key(BodyKeys::length, lengths(), "unit of length (R_earth: 6378.1 km)", "AU"),
      unit_key(BodyKeys::time, times(), "unit of time (yr: 365.25 days)", "day"),
      unit_key(BodyKeys::mass, masses(), "unit of mass", "Msun")};
  return keys;
}

const std::vector<OptionInfo>& body_keys() {
  static const std::vector<OptionInfo> keys{
      {.name = BodyKeys::name,
       .meaning = "name of the body, in messages, columns and `primary`",
       .type = OptionType::text,
       .unset = "body1, body2, ..."},
      {.name = BodyKeys::mass,
       .meaning = "mass; 0: the body feels the others and is felt by none",
       .range = Range::not_negative,
       .required = true,
       .example = "1"},
      element("a", "", "semi-major axis, negative for a hyperbola", Range::any,
              "period or pericentre_distance gives the size"),
      element("period", "", "period of an ellipse, in place of a", Range::positive, "a or pericentre_distance"),
      element("pericentre_distance", "", "in place of a, for every conic, and the only size with e = 1",
              Range::positive, "a or period"),
      element("e", "0", "eccentricity; above 1 for a hyperbola", Range::not_negative),
      angle_element("inclination", "0", "from 0 to pi"),
      angle_element("node", "0", "longitude of the ascending node"),
      angle_element("pericentre", "0", "argument of the pericentre, from the node"),
      angle_element("longitude_of_pericentre", "", "node + pericentre, in place of pericentre", "pericentre"),
      angle_element("mean_anomaly", "0", "place on the orbit; for a hyperbola e sinh F - F"),
      angle_element("true_anomaly", "", "place on the orbit, in place of mean_anomaly", "mean_anomaly"),
      angle_element("eccentric_anomaly", "", "place on the orbit, in place of mean_anomaly; for a hyperbola F",
                    "mean_anomaly"),
      angle_element("mean_longitude", "", "longitude of the pericentre + mean anomaly, in place of mean_anomaly",
                    "mean_anomaly"),
      element("time_of_pericentre", "",
              "time at which the body passes its pericentre, in place of mean_anomaly; the run "
              "starts at t = 0",
              Range::any, "mean_anomaly"),
      {.name = BodyKeys::primary,
       .default_value = BodyKeys::jacobi,
       .meaning =
           "what the orbit is about. jacobi: the centre of mass of the bodies before this one; the name of a body "
           "before this one; barycentre: the centre of mass of all",
       .type = OptionType::text},
      vector_key(BodyKeys::position, "2 or 3 numbers, in place of an orbit, together with velocity"),
      vector_key(BodyKeys::velocity, "as many numbers as position has")};
  return keys;
}

bool is_angle_key(const std::string& key) {
  static const std::vector<std::string> all{
      "inclination",  "node",         "pericentre",        "longitude_of_pericentre",
      "mean_anomaly", "true_anomaly", "eccentric_anomaly", "mean_longitude"};
  return std::find(all.begin(), all.end(), key) != all.end();
}

std::vector<ParameterInfo> n_body_parameters() {
  return {{.name = BodyKeys::masses,
           .meaning = "masses, one for each body; a body of mass 0 feels the others and is felt by none",
           .range = Range::not_negative,
           .type = OptionType::list,
           .required = true,
           .condition = "without bodies"},
          {.name = BodyKeys::constant, .default_value = "1", .meaning = "G", .condition = "without units"},
          {"softening", "0", "length", Range::not_negative}};
}

std::span<const OptionInfo> n_body_keys() {
  static const std::vector<OptionInfo> keys = [] {
    std::vector<OptionInfo> all = n_body_parameters();
    all.push_back({.name = BodyKeys::units,
                   .meaning = "names G, in place of gravitational_constant",
                   .type = OptionType::table,
                   .unset = "the units of the input",
                   .keys = unit_keys()});
    all.push_back({.name = BodyKeys::bodies,
                   .meaning = "bodies by orbital elements or by position and velocity, in place of masses and initial; "
                              "frame is then barycentric without the key",
                   .type = OptionType::table,
                   .unset = "masses and initial",
                   .example = "[{ name = \"Sun\", mass = 1 }, { name = \"Earth\", mass = 3e-6, a = 1, e = 0.0167 }]",
                   .keys = body_keys()});
    return all;
  }();
  return keys;
}

bool takes_body_list(const ProblemInfo& info) { return find_option(info.keys, BodyKeys::bodies) != nullptr; }

std::string gravitational_constant_in(const std::string& length, const std::string& time, const std::string& mass) {
  return size_of(mass, masses()) + "*" + size_of(time, times()) + "^2/" + size_of(length, lengths()) + "^3";
}

}  // namespace hamflow
