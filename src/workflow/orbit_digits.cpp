#include "orbit_digits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "hamflow/arithmetic/mp.hpp"
#include "hamflow/core/problem_info.hpp"
#include "hamflow/formula/problem_texts.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow {

namespace {

constexpr int most_digits = 1000;
/// Limited, because with more digits quadratures would take seconds.
constexpr int most_digits_of_integrals = 60;

Mp power_of_ten(int exponent) { return parse_decimal<Mp>("1e" + std::to_string(exponent)); }

/// Computes int_0^1 f(x, 1 - x) dx for two functions by the double exponential rule. x and 1 - x both have full
/// relative precision. The step is halved until the relative change is below `tolerance`.   [TakahasiMori1974]
/// @param nearest distance from the ends at which the sum stops; the rest is negligible compared with the tolerance
template <class F>
std::optional<std::pair<Mp, Mp>> integral_from_ends(const F& f, const Mp& tolerance, const Mp& nearest) {
  const Mp pi = pi_value<Mp>();
  Mp step(1);
  std::pair<Mp, Mp> sum{0, 0};
  std::optional<std::pair<Mp, Mp>> last;
  for (int level = 0; level < 14; ++level) {
    for (const int side : {-1, 1}) {
      for (int k = level == 0 && side > 0 ? 0 : 1;; k += level == 0 ? 1 : 2) {
        const Mp t = Mp(side * k) * step;
        const Mp e = exp(pi * sinh(t));  // x = e/(1 + e)
        const Mp rest = Mp(1) / (Mp(1) + e);
        const Mp x = e * rest;
        if (x < nearest || rest < nearest) break;
        const std::pair<Mp, Mp> here = f(x, rest);
        const Mp weight = pi * cosh(t) * x * rest;
        sum.first += here.first * weight;
        sum.second += here.second * weight;
      }
    }
    const std::pair<Mp, Mp> value{sum.first * step, sum.second * step};
    if (!(abs(value.first) + abs(value.second) <= std::numeric_limits<Mp>::max())) return std::nullopt;
    const auto rests = [&](const Mp& now, const Mp& before) { return abs(now - before) <= tolerance * abs(now); };
    if (last && rests(value.first, last->first) && rests(value.second, last->second)) return value;
    last = value;
    step = step / Mp(2);
  }
  return std::nullopt;
}

/// The radial motion with energy E and angular momentum l. The problem evaluates H with the digits of the current
/// scope.
class Orbit {
 public:
  Orbit(const Scenario& scenario, int digits) : digits_(digits), at_(scenario.request) {
    const bool polar = static_cast<bool>(scenario.problem->to_reference);
    at_.arithmetic = "mp(" + std::to_string(digits) + ")";
    at_.method = {.name = "rk4"};
    at_.threads = 1;
    Frame start;
    make_simulation(at_)->look(start);
    const auto number = [](const std::string& text) { return parse_decimal<Mp>(text); };
    const FrameDigits& z = start.digits;
    energy_ = number(z.energy);
    mass_ = evaluate_number<Mp>(complete(scenario.problem->info, at_.parameters).at(CentralKeys::mass));
    const Mp x = number(z.q.at(0)), y = number(z.q.at(1)), px = number(z.p.at(0)), py = number(z.p.at(1));
    radius_ = polar ? x : sqrt(x * x + y * y);
    momentum_ = polar ? py : x * py - y * px;
    const Mp around = momentum_ / radius_;
    const Mp kinetic = (polar ? px * px + around * around : px * px + py * py) / (Mp(2) * mass_);
    size_ = kinetic + abs(energy_ - kinetic);
    polar_ = polar;
    at_.start = {};
    // If the strength of V follows from the start, the parameters contain it only to double precision. This corrects
    // it.
    const Mp given = energy_ - kinetic;
    const Mp found = potential(radius_);
    if (!(found == Mp(0))) strength_ = given / found;
  }

  const Mp& radius() const { return radius_; }
  const Mp& energy() const { return energy_; }
  const Mp& momentum() const { return momentum_; }
  /// Returns |T| + |V| at the start.
  const Mp& size() const { return size_; }
  void move(const Mp& energy, const Mp& momentum) {
    energy_ += energy;
    momentum_ += momentum;
  }

