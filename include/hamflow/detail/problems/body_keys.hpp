// The keys of bodies under gravity: masses or `bodies`, G or `units`.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hamflow/core/problem_info.hpp"

namespace hamflow {

/// Names of keys of [problem] and of a body that more than one file needs.
struct BodyKeys {
  static constexpr const char* bodies = "bodies";
  static constexpr const char* units = "units";
  static constexpr const char* masses = "masses";
  static constexpr const char* constant = "gravitational_constant";
  static constexpr const char* name = "name";
  static constexpr const char* mass = "mass";
  static constexpr const char* position = "position";
  static constexpr const char* velocity = "velocity";
  static constexpr const char* primary = "primary";
  static constexpr const char* jacobi = "jacobi";
  static constexpr const char* barycentre = "barycentre";
  static constexpr const char* length = "length";
  static constexpr const char* time = "time";
};

std::vector<ParameterInfo> n_body_parameters();
/// The parameters, `units` and `bodies`.
std::span<const OptionInfo> n_body_keys();
/// The keys of a body, and of `units`.
const std::vector<OptionInfo>& body_keys();
const std::vector<OptionInfo>& unit_keys();
/// Keys of an orbit whose values are angles.
bool is_angle_key(const std::string& key);
/// Whether a problem takes `bodies` with orbital elements.
bool takes_body_list(const ProblemInfo& info);

/// G in the named units, as a formula of numbers: from the nominal G M of the Sun, Jupiter and the Earth, which are
/// exact, or for kg from G of CODATA.   [PrsaEtAl2016; TiesingaEtAl2021]
std::string gravitational_constant_in(const std::string& length, const std::string& time, const std::string& mass);

}  // namespace hamflow
