// States in other coordinates of the same problem: a central force in the plane (cartesian, polar), a double pendulum
// (absolute, relative). Every change is canonical: momenta change with positions, H stays.   [Gross1999, ch. 2 and 3]
#pragma once

#include <map>
#include <string>
#include <vector>

namespace hamflow {

/// A canonical state.
struct CanonicalState {
  std::vector<double> q;
  std::vector<double> p;
};

/// Every name of a coordinate system.
const std::vector<std::string>& coordinate_systems();
/// The key of [problem] that chooses it: "coordinates" or "angles". @throws Error naming what is allowed
std::string coordinate_key(const std::string& system);
/// The system that a problem with these selecting keys has, to be converted to `to`.
/// @throws Error when the problem has no such coordinates, saying which problems have some
std::string present_system(const std::string& problem, const std::map<std::string, std::string>& variant,
                           const std::string& to);

/// Converts states one after the other. phi goes on from the state before, without jumps by whole turns.
class StateConverter {
 public:
  /// @throws Error when there is no way from one to the other
  StateConverter(std::string from, std::string to);
  /// @throws Error at r = 0, where polar coordinates do not exist, and for a state that has not two coordinates
  CanonicalState operator()(const CanonicalState& state);
  /// The largest change of phi between two states met so far. Beyond pi turns may have been missed, so a value near it
  /// says that the states are too far apart.
  double largest_turn() const { return largest_turn_; }

 private:
  CanonicalState to_polar_continuously(const CanonicalState& state);

  std::string from_;
  std::string to_;
  bool begun_ = false;
  double phi_ = 0;
  double largest_turn_ = 0;
};

}  // namespace hamflow