  Mp effective(const Mp& r) { return strength_ * potential(r) + momentum_ * momentum_ / (Mp(2) * mass_ * r * r); }
  Mp slope(const Mp& r) {
    const Mp h = r * power_of_ten(-digits_ / 3);
    return (effective(r + h) - effective(r - h)) / (Mp(2) * h);
  }
  Mp curvature(const Mp& r) {
    const Mp h = r * power_of_ten(-digits_ / 4);
    return (effective(r + h) - Mp(2) * effective(r) + effective(r - h)) / (h * h);
  }
  /// Returns the zero of E - V_eff near r, by Newton's method.
  std::optional<Mp> turning_point(const Mp& r) {
    return newton(r, [&](const Mp& x) { return Mp((effective(x) - energy_) / slope(x)); });
  }
  /// Returns the zero of V_eff' near r.
  std::optional<Mp> circular_radius(const Mp& r) {
    return newton(r, [&](const Mp& x) { return Mp(slope(x) / curvature(x)); });
  }

  /// Returns time and phase from pericentre to apocentre, by the substitution r = r1 + (r2 - r1) sin^2(pi x/2).
  std::optional<std::pair<Mp, Mp>> between(const Mp& r1, const Mp& r2, const Mp& tolerance) {
    const Mp quarter = pi_value<Mp>() / Mp(2);
    const Mp nearest = power_of_ten(-digits_ / 3);  // r - r1 and r2 - r are of the order of its square
    return integral_from_ends(
        [&](const Mp& x, const Mp& rest) {
          const Mp s = sin(quarter * x);
          const Mp c = sin(quarter * rest);
          const Mp inside = (r2 - r1) * s * s;
          const Mp outside = (r2 - r1) * c * c;
          const Mp r = x < rest ? Mp(r1 + inside) : Mp(r2 - outside);
          const Mp dt = Mp(2) * quarter / sqrt(Mp(2) / mass_ * (energy_ - effective(r)) / (inside * outside));
          return std::pair{dt, Mp(abs(momentum_) / (mass_ * r * r) * dt)};
        },
        tolerance, nearest);
  }
  /// Returns the phase from pericentre to infinity, by the substitution 1/r = x/r1.
  std::optional<Mp> to_infinity(const Mp& r1, const Mp& tolerance) {
    const auto phase = integral_from_ends(
        [&](const Mp& x, const Mp&) {
          return std::pair{Mp(abs(momentum_) / (mass_ * r1) / sqrt(Mp(2) / mass_ * (energy_ - effective(r1 / x)))),
                           Mp(0)};
        },
        tolerance, power_of_ten(-2 * (digits_ / 3)));
    if (!phase) return std::nullopt;
    return phase->first;
  }

 private:
  /// Evaluates V with the strength in the parameters.
  Mp potential(const Mp& r) {
    at_.start.q = {written_digits(r), "0"};
    at_.start.p = {"0", "0"};
    make_simulation(at_)->look(frame_);
    return parse_decimal<Mp>(frame_.digits.energy);
  }
  template <class Step>
  std::optional<Mp> newton(Mp x, const Step& step) {
    const Mp begin = x;
    const Mp settled = power_of_ten(-digits_ / 3);
    for (int i = 0; i < 40; ++i) {
      const Mp change = step(x);
      x = x - change;
      if (!(x > begin / Mp(2) && x < begin * Mp(2))) return std::nullopt;
      if (!(abs(change) > settled * x)) {  // a third of the digits is correct; two more iterations give all
        for (int more = 0; more < 2; ++more) x = x - step(x);
        return x;
      }
    }
    return std::nullopt;
  }

