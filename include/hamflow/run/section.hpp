// Poincare sections: the states in which x, a coordinate or an expression, passes a value. Between two steps with
// opposite signs of x - value, x(Psi_tau(z_n)) = value is solved for tau to rounding, with partial steps of the method,
// so that a point of the section lies on the same energy level as the steps.
//
// Steps that are long compared with the motion, as those with adaptive sub-steps can be, are divided into pieces by
// halving, until five points of each lie on a cubic. All crossings between these points are found, too.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hamflow/detail/run/expression_in_digits.hpp"
#include "hamflow/detail/run/state_expression.hpp"
#include "hamflow/run/observer.hpp"

namespace hamflow {

struct Section {
  std::size_t coordinate = 0;  // index in q or p; for an expression the first coordinate in it, if any
  bool momentum = false;
  double value = 0;
  std::string value_text{};                     // the value as text, for runs beyond double; empty: the double
  ExpressionInDigits in_digits{};               // the expression, for runs beyond double
  int direction = 1;                            // 1: x increases along the run, -1: it decreases, 0: both
  std::optional<StateExpression> expression{};  // x, instead of the coordinate
  bool is_stroboscopic = false;                 // x is an expression of t, and the points are stroboscopic
  bool by_steps = false;    // for a map: the point is the state after the step that passes the value
  bool every_step = false;  // for a map: every step is a point; by_steps and is_stroboscopic are true, too
};

struct SectionPoint {
  double time = 0;
  std::vector<double> q;
  std::vector<double> p;
  double residual = 0;   // |x - value|
  FrameDigits digits{};  // time, q and p in arithmetic beyond double; else empty
};

/// The message about changes of sign that are not points of a section or events.
std::string jumps_text(std::int64_t jumps);

/// Finds the points of a section in given steps. A start on the section is not a point. A touch, x = value without a
/// change of sign, is a point if x approaches from the side of `direction`: from below for direction 1. Two crossings
/// between which |x - value| stays below 2^-44 of its size in the step count as one touch.
class SectionSearch {
 public:
  SectionSearch(Section section, std::function<void(const SectionPoint&)> found)
      : section_(std::move(section)), found_(std::move(found)) {}
  const Section& section() const { return section_; }
  /// x - value.
  double distance(const Frame& frame) const;
  /// Whether a step with these values of x - value at its ends has a point.
  bool crosses(double before, double now) const {
    if (!(before != 0 && (now == 0 || (now > 0) != (before > 0)))) return false;
    return section_.direction == 0 || section_.direction == (before < 0 ? 1 : -1);
  }
  /// Whether a step may have more zeros than the signs at its ends show, that is, whether these are possible with four
  /// times the second derivative estimated from the last two differences of x. True if there is no earlier difference.
  /// Call this once for every step, in order. @param bounced the step has bounces, so that its difference predicts
  /// nothing
  bool may_hide_zeros(double before, double now, bool bounced = false);
  /// For a map: records the state after a step, if it is a point.
  void take_step(double before, double now, const Frame& behind) {
    if (section_.every_step || crosses(before, now)) {
      take({behind.time, behind.q, behind.p, section_.every_step ? 0 : std::abs(now), behind.digits});
    }
  }
  /// Locates the point of a step. @param before_step the simulation before the step @param before, now x - value before
  /// and after the step
  void locate(const Simulation& before_step, double before, double now);
  /// Locates all points of a step that may be long. A single point gets the same digits as from locate().
  /// @param frame the state after the step @param bounced the step has bounces; with some wall rules the run does not
  /// follow the partial steps that are evaluated, but no point is missed
  void locate_all(const Simulation& before_step, double before, const Frame& frame, double now, bool bounced = false);
  /// Searches for the first point in a step that fails, as far as partial steps succeed.
  void locate_in_failed_step(const Simulation& before_step, double before);
  /// For a method without adaptive sub-steps: tests whether the next step is long compared with the motion. All steps
  /// count as long from the first such step on. A single bounce or jump does not make a step long.
  void measure(const Simulation& before_step) { is_long_ = is_long_ || is_long(before_step); }
  /// Whether to call measure() after this step.
  bool is_to_measure(std::int64_t step) const { return !is_long_ && step % steps_between == 0; }
  /// Whether steps are long, and locate_all() finds their points.
  bool is_long() const { return is_long_; }
  /// Ends the search.
  void give_up() { failed_ = true; }
  std::int64_t points() const { return points_; }
  double max_residual() const { return max_residual_; }
  /// The number of changes of sign that were not zeros: the expression jumps or has a pole there.
  std::int64_t jumps() const { return jumps_; }
  /// Whether a step of the search failed; no points are searched for after that.
  bool failed() const { return failed_; }
  /// The message about changes of sign that were not points and about a failed search; may be empty.
  std::string message() const;
  /// The number of steps that were too long to be searched completely: pairs of crossings in them may have been missed.
  std::int64_t unseen() const { return unseen_; }
  template <class Archive>
  void archive(Archive& ar) {
    ar(failed_, points_, jumps_, max_residual_, unseen_, is_long_, last_change_, last_bend_, before_last_);
  }

