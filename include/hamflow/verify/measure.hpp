// Measures the properties of a step and compares them with the claims of the method.
//   order                     slope of the global error against a reference of another family, in long double
//   symplectic                |Psi'^T J Psi' - J|, Psi' exact
//   weakly time-reversible    |S Psi_-h S z - Psi_h z|
//   time-symmetric            |Psi_-h Psi_h z - z|
//   time-reversible           |S Psi_h S Psi_h z - z|
//   energy                    level, drift class and dependence on the step size of |H - H0|
//   cost                      evaluations and solves per step
// Every property is measured on nonlinear problems, with a step so large that a method without the property shows a
// defect many orders above rounding. Thresholds are multiples of epsilon times the size of the terms. Defects between
// the thresholds make a property `unclear`.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hamflow/detail/run/step_map.hpp"
#include "hamflow/detail/verify/drift.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow {

enum class Finding { no, unclear, yes };

constexpr std::string_view name(Finding finding) {
  return finding == Finding::yes ? "yes" : finding == Finding::no ? "no" : "unclear";
}

/// Region for measurements: states around a generic state of a problem, and a step size that is large but safe there.
struct Region : RegionInfo {
  std::string problem;
  std::map<std::string, std::string> variant{};  // for example potential = kepler
  std::optional<Walls> walls{};
  bool of_bodies = false;    // a region of bodies: states are moved into the frame of their centre of mass
  bool constrained = false;  // states are moved onto the constraints
};

inline std::shared_ptr<const ProblemEntry> find_problem(const Region& region) {
  return find_problem(region.problem, region.variant, region.walls);
}

struct OrderMeasurement {
  static constexpr int fewest_points = 5;    // four halvings of h
  static constexpr double tolerance = 0.15;  // allowed deviation of the slope from the order
  // d log(error)/d log(h); infinite if every error is at rounding level, NaN if fewer than two errors were measured
  double slope = std::numeric_limits<double>::quiet_NaN();
  int points = 0;                                                 // number of points in the fit
  double finest_step = std::numeric_limits<double>::quiet_NaN();  // smallest step size in the fit, and its error
  double finest_error = std::numeric_limits<double>::quiet_NaN();
  std::string reason{};  // why there are too few points
  Finding is(int order) const;
};

struct DefectMeasurement {
  double defect = 0;  // largest defect over the states; NaN if no step succeeded
  double units = 0;   // largest defect divided by eps times the size of the terms
  Finding holds = Finding::unclear;
  std::string reason{};  // which steps failed
};

struct EnergyMeasurement {
  double step = 0;
  double level = 0;     // max |H - H0|/scale over starts and blocks; NaN if a run ended early
  double rounding = 0;  // level that rounding alone explains
  // the same with a 128 times smaller step, which shows rounding errors that a step divides by h
  double fine_level = 0;
  double fine_rounding = 0;
  double step_exponent = 0;  // c in level ~ h^c over a fixed time; NaN if too few step sizes give more than rounding
  DriftStatistics drift;
  std::string reason{};  // which runs ended early
  /// yes: at rounding level without drift. up_to_quadrature: above rounding, but it decreases faster with h than the
  /// error of the method. nullopt: unknown, because runs ended early. @param order order of the method
  std::optional<Conservation> conserving(int order, bool even_in_momenta = true) const;
};

/// Numbers are NaN if not all steps succeeded.
struct CostMeasurement {
  double force = 0, gradient = 0, hessian = 0, linear_solves = 0;  // number per step
  // yes: no linear solves, and every step costs the same
  Finding explicit_step = Finding::no;
  double coarse_solves = 0;  // linear solves per step, at four times the step size of the region
  std::string reason{};      // which steps failed
};

/// Measurements of one method on one problem.
struct Measurement {
  std::string problem;
  OrderMeasurement order;
  DefectMeasurement jacobian;  // compares the exact Jacobian with divided differences of the step
  DefectMeasurement symplectic, weakly_reversible, symmetric, reversible;
  bool even_in_momenta = true;  // H(q, -p) = H(q, p); otherwise negating the momenta does not reverse the exact motion
  EnergyMeasurement energy;
  CostMeasurement cost;
};

/// One property: the claim, the measurement, and whether they agree.
struct PropertyCell {
  std::string property;
  std::string claimed;
  std::string measured;
  Finding agrees = Finding::unclear;
  std::string reason{};  // why the property was not measured
};

