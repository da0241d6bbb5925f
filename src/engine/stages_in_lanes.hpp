// Gauss collocation by fixed-point iteration for H = p^T M^-1 p/2 + V(q), with one stage in each lane of vector
// registers. One evaluation of the recorded force on registers gives the forces of all stages, and the rest of a
// correction works the same way. A stage reads the values of others from their lanes (Instruction::of_lane). The
// operations, and so the bits, are those of NaturalAverages.   [AntonanaMakazagaMurua2025]
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "hamflow/detail/methods/implicit/average_table.hpp"
#include "hamflow/detail/run/any_problem.hpp"
#include "numerics/program_lanes.hpp"

namespace hamflow {

/// The programs for a problem and their numbers. Copies share the programs.
class StagesInLanes {
 public:
  using Traced = AnyProblem<Trace<double>, Capability::separable | Capability::quadratic_kinetic>;

  /// Records the programs. Returns nullopt if the force has branches that cannot be guarded, or is longer than
  /// most_recorded_operations.
  /// @param table the coefficients of the stages   @param q, p the state at which H is recorded
  /// @param lanes the instruction set; programs are interpreted if it is not available
  static std::optional<StagesInLanes> recorded(const Traced& problem, const AverageTable<double>& table,
                                               std::span<const double> q, std::span<const double> p, LaneSet lanes);

  /// Begins a step. @param x the initial guess: the impulses of the stages, with those of one coordinate adjacent
  void begin(double h, std::span<const double> q, std::span<const double> p, std::span<const double> x);
  /// Corrects the impulses once. @return whether the guards of the recorded force hold at every stage
  bool correct();
  /// The largest correction in units of its rounding error (detail::in_units_of_noise); infinite if a correction is not
  /// finite.
  double size() const { return size_; }
  /// Ends the step with the last correction. @param x, dq, dp receive the impulses and the increments of the state
  /// @param next receives the extrapolated impulses, which are the initial guess of the next step
  bool end(std::span<double> x, std::span<double> dq, std::span<double> dp, std::span<double> next);
  /// After end(): returns the distance of other impulses from the final ones, in the same units as size().
  double distance_of(std::span<const double> other) const;

 private:
  /// The places of values, in the order of the programs.
  struct Layout {
    std::size_t n = 0;
    std::size_t k = 0;
    static constexpr std::size_t unit = 0;    // h/kappa
    static constexpr std::size_t length = 1;  // |h|
    static constexpr std::size_t q0 = 2;
    std::size_t p0() const { return q0 + n; }
    std::size_t x() const { return p0() + n; }
    std::size_t u() const { return x() + n; }  // displacements
    std::size_t correction() const { return u() + n; }
    std::size_t noise() const { return correction() + n; }  // rounding errors of the targets, in units of epsilon
    std::size_t unit_of() const { return noise() + n; }     // units of the corrections
    std::size_t sizes() const { return unit_of() + n; }     // the largest correction in these units
    std::size_t at_end() const { return sizes() + 1; }      // impulses at the end of the step
    std::size_t d() const { return at_end() + n; }          // increments of q from them, stage by stage
    std::size_t lost() const { return d() + n; }            // rounding errors of these increments
    std::size_t next() const { return lost() + n; }         // extrapolated impulses of the next step
    std::size_t reach() const { return next() + n; }        // h beta_j
    std::size_t weight() const { return reach() + 1; }
    std::size_t unit_weight() const { return weight() + 1; }
    std::size_t coupling() const { return unit_weight() + 1; }  // k columns
    std::size_t inner() const { return coupling() + k; }
    std::size_t factor() const { return inner() + k; }
    std::size_t continuing() const { return factor() + k; }
    std::size_t size() const { return continuing() + k; }
  };
  class Recording;

  double* row(std::size_t value) { return numbers_.data() + value * width_; }
  const double* row(std::size_t value) const { return numbers_.data() + value * width_; }
  bool run(const LaneLoop& program);
  double measured() const;

  Layout at_;
  std::size_t width_ = 0;  // number of lanes
  std::shared_ptr<const LaneLoop> displace_;
  std::shared_ptr<const LaneLoop> evaluate_;
  std::shared_ptr<const LaneLoop> finish_;
  std::vector<double> scale_;
  LaneNumbers numbers_;
  LaneNumbers no_constants_;
  double size_ = 0;
};

}  // namespace hamflow
