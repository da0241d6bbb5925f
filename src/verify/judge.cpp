// Compares claims with measurements.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "hamflow/core/error.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/verify/measure.hpp"

namespace hamflow {

namespace {
const char* text(bool claimed) { return claimed ? "yes" : "no"; }

/// Lists for each problem what was not measured there, and why. @param reason returns the reason from a Measurement
std::string reasons(std::span<const Measurement> on, const auto& reason) {
  std::string all;
  for (const Measurement& m : on) {
    if (const std::string why = reason(m); !why.empty()) all += (all.empty() ? "" : "; ") + m.problem + ": " + why;
  }
  return all;
}
PropertyCell because(PropertyCell cell, std::span<const Measurement> on, const auto& reason) {
  if (cell.agrees == Finding::unclear || cell.measured == name(Finding::unclear)) cell.reason = reasons(on, reason);
  return cell;
}

/// yes if it holds on every problem, no if it fails on one.
Finding everywhere(std::span<const Measurement> on, const auto& holds) {
  Finding all = Finding::yes;
  for (const Measurement& m : on) all = std::min(all, holds(m));  // no < unclear < yes
  return all;
}

PropertyCell cell(std::string property, bool claimed, Finding found, std::size_t problems) {
  Finding agrees = found == Finding::unclear            ? Finding::unclear
                   : (found == Finding::yes) == claimed ? Finding::yes
                                                        : Finding::no;
  // On a single problem a property may hold because of the problem.
  if (!claimed && problems == 1) agrees = Finding::yes;
  return {std::move(property), text(claimed), std::string(name(found)), agrees};
}

/// If negating the momenta does not reverse the exact motion, nothing can be concluded.
PropertyCell reversal_cell(std::string property, bool claimed, std::span<const Measurement> on,
                           DefectMeasurement Measurement::*which) {
  std::vector<Measurement> even;
  std::copy_if(on.begin(), on.end(), std::back_inserter(even), [](const Measurement& m) { return m.even_in_momenta; });
  if (even.empty()) return {std::move(property), text(claimed), "-", Finding::yes};
  return because(cell(std::move(property), claimed,
                      everywhere(even, [&](const Measurement& m) { return (m.*which).holds; }), even.size()),
                 even, [&](const Measurement& m) { return (m.*which).reason; });
}

PropertyCell order_cell(const MethodInfo& claims, std::span<const Measurement> on) {
  double least = std::numeric_limits<double>::infinity();
  bool any = false;
  bool exact = false;
  Finding agrees = Finding::yes;
  for (const Measurement& m : on) {
    const double slope = m.order.slope;
    if (std::isinf(slope)) {
      exact = true;
      continue;
    }
    if (m.order.points < OrderMeasurement::fewest_points) {
      agrees = std::min(agrees, Finding::unclear);
      continue;
    }
    any = true;
    least = std::min(least, slope);
    if (!(slope > claims.order - OrderMeasurement::tolerance)) {
      agrees = Finding::no;
    }
  }
  const auto reason = [](const Measurement& m) { return m.order.reason; };
  // all errors are at rounding level; with one problem this may be because of the problem
  if (exact && !any && agrees == Finding::yes) {
    return {"order", std::to_string(claims.order), "exact", on.size() == 1 ? Finding::yes : Finding::unclear,
            reasons(on, reason)};
  }
  const bool more = any && least >= claims.order + OrderMeasurement::tolerance;
  if (agrees == Finding::yes && more && on.size() > 1) agrees = Finding::no;
  return because({"order", std::to_string(claims.order), any ? fmt::format("{:.2f}", least) : "-", agrees}, on, reason);
}

PropertyCell energy_cell(const MethodInfo& claims, std::span<const Measurement> on) {
  Conservation least = Conservation::yes;
  bool open = false;
  for (const Measurement& m : on) {
    const auto here = m.energy.conserving(claims.order, m.even_in_momenta);
    least = std::min(least, here.value_or(Conservation::yes));
    open = open || !here;
  }
  if (open && least != Conservation::no) {
    return because({"energy conserving", std::string(name(claims.energy_conserving)), "unclear", Finding::unclear}, on,
                   [](const Measurement& m) { return m.energy.reason; });
  }
  const Conservation claimed = claims.energy_conserving;
  // The quadrature may be exact to rounding on these problems with this step size.
  const bool enough = claimed == Conservation::up_to_quadrature ? least >= claimed : least == claimed;
  const bool agrees = enough || (on.size() == 1 && claimed == Conservation::no);
  // An error less than four binary digits above rounding, without drift, neither confirms nor refutes the claim.
  const bool near = claimed == Conservation::yes && std::all_of(on.begin(), on.end(), [](const Measurement& m) {
                      return m.energy.drift.drift != DriftClass::linear && m.energy.level < 16 * m.energy.rounding &&
                             m.energy.fine_level < 16 * m.energy.fine_rounding;
                    });
  return {"energy conserving", std::string(name(claimed)), std::string(name(least)),
          agrees ? Finding::yes
          : near ? Finding::unclear
                 : Finding::no};
}

PropertyCell forces_cell(const MethodInfo& claims, std::span<const Measurement> on) {
  double least = std::numeric_limits<double>::infinity();
  double most = 0;
  for (const Measurement& m : on) {
    const double evaluations = std::max(m.cost.force, m.cost.gradient);  // if H is not separable, gradients count
    if (std::isnan(evaluations)) {
      const bool claimed = claims.forces_per_step > 0;
      return because({"forces per step", claimed ? std::to_string(claims.forces_per_step) : "-", "-",
                      claimed ? Finding::unclear : Finding::yes},
                     on, [](const Measurement& one) { return one.cost.reason; });
    }
    least = std::min(least, evaluations);
    most = std::max(most, evaluations);
  }
  const bool claimed = claims.forces_per_step > 0;
  const double wanted = claims.forces_per_step;
  const std::string measured = least == most ? fmt::format("{:g}", most) : fmt::format("{:.3g}-{:.3g}", least, most);
  return {"forces per step", claimed ? std::to_string(claims.forces_per_step) : "-", measured,
          !claimed || (least == wanted && most == wanted) ? Finding::yes : Finding::no};
}

/// Returns whether every iteration computes its own Jacobian, so that it converges quadratically. Then there are as
/// many second derivatives as first derivatives, except for those evaluations with which "auto" checks a solution.
bool linearises(std::span<const Measurement> on) {
  return std::all_of(on.begin(), on.end(),
                     [](const Measurement& m) { return 2 * m.cost.hessian > std::max(m.cost.force, m.cost.gradient); });
}

PropertyCell newton_cell(std::span<const Measurement> on) {
  double most = 0;
  for (const Measurement& m : on) {
    if (std::isnan(m.cost.coarse_solves)) {
      return because({"Newton corrections", fmt::format("<= {}", most_newton_corrections), "-", Finding::unclear}, on,
                     [](const Measurement& one) { return one.cost.reason; });
    }
    most = std::max(most, m.cost.coarse_solves);
  }
  return {"Newton corrections", fmt::format("<= {}", most_newton_corrections), fmt::format("{:.1f}", most),
          most > 0 && most <= most_newton_corrections ? Finding::yes : Finding::no};
}
}  // namespace

PropertyRow judge(const MethodInfo& claims, std::vector<Measurement> on) {
  if (on.empty()) throw Error("a method is judged by at least one problem");
  const std::size_t problems = on.size();
  const auto defect = [&](const char* property, bool claimed, DefectMeasurement Measurement::*which) {
    return because(
        cell(property, claimed, everywhere(on, [&](const Measurement& m) { return (m.*which).holds; }), problems), on,
        [&](const Measurement& m) { return (m.*which).reason; });
  };
  PropertyRow row{claims, {}, {}};
  row.cells.push_back(order_cell(claims, on));
  row.cells.push_back(because(cell("explicit", claims.explicit_step,
                                   everywhere(on, [](const Measurement& m) { return m.cost.explicit_step; }), problems),
                              on, [](const Measurement& m) { return m.cost.reason; }));
  row.cells.push_back(defect("symplectic", claims.symplectic, &Measurement::symplectic));
  row.cells.push_back(
      reversal_cell("weakly reversible", claims.weakly_reversible, on, &Measurement::weakly_reversible));
  row.cells.push_back(defect("symmetric", claims.symmetric, &Measurement::symmetric));
  row.cells.push_back(reversal_cell("reversible", claims.reversible, on, &Measurement::reversible));
  row.cells.push_back(energy_cell(claims, on));
  row.cells.push_back(forces_cell(claims, on));
  row.cells.push_back(defect("Jacobian is the step's", true, &Measurement::jacobian));
  if (!claims.explicit_step && linearises(on)) row.cells.push_back(newton_cell(on));
  row.on = std::move(on);
  return row;
}

Finding PropertyRow::verdict() const {
  Finding all = Finding::yes;
  for (const PropertyCell& c : cells) all = std::min(all, c.agrees);  // no < unclear < yes
  return all;
}

bool PropertyRow::has(std::string_view property) const {
  return std::any_of(cells.begin(), cells.end(), [&](const PropertyCell& c) { return c.property == property; });
}

std::string PropertyRow::differing() const {
  std::vector<std::string> properties;
  for (const PropertyCell& c : cells) {
    if (c.agrees != Finding::yes) properties.push_back(c.property);
  }
  return joined(properties);
}

const PropertyCell& PropertyRow::operator[](std::string_view property) const {
  for (const PropertyCell& c : cells) {
    if (c.property == property) return c;
  }
  throw Error("the property table has no column '" + std::string(property) + "'");
}

}  // namespace hamflow