/// Certificate of a method.
struct MethodCertificate {
  struct Map {
    std::string problem;
    std::string name;
    std::int64_t steps = 0;
    double max_error = 0;  // NaN: no step was taken
    double relative = 0;
    double rounding = 0;
    std::optional<bool> conserved{};  // nullopt: undecided; `reason` says why
    std::string reason{};
  };
  struct Return {
    std::string problem;
    std::int64_t steps = 0;
    double distance = 0;  // relative to the largest coordinate of the start
    bool measured = false;
    std::string proves;  // one of the texts of name(ReversalProof)
    std::string reason;
  };
  // The worst class over the problems, each with an ensemble of starts. nullopt: undecided on one problem and linear on
  // none.
  std::optional<DriftClass> drift = DriftClass::bounded;
  std::vector<Map> momentum_maps;
  std::vector<Return> reversals;
};

/// The claims of one method and its measurements.
struct PropertyRow {
  MethodInfo claims;
  std::vector<Measurement> on;  // one for each problem
  std::vector<PropertyCell> cells;
  MethodCertificate certificate{};
  std::string measured_as{};  // the method with options for which its step has an order; empty: as requested
  /// yes: every property agrees; no: at least one differs; unclear: otherwise.
  Finding verdict() const;
  bool agrees() const { return verdict() == Finding::yes; }
  bool has(std::string_view property) const;
  /// Returns the names of the properties that do not agree, joined by commas.
  std::string differing() const;
  const PropertyCell& operator[](std::string_view property) const;
};

/// A step may need this many corrections if Newton's iteration converges quadratically: an initial guess that is right
/// to a factor of 2 has the error 2^(-2^k) after k corrections, and 2^-64 is below the rounding of a double.
inline constexpr int most_newton_corrections = 6;

OrderMeasurement measure_order(const StepMap& map, const Region& region);
EnergyMeasurement measure_energy(const StepMap& map, const Region& region);
CostMeasurement measure_cost(const StepMap& map, const Region& region);
Measurement measure(const StepMap& map, const Region& region);
/// Compares claims with measurements. One problem suffices to refute a claim. A property that the method does not claim
/// has to be missing on at least one of two or more problems; on a single problem its presence proves nothing.
PropertyRow judge(const MethodInfo& claims, std::vector<Measurement> on);

/// Takes the drift class from the measurements, and makes further runs for momentum maps and reversals. Momentum maps
/// are measured on the regions, and also on the Kepler ellipse and on three bodies if the method can run there.
/// Reversals are measured on the regions.
MethodCertificate certificate_of(const MethodSpec& method, std::span<const Region> regions,
                                 std::span<const Measurement> on);

/// Returns the k-th random state of the region.
State<double> random_state(const Region& region, std::uint64_t k);
/// Returns the region that a problem of the catalogue declares; usual_problem() chooses what the variant leaves open.
/// If the problem declares none, the region surrounds the default start, or any state. @throws Error if there is no
/// such problem
Region region_of(const std::string& problem, const std::map<std::string, std::string>& variant = {});
/// Returns the second region of a problem with fixed walls, where every step meets a wall and the bounce is located in
/// time. nullopt: the problem has none.
std::optional<Region> region_at_walls(const std::string& problem);
/// Returns the step of a method on the problem of the region. @throws Error if there is no such problem
std::unique_ptr<StepMap> step_map_on(const Region& region, const MethodSpec& method);
/// Returns pendulum and henon-heiles, or another problem if the method needs one.
std::vector<Region> default_regions(const MethodSpec& method = {});
/// Measures a method of the catalogue. @throws Error if the method or a problem is unknown
PropertyRow measure_method(const MethodSpec& method, std::span<const Region> regions);
/// Measures a step that bounces off a wall: order, structure and Jacobian. The row has no cells for the other
/// properties.
PropertyRow measure_at_walls(const MethodSpec& method, const Region& region);

/// Returns tables as plain text: first claims and findings, then the measured numbers.
std::string property_table(std::span<const PropertyRow> rows);
/// Returns the same as JSON. NaN and infinity are null, and `agrees` is null if it is unclear.
std::string property_json(std::span<const PropertyRow> rows);

}  // namespace hamflow
