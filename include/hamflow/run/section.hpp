// Poincare sections: the states in which a coordinate, or an expression, x passes a value, found on partial steps.
// Between two steps of opposite sign of x - value the time tau is solved for on Psi_tau(z_n) itself, to rounding, so
// that a point of the section lies on the energy level of the method like any of its steps.
//
// Steps that are long beside the motion, as those may be that are made of sub-steps of the method's own, are seen in
// pieces: halved until five points of each are on a cubic, and with whatever crosses between them out and back.
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
  std::size_t coordinate = 0;  // of q, or of p; beside an expression the first of which it is made, if it is
  bool momentum = false;
  double value = 0;
  std::string value_text{};                     // of the value, for runs beyond double; empty: the double
  ExpressionInDigits in_digits{};               // the expression, for runs beyond double
  int direction = 1;                            // 1: x increases along the run, -1: it decreases, 0: both
  std::optional<StateExpression> expression{};  // x, in place of the coordinate
  bool by_time_alone = false;                   // x is an expression of t, and the points are stroboscopic
  bool by_steps = false;    // of a map: the state behind the step that passes the value is the point
  bool every_step = false;  // of a map: every step is a point; by_steps and by_time_alone hold too
};

struct SectionPoint {
  double time = 0;
  std::vector<double> q;
  std::vector<double> p;
  double residual = 0;   // |x - value|
  FrameDigits digits{};  // time, q and p in arithmetic beyond double; else empty
};

/// Of changes of sign that are no points of a section and no events.
std::string jumps_text(std::int64_t jumps);

/// Finds the points of a section between steps that it is told. A start on the section is not counted as a point. A
/// touch, x = value without a change of sign, is a point that is approached from its own side: with direction 1 from
/// below. Two crossings between which |x - value| stays below 2^-44 of its size in the step are one touch.
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
  /// Whether a step may hold more zeros than the signs at its ends show: whether they fit under a second derivative of
  /// four times what the last two differences of x show. True of a step that has no difference before it. To be called
  /// once for every step, in their order.   @param bounced the step has bounces: its difference predicts nothing
  bool may_hide_zeros(double before, double now, bool bounced = false);
  /// Of a map: takes the state behind a step, if it is a point.
  void take_step(double before, double now, const Frame& behind) {
    if (section_.every_step || crosses(before, now)) {
      take({behind.time, behind.q, behind.p, section_.every_step ? 0 : std::abs(now), behind.digits});
    }
  }
  /// Finds it.   @param before_step as it is before the step   @param before, now x - value before the step and behind
  void locate(const Simulation& before_step, double before, double now);
  /// Finds all points of a step that may be long. One that is alone has the digits that locate() finds.
  /// @param frame behind the step   @param bounced it has bounces: under some rules the run did not go through the
  /// parts that are looked at, and nothing is missed by that
  void locate_all(const Simulation& before_step, double before, const Frame& frame, double now, bool bounced = false);
  /// Looks for the first point in a step that fails, as far into it as partial steps lead.
  void locate_in_failed_step(const Simulation& before_step, double before);
  /// Now and then looks into the step that follows, of a method without sub-steps of its own: from the first that is
  /// long beside the motion on, all are. No single bounce or jump makes one long.
  void measure(const Simulation& before_step) { is_long_ = is_long_ || is_long(before_step); }
  /// Whether to do so behind so many steps.
  bool is_to_measure(std::int64_t step) const { return !is_long_ && step % steps_between == 0; }
  /// Whether steps are long, and locate_all() finds their points.
  bool is_long() const { return is_long_; }
  /// Seeks no more.
  void give_up() { failed_ = true; }
  std::int64_t points() const { return points_; }
  double max_residual() const { return max_residual_; }
  /// Changes of sign that were no zeros: the expression jumps there, or has a pole.
  std::int64_t jumps() const { return jumps_; }
  /// Whether a step of the search failed: no points are sought after that.
  bool failed() const { return failed_; }
  /// What is to be said of changes of sign that were no points, and of a search that has failed; empty: nothing.
  std::string message() const;
  /// Long steps into which nobody could look closely enough: even numbers of crossings in them may have been missed.
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
  /// Where x - value changes its sign; from == to of a touch.
  struct Change {
    double from, to, before, now;
  };
  /// The part of a step between five equidistant samples.
  using Piece = std::array<Sample, 5>;

  static constexpr std::int64_t steps_between = 256;
  bool is_long(const Simulation& before_step);
  Sample sample(const Simulation& before_step, double theta);
  Sample sample_of(double theta, const Frame& frame) const;
  /// Fills in what is between the ends and the middle.
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
  // The differences of x over the last step, and between the last two; NaN where there are none.
  double last_change_ = std::numeric_limits<double>::quiet_NaN();
  double last_bend_ = std::numeric_limits<double>::quiet_NaN();
  double before_last_ = std::numeric_limits<double>::quiet_NaN();  // x - value one step before the present one begins
  Frame partial_;
  std::vector<Change> changes_;  // of the present step
  int looks_ = 0;                // into it
  bool too_coarse_ = false;
};

/// Finds the points of a section during a run, which it does not change. Looks at every step: the run then goes in
/// blocks of one, some hundred nanoseconds a step. It looks into those that may hide zeros, that were made of several
/// sub-steps of the method's own, or that have bounces, where x may jump; of other methods now and then into one, and
/// into all from the first that is long.
class SectionFinder final : public Observer {
 public:
  /// @param simulation the simulation that is observed
  SectionFinder(const Simulation& simulation, const Section& section, std::function<void(const SectionPoint&)> found);
  std::int64_t next_due(std::int64_t step) const override { return failed() ? never : step; }
  Verdict observe(const Frame& frame) override;
  /// Looks for the first point in the step that failed, from the present state on.
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
  long long work_ = 0;        // evaluations up to the last step; of a map the number of that step
  std::int64_t bounces_ = 0;  // up to there
};

}  // namespace hamflow
