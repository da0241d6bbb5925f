// Measures symplecticity and reversibility: defects of identities that hold either to rounding or not at all.
#include "structure.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <utility>

#include "hamflow/core/math.hpp"
#include "hamflow/verify/measure.hpp"
#include "measuring_stopped.hpp"
#include "rounding.hpp"
#include "symplectic.hpp"

namespace hamflow {

namespace {
constexpr std::uint64_t states = 8;

using Rows = std::vector<std::vector<double>>;

/// Collects defects in units of rounding. A step has at most about twenty operations; each rounds a coordinate a few
/// times, with coefficients up to 3. So defects up to 512 units are rounding. Without the property the defect is c
/// h^(r+1), which at a twentieth of a period and for r <= 6 is far above 2^20 units, 2.3e-10.
class Defects {
 public:
  void add(double defect, double size) {
    ++added_;
    const double units = defect / (epsilon * size);
    found_.defect = larger(found_.defect, defect);
    found_.units = larger(found_.units, units);
    finite_ = finite_ && units <= std::numeric_limits<double>::max();
  }
  /// Counts a state from which a step failed, so that nothing is known there.
  void fail() { ++failed_; }
  DefectMeasurement found(double rounding = 512, double real = 0x1p20) const {
    DefectMeasurement result = found_;
    if (!finite_) result.defect = result.units = std::numeric_limits<double>::infinity();
    if (added_ == 0) result.defect = result.units = std::numeric_limits<double>::quiet_NaN();
    result.holds = result.units >= real                       ? Finding::no
                   : failed_ == 0 && result.units <= rounding ? Finding::yes
                                                              : Finding::unclear;
    if (failed_ > 0) result.reason = fmt::format("a step failed from {} of {} states", failed_, states);
    return result;
  }

 private:
  DefectMeasurement found_;
  bool finite_ = true;
  std::uint64_t added_ = 0;
  std::uint64_t failed_ = 0;
};

/// Returns S z, the state with negated momenta.
State<double> reversed(State<double> z) {
  for (std::size_t i = z.size() / 2; i < z.size(); ++i) z[i] = -z[i];
  return z;
}

double distance(const State<double>& a, const State<double>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double d = abs(a[i] - b[i]);
    if (!(d <= std::numeric_limits<double>::max())) return std::numeric_limits<double>::infinity();
    largest = larger(largest, d);
  }
  return largest;
}

double size_of(const State<double>& z) { return distance(z, State<double>(z.size())); }

/// Returns the largest row sum of |M|, at least 1.
double norm(const Rows& m) {
  double largest = 1;
  for (const auto& row : m) {
    double sum = 0;
    for (double x : row) sum += abs(x);
    largest = larger(largest, sum);
  }
  return largest;
}

/// Compares the exact Jacobian with (Psi(z + d e) - Psi(z - d e))/(2 d) of the same map in long double. With d = 2^-16
/// the truncation error is d^2 Psi'''/6, about 4e-11 Psi''', and the rounding error 2^-64/d is 4e-15.
void add_jacobian_mismatch(const StepMap& map, const State<double>& z, double h, const Rows& exact, Defects& defects) {
  constexpr long double d = 0x1p-16L;
  for (std::size_t j = 0; j < z.size(); ++j) {
    State<long double> plus(z.begin(), z.end());
    State<long double> minus = plus;
    plus[j] += d;
    minus[j] -= d;
    if (!map.advance(plus, h, 1) || !map.advance(minus, h, 1)) return defects.fail();
    for (std::size_t i = 0; i < z.size(); ++i) {
      const double difference = static_cast<double>((plus[i] - minus[i]) / (2 * d));
      defects.add(abs(difference - exact[i][j]), norm(exact));
    }
  }
}

/// Measures all properties with steps of size h.
void measure_with(const StepMap& map, const Region& region, double h, Measurement& found) {
  Defects jacobian;
  Defects symplectic;
  Defects weak;
  Defects symmetric;
  Defects reversible;
  for (std::uint64_t k = 0; k < states; ++k) {
    throw_if_stopped();
    const State<double> start = random_state(region, k);
    const State<double> z = map.begun(start);
    const Rows m = map.jacobian(z, h);
    if (m.empty()) {
      for (Defects* all : {&jacobian, &symplectic, &weak, &symmetric, &reversible}) all->fail();
      continue;
    }
    const double uneven = map.energies(reversed(start), h, 0, 0).front() - map.energies(start, h, 0, 0).front();
    if (abs(uneven) > 64 * epsilon * map.energy_scale(start)) found.even_in_momenta = false;
    add_jacobian_mismatch(map, z, h, m, jacobian);
    const auto directions = map.directions(start);
    const auto add = [&](double defect, double terms) { symplectic.add(defect, terms); };
    directions.empty() ? for_each_symplectic_defect(m, add) : for_each_symplectic_defect_along(m, directions, add);

    // The second step amplifies the rounding error of the first by at most the norm of its Jacobian.
    const double size = size_of(z) * norm(m);
    const auto step = [&](const std::optional<State<double>>& from, double length) -> std::optional<State<double>> {
      if (!from) return std::nullopt;
      State<double> x = *from;
      return map.advance(x, length, 1) ? std::optional(std::move(x)) : std::nullopt;
    };
    const auto compare = [&](Defects& defects, const std::optional<State<double>>& a,
                             const std::optional<State<double>>& b) {
      a&& b ? defects.add(distance(*a, *b), size) : defects.fail();
    };
    const auto turned = [](const std::optional<State<double>>& x) { return x ? std::optional(reversed(*x)) : x; };
    const std::optional<State<double>> forward = step(z, h);
    compare(weak, turned(step(reversed(z), -h)), forward);
    compare(symmetric, step(forward, -h), z);
    compare(reversible, turned(step(turned(forward), h)), z);
  }
  // In units of the Jacobian's norm: 2^-26 is far above the truncation error of the divided difference, and 2^-12 is
  // far below the contribution of any operation of a step.
  found.jacobian = jacobian.found(0x1p-26 / epsilon, 0x1p-12 / epsilon);
  found.symplectic = symplectic.found();
  found.weakly_reversible = weak.found();
  found.symmetric = symmetric.found();
  found.reversible = reversible.found();
}
}  // namespace

void measure_structure(const StepMap& map, const Region& region, Measurement& found) {
  // A twentieth of a period makes defects of order 6 visible. Methods of order 8 that are not claimed to be symplectic
  // have defects ~ h^9, which need a seventh of a period. If an implicit method does not claim to be symplectic, and
  // the rounding of that step leaves its symplecticity unclear, its high order may hide the defect. Then larger steps
  // are tried, up to a whole period.
  const MethodInfo claims = map.claims();
  double h = (claims.order > 6 && !claims.symplectic ? 9 : 3) * region.step;
  measure_with(map, region, h, found);
  const auto hidden = [&] { return found.symplectic.holds == Finding::unclear && !claims.symplectic; };
  for (int k = 0; k < 3 && hidden() && !claims.explicit_step; ++k) {
    h *= 2;
    Measurement longer = found;
    measure_with(map, region, h, longer);
    if (longer.jacobian.holds != Finding::yes) break;  // this step is too large
    found = longer;
  }
}

}  // namespace hamflow