 private:
  /// A state within a step.
  struct Sample {
    double theta = 0;
    double x = 0;               // x - value
    std::vector<double> state;  // q and p
  };
  /// An interval in which x - value changes its sign; from == to for a touch.
  struct Change {
    double from, to, before, now;
  };
  /// A part of a step, with five equidistant samples.
  using Piece = std::array<Sample, 5>;

  static constexpr std::int64_t steps_between = 256;
  bool is_long(const Simulation& before_step);
  Sample sample(const Simulation& before_step, double theta);
  Sample sample_of(double theta, const Frame& frame) const;
  /// Fills in the samples between the ends and the middle.
  void complete(const Simulation& before_step, Piece& piece);
  bool is_cubic(const Simulation& before_step, const Piece& piece, double parts);
  bool has(const Piece& piece, const std::array<double, 5>& weights, const Sample& sample, double parts) const;
  void see(const Simulation& before_step, Piece& piece, int depth);
  void see_between(const Simulation& before_step, const Piece& piece, std::size_t k);
  void note_change(double from, double to, double before, double now);
  void note_touch(double theta, double before) { changes_.push_back({theta, theta, before, 0}); }
  void take(const SectionPoint& point);
  void locate(const Simulation& before_step, const Change& change);
  void refine(const Simulation& before_step, SectionPoint& point) const;

  Section section_;
  std::function<void(const SectionPoint&)> found_;
  bool failed_ = false;
  std::int64_t points_ = 0;
  std::int64_t jumps_ = 0;
  double max_residual_ = 0;
  std::int64_t unseen_ = 0;
  bool is_long_ = false;
  // The difference of x over the last step, and over the step before; NaN if there is none.
  double last_change_ = std::numeric_limits<double>::quiet_NaN();
  double last_bend_ = std::numeric_limits<double>::quiet_NaN();
  double before_last_ =
      std::numeric_limits<double>::quiet_NaN();  // x - value one step before the start of the present step
  Frame partial_;
  std::vector<Change> changes_;  // changes of sign in the present step
  int looks_ = 0;                // partial steps evaluated in it
  bool too_coarse_ = false;
};

/// Finds the points of a section during a run, without changing it. It observes every step, so that the run goes in
/// blocks of one step, at some hundred nanoseconds per step. It searches steps that may have hidden zeros, that consist
/// of several adaptive sub-steps, or that have bounces, where x may jump. With other methods it tests a step now and
/// then, and searches all steps from the first long one on.
class SectionFinder final : public Observer {
 public:
  /// @param simulation the observed simulation
  SectionFinder(const Simulation& simulation, const Section& section, std::function<void(const SectionPoint&)> found);
  std::int64_t next_due(std::int64_t step) const override { return failed() ? never : step; }
  Verdict observe(const Frame& frame) override;
  /// Searches for the first point in the step that failed, from the present state on.
  void look_into_failed_step() {
    if (begun_ && !search_.section().by_steps) search_.locate_in_failed_step(simulation_, before_);
  }
  void archive(Writer& ar) override { fields(ar); }
  void archive(Reader& ar) override;
  std::int64_t points() const { return search_.points(); }
  double max_residual() const { return search_.max_residual(); }
  std::int64_t jumps() const { return search_.jumps(); }
  bool failed() const { return search_.failed(); }
  std::int64_t unseen() const { return search_.unseen(); }
  const SectionSearch& search() const { return search_; }

 private:
  template <class Archive>
  void fields(Archive& ar) {
    ar(before_, begun_, work_, search_);
  }

  const Simulation& simulation_;
  SectionSearch search_;
  std::unique_ptr<Simulation> copy_;  // at most some steps behind
  double before_ = 0;                 // x - value at the last step
  bool begun_ = false;
  bool has_own_substeps_;
  int order_;
  long long work_ = 0;        // evaluations up to the last step; for a map the number of that step
  std::int64_t bounces_ = 0;  // bounces up to the last step
};

}  // namespace hamflow
