// Poincare sections: the states in which a coordinate, or an expression, x passes a value, found on partial steps.
// Between two steps of opposite sign of x - value the time tau is solved for on Psi_tau(z_n) itself, to rounding, so
// that a point of the section lies on the energy level of the method like any of its steps.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "hamflow/run/observer.hpp"
#include "hamflow/run/state_expression.hpp"

namespace hamflow {

struct Section {
  std::size_t coordinate = 0;  // of q, or of p; beside an expression the first of which it is made, if it is
  bool momentum = false;
  double value = 0;
  int direction = 1;                            // 1: x increases along the run, -1: it decreases, 0: both
  std::optional<StateExpression> expression{};  // x, in place of the coordinate
  bool by_time_alone = false;                   // x is an expression of t, and the points are stroboscopic
};

struct SectionPoint {
  double time = 0;
  std::vector<double> q;
  std::vector<double> p;
  double residual = 0;  // |x - value|
};

/// Finds the points of a section between steps that it is told. A start on the section is not counted as a point; an
/// even number of crossings within one step is not seen.
class SectionSearch {
 public:
  SectionSearch(Section section, std::function<void(const SectionPoint&)> found)
      : section_(std::move(section)), found_(std::move(found)) {}
  const Section& section() const { return section_; }
  /// x - value.
  double distance(const Frame& frame) const;
  /// Whether there is a point in a step that changes x - value in this way.
  bool crosses(double before, double now) const {
    if (!(before != 0 && (now == 0 || (now > 0) != (before > 0)))) return false;
    return section_.direction == 0 || section_.direction == (before < 0 ? 1 : -1);
  }
  /// Finds it.   @param before_step as it is before the step   @param before, now x - value before the step and behind
  void locate(const Simulation& before_step, double before, double now);
  /// Seeks no more.
  void give_up() { failed_ = true; }
  std::int64_t points() const { return points_; }
  double max_residual() const { return max_residual_; }
  /// Changes of sign that were no zeros: the expression jumps there, or has a pole.
  std::int64_t jumps() const { return jumps_; }
  /// Whether a step of the search failed: no points are sought after that.
  bool failed() const { return failed_; }
  template <class Archive>
  void archive(Archive& ar) {
    ar(failed_, points_, jumps_, max_residual_);
  }

 private:
  Section section_;
  std::function<void(const SectionPoint&)> found_;
  bool failed_ = false;
  std::int64_t points_ = 0;
  std::int64_t jumps_ = 0;
  double max_residual_ = 0;
  Frame partial_;
};

/// Finds the points of a section during a run, which it does not change. Looks at every step: the run then goes in
/// blocks of one, some hundred nanoseconds a step.
class SectionFinder final : public Observer {
 public:
  /// @param simulation the simulation that is observed
  SectionFinder(const Simulation& simulation, const Section& section, std::function<void(const SectionPoint&)> found);
  std::int64_t next_due(std::int64_t step) const override { return failed() ? never : step; }
  Verdict observe(const Frame& frame) override;
  void archive(Writer& ar) override { fields(ar); }
  void archive(Reader& ar) override;
  std::int64_t points() const { return search_.points(); }
  double max_residual() const { return search_.max_residual(); }
  std::int64_t jumps() const { return search_.jumps(); }
  bool failed() const { return search_.failed(); }

 private:
  template <class Archive>
  void fields(Archive& ar) {
    ar(before_, begun_, search_);
  }

  const Simulation& simulation_;
  SectionSearch search_;
  std::unique_ptr<Simulation> copy_;  // at most some steps behind
  double before_ = 0;                 // x - value at the last step
  bool begun_ = false;
};

}  // namespace hamflow
