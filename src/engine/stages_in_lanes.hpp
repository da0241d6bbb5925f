// Gauss collocation by fixed-point iteration with the stages side by side in vector registers, one in each lane, for H
// = p^T M^-1 p/2 + V(q): one evaluation of all forces is one of the recorded force on registers, and so is everything
// else of a correction. A stage reads the values of the others from their lanes (Instruction::of_lane). The bits are
// those of NaturalAverages, operation by operation.   [AntonanaMakazagaMurua2025]
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "hamflow/detail/methods/implicit/average_table.hpp"
#include "hamflow/detail/run/any_problem.hpp"
#include "numerics/program_lanes.hpp"

namespace hamflow {

/// The programs of a problem, and the numbers that they work on. Copies share the programs.
class StagesInLanes {
 public:
  using Traced = AnyProblem<Trace<double>, Capability::separable | Capability::quadratic_kinetic>;

  /// nullopt if the force has branches that cannot be guarded, or is too long (most_recorded_operations).
  /// @param table of stages   @param q, p the state at which H is recorded   @param lanes interpreted where there is no
  /// machine code for them
  static std::optional<StagesInLanes> recorded(const Traced& problem, const AverageTable<double>& table,
                                               std::span<const double> q, std::span<const double> p, LaneSet lanes);

  /// Begins a step. @param x impulses of the stages, the first guess: those of one coordinate are neighbours
  void begin(double h, std::span<const double> q, std::span<const double> p, std::span<const double> x);
  /// Corrects the impulses once. @return whether the recorded force is that of every stage
  bool correct();
  /// The largest of the corrections in units of what rounding makes of them (detail::in_units_of_noise); infinite where
  /// one is not finite.
  double size() const { return size_; }
  /// Ends the step with the last correction. @param x, dq, dp the impulses and the increments of the state   @param
  /// next impulses of the motion that continues it, the first guess of the next step
  bool end(std::span<double> x, std::span<double> dq, std::span<double> dp, std::span<double> next);
  /// After the end: the size, in the same units, of the distance of other impulses from those at the end.
  double distance_of(std::span<const double> other) const;

 private:
  /// Where values begin, in the order of their programs.
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
    std::size_t noise() const { return correction() + n; }  // what targets round by, in units of epsilon
    std::size_t unit_of() const { return noise() + n; }     // of the corrections
    std::size_t sizes() const { return unit_of() + n; }     // the largest correction in such units
    std::size_t at_end() const { return sizes() + 1; }      // impulses at the end of the step
    std::size_t d() const { return at_end() + n; }          // increments of q that they make, stage by stage
    std::size_t lost() const { return d() + n; }            // and what those have lost
    std::size_t next() const { return lost() + n; }         // impulses of the motion that continues the step
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
  std::size_t width_ = 0;  // lanes
  std::shared_ptr<const LaneLoop> displace_;
  std::shared_ptr<const LaneLoop> evaluate_;
  std::shared_ptr<const LaneLoop> finish_;
  std::vector<double> scale_;
  LaneNumbers numbers_;
  LaneNumbers no_constants_;
  double size_ = 0;
};

}  // namespace hamflow