  int digits_;
  Request at_;
  Frame frame_;
  bool polar_ = false;
  Mp energy_, mass_, radius_, momentum_, size_;
  Mp strength_{1};
};

/// Entries of the summary that are computed with more digits.
struct Found {
  std::optional<Mp> r_min, r_max, circular_radius, apsidal_angle, radial_period;
};
struct OrbitEntry {
  const char* name;
  std::optional<Mp> Found::*found;
  LongNumber OrbitSummary::*number;
};
constexpr OrbitEntry orbit_entries[] = {{"r_min", &Found::r_min, &OrbitSummary::r_min},
                                        {"r_max", &Found::r_max, &OrbitSummary::r_max},
                                        {"circular_radius", &Found::circular_radius, &OrbitSummary::circular_radius},
                                        {"apsidal_angle", &Found::apsidal_angle, &OrbitSummary::apsidal_angle},
                                        {"radial_period", &Found::radial_period, &OrbitSummary::radial_period}};

/// @param integrals whether to compute the apsidal angle and the radial period, too
Found found_of(Orbit& orbit, const OrbitSummary& known, const Mp& tolerance, bool integrals) {
  const auto is_near = [](double x) { return std::isfinite(x) && x > 0; };
  const double r_min = known.r_min, r_max = known.r_max, circle = known.circular_radius;
  Found found;
  if (is_near(circle)) found.circular_radius = orbit.circular_radius(Mp(circle));
  if (known.type == "circle" || orbit.momentum() == Mp(0)) {
    // The orbit is a circle to the digits of the run if V_eff has its extremum at the start.
    if (found.circular_radius && abs(*found.circular_radius - orbit.radius()) <= tolerance * orbit.radius()) {
      found.r_min = found.r_max = orbit.radius();
    }
    return found;
  }
  if (is_near(r_min)) found.r_min = orbit.turning_point(Mp(r_min));
  if (is_near(r_max)) found.r_max = orbit.turning_point(Mp(r_max));
  if (!integrals) return found;
  if (found.r_min && found.r_max && is_near(known.radial_period) && *found.r_min < *found.r_max) {
    if (const auto both = orbit.between(*found.r_min, *found.r_max, tolerance)) {
      found.radial_period = Mp(2) * both->first;
      found.apsidal_angle = both->second;
    }
  } else if (found.r_min && !is_near(r_max) && is_near(known.apsidal_angle)) {
    found.apsidal_angle = orbit.to_infinity(*found.r_min, tolerance);
  }
  return found;
}

/// Computes with three times the digits, because differences of V_eff near its zeros lose two thirds of them.
class Digits {
 public:
  Digits(const Scenario& scenario, int digits)
      : scope_(guarded(digits)), tolerance(power_of_ten(-digits - 3)), orbit(scenario, guarded(digits)) {}

 private:
  static int guarded(int digits) { return 3 * digits + 30; }
  MpDigits scope_;

 public:
  Mp tolerance;
  Orbit orbit;
};

/// Returns the sensitivity of each entry to the start: its change when the energy moves by a fraction of |T| + |V| and
/// the angular momentum by the same fraction of itself, divided by this fraction; 0 if unknown.
std::array<double, std::size(orbit_entries)> changes_by_start(const Scenario& scenario, const OrbitSummary& known) {
  Digits in(scenario, 20);
  const Mp part = power_of_ten(-12);
  const Found found = found_of(in.orbit, known, in.tolerance, true);
  Orbit by_energy = in.orbit;
  by_energy.move(part * in.orbit.size(), Mp(0));
  const Found with_energy = found_of(by_energy, known, in.tolerance, true);
  Orbit by_momentum = in.orbit;
  by_momentum.move(Mp(0), part * in.orbit.momentum());
  const Found with_momentum = found_of(by_momentum, known, in.tolerance, true);
  std::array<double, std::size(orbit_entries)> all{};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto value = orbit_entries[i].found;
    const auto &x = found.*value, &a = with_energy.*value, &b = with_momentum.*value;
    if (x && a && b) all[i] = static_cast<double>((abs(*a - *x) + abs(*b - *x)) / part);
  }
  return all;
}

}  // namespace

void add_orbit_digits(const Scenario& scenario, OrbitSummary& orbit) {
  const int digits = std::min(digits_beyond_double(scenario.request.arithmetic), most_digits);
  const OrbitSummary known = orbit;
  const auto changes = changes_by_start(scenario, known);
  for (const OrbitEntry& entry : orbit_entries) orbit.uncertainty.emplace_back(entry.name, std::nullopt);
  const auto add = [&](int in_digits, bool integrals) {
    Digits in(scenario, in_digits);
    const Found found = found_of(in.orbit, known, in.tolerance, integrals);
    for (std::size_t i = 0; i < changes.size(); ++i) {
      const std::optional<Mp>& x = found.*orbit_entries[i].found;
      if (!x || !(changes[i] > 0)) continue;
      const double size = static_cast<double>(abs(*x));
      const double moved = std::pow(10.0, -digits) * changes[i] + std::pow(10.0, -in_digits) * size;
      orbit.uncertainty[i].second = std::max(moved, std::numeric_limits<double>::min());  // must not underflow to 0
      const MpDigits rounded(in_digits);
      LongNumber& number = orbit.*orbit_entries[i].number;
      number.text = written_digits(*x + Mp(0));
      number.value = std::strtod(number.text.c_str(), nullptr);
    }
  };
  if (digits > most_digits_of_integrals) {
    add(most_digits_of_integrals, true);
    add(digits, false);
  } else {
    add(digits, true);
  }
}

}  // namespace hamflow
