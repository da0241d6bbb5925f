// States in other coordinates (charts) of the same problem, as the problems declare them: a central force in the plane
// (cartesian, polar), a double pendulum (absolute, relative). Every change is canonical: momenta change with positions,
// H stays.   [Gross1999, ch. 2 and 3]
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// A canonical state.
struct CanonicalState {
  std::vector<double> q;
  std::vector<double> p;
};

/// Every problem that has several charts, with their names: "central-force has cartesian and polar; ...".
std::string what_charts_there_are();
/// @throws Error naming what is allowed when no problem has such coordinates
void check_coordinates(const std::string& name);
/// The same problem in the coordinates `to`. @throws Error when it has none such, naming which problems have some
std::shared_ptr<const ProblemEntry> in_coordinates(const std::shared_ptr<const ProblemEntry>& problem,
                                                   const std::string& to);
/// A problem without the walls that belong to it, which stand in each of its charts; any other as it is.
std::shared_ptr<const ProblemEntry> without_own_walls(const std::shared_ptr<const ProblemEntry>& problem);
/// The coordinates that an entry is in; empty where there is one chart only.
std::string coordinates_of(const ProblemEntry& problem);

/// Converts states one after the other. Where the coordinates before know no angles, an angle goes on from the state
/// before, without jumps by whole turns.
class StateConverter {
 public:
  /// Two entries of one problem that differ in their chart alone.
  /// @param parameters of the problem; missing ones take their defaults
  StateConverter(const std::shared_ptr<const ProblemEntry>& from, const std::shared_ptr<const ProblemEntry>& to,
                 const Texts& parameters = {});
  /// By name, for any problem that has both; one of so many coordinates before others. @throws Error when there is none
  StateConverter(const std::string& from, const std::string& to, std::size_t size = 0);
  /// @throws Error where a chart does not reach, for polar coordinates at r = 0, and for a state of another size
  CanonicalState operator()(const CanonicalState& state);
  /// @throws Error with the residual, for a state off the constraints of its chart, or whose motion leaves them
  void require_on_constraints(const CanonicalState& state) const;
  /// The coordinates, by their places in q, whose whole turns the states before do not show.
  const std::vector<std::size_t>& turning() const { return turning_; }
  /// The largest change of such an angle between two states met so far. Beyond pi turns may have been missed, so a
  /// value near it says that the states are too far apart.
  double largest_turn() const { return largest_turn_; }

 private:
  using Entry = std::shared_ptr<const ProblemEntry>;
  explicit StateConverter(const std::pair<Entry, Entry>& charts) : StateConverter(charts.first, charts.second) {}

  Entry from_;
  Entry to_;
  Texts parameters_;
  std::vector<std::size_t> turning_;
  std::vector<double> last_;  // q of the state before
  double largest_turn_ = 0;
};

}  // namespace hamflow
