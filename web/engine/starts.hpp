// The Poincare section of many starts of one scenario: what clicks into a section ask for. The text is read once, and
// starts run together in lanes if their steps can.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hamflow/run/ensemble.hpp"
#include "hamflow/run/section.hpp"
#include "hamflow/scenario/scenario.hpp"
#include "lane_run.hpp"

namespace hamflow {

class Starts {
 public:
  /// @param sets PATH=VALUE, one for each start
  /// @throws Rejection if a scenario has errors; Error if there is no section
  Starts(const std::string& text, const std::vector<std::string>& sets);
  ~Starts();
  /// Advances until each start that has not failed has `most` points in all, or the time is over. Forgets the points of
  /// the last call.
  void advance(std::int64_t most, double milliseconds);
  /// For each new point: the number of its start, t, all q, all p.
  const std::vector<double>& points() const { return points_; }
  std::size_t width() const { return width_; }
  /// For each start: the number of its points.
  const std::vector<std::int64_t>& counts() const { return counts_; }
  /// For each start: why it has ended; empty: it has not.
  const std::vector<std::string>& failures() const { return failures_; }
  std::int64_t step() const { return step_; }

 private:
  class Group;
  class LaneGroup;
  class Single;

  void take(std::size_t start, const SectionPoint& point);
  bool is_done() const;

  std::vector<Scenario> scenarios_;
  std::vector<std::unique_ptr<Group>> groups_;
  std::vector<double> points_;
  std::vector<std::int64_t> counts_;
  std::vector<std::string> failures_;
  std::size_t width_ = 0;
  std::int64_t most_ = 0;
  std::int64_t step_ = 0;
};

}  // namespace hamflow
