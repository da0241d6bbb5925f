// Converts states to other coordinates (charts) of the same problem: a central force in the plane (cartesian, polar), a
// double pendulum (absolute, relative). Problems declare their charts. Every conversion is canonical: momenta change
// with positions, and H keeps its value.   [Gross1999, ch. 2 and 3]
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

/// Lists all problems with several charts, and the names of the charts: "central-force has cartesian and polar; ...".
std::string what_charts_there_are();
/// @throws Error if no problem has such coordinates; the message names the allowed ones
void check_coordinates(const std::string& name);
/// Returns the same problem in the coordinates `to`. @throws Error if it does not have them; the message names problems
/// that do
std::shared_ptr<const ProblemEntry> in_coordinates(const std::shared_ptr<const ProblemEntry>& problem,
                                                   const std::string& to);
/// Returns a problem without the walls that belong to it, which exist in all its charts. Other problems are returned
/// unchanged.
std::shared_ptr<const ProblemEntry> without_own_walls(const std::shared_ptr<const ProblemEntry>& problem);
/// Returns the coordinates of an entry; empty if the problem has only one chart.
std::string coordinates_of(const ProblemEntry& problem);

/// Converts a sequence of states. If the old coordinates have no angles, a new angle continues from the previous state
/// without jumps by whole turns.
class StateConverter {
 public:
  /// Converts between two entries of one problem that differ only in their charts.
  /// @param parameters parameters of the problem; missing ones have their defaults
  StateConverter(const std::shared_ptr<const ProblemEntry>& from, const std::shared_ptr<const ProblemEntry>& to,
                 const Texts& parameters = {});
  /// Converts between charts given by name, for any problem that has both, preferably one with `size` coordinates.
  /// @throws Error if no problem has both
  StateConverter(const std::string& from, const std::string& to, std::size_t size = 0);
  /// @throws Error if the chart does not cover the state, for example polar coordinates at r = 0, or the state has
  /// another size
  CanonicalState operator()(const CanonicalState& state);
  /// @throws Error with the residual if the state or its velocity violates the constraints of its chart
  void require_on_constraints(const CanonicalState& state) const;
  /// Indices in q of the angles whose whole turns cannot be seen in the old coordinates.
  const std::vector<std::size_t>& turning() const { return turning_; }
  /// Largest change so far of such an angle between two states. Whole turns are lost above pi, so a value near pi means
  /// that the states are too far apart.
  double largest_turn() const { return largest_turn_; }

 private:
  using Entry = std::shared_ptr<const ProblemEntry>;
  explicit StateConverter(const std::pair<Entry, Entry>& charts) : StateConverter(charts.first, charts.second) {}

  Entry from_;
  Entry to_;
  Texts parameters_;
  std::vector<std::size_t> turning_;
  std::vector<double> last_;  // q of the previous state
  double largest_turn_ = 0;
};

}  // namespace hamflow
