#include "orbit_digits.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "hamflow/arithmetic/mp.hpp"
#include "hamflow/core/problem_info.hpp"
#include "hamflow/formula/problem_texts.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow {

namespace {

/// Integrals of quadratures in more digits than these take seconds.
constexpr int most_digits = 200;

Mp power_of_ten(int exponent) { return parse_decimal<Mp>("1e" + std::to_string(exponent)); }

/// int_0^1 f(x, 1 - x) dx by the double exponential rule, both arguments to their own relative precision; halved until
/// it changes by less than `tolerance`, relative.   [TakahasiMori1974]
template <class F>
std::optional<Mp> integral_from_ends(const F& f, const Mp& tolerance) {
  const Mp half_pi = pi_value<Mp>() / Mp(2);
  // At x = e/(1 + e), e = exp(pi sinh t).
  const auto term = [&](const Mp& t) {
    const Mp e = exp(Mp(2) * half_pi * sinh(t));
    const Mp sum = Mp(1) + e;
    const Mp rest = Mp(1) / sum;
    const Mp x = e * rest;
    const Mp weight = Mp(2) * half_pi * cosh(t) * x * rest;
    return Mp(f(x, rest) * weight);
  };
  Mp step(1);
  Mp sum = term(Mp(0));
  std::optional<Mp> last;
  for (int level = 0; level < 14; ++level) {
    for (const int side : {-1, 1}) {
      int small = 0;
      for (int k = 1; small < 2; k += level == 0 ? 1 : 2) {
        const Mp added = term(Mp(side * k) * step);
        sum += added;
        small = abs(added) > tolerance * abs(sum) * Mp(0x1p-20) ? 0 : small + 1;
      }
    }
    const Mp value = sum * step;
    if (!(abs(value) <= std::numeric_limits<Mp>::max())) return std::nullopt;
    if (last && abs(value - *last) <= tolerance * abs(value)) return value;
    last = value;
    step = step / Mp(2);
  }
  return std::nullopt;
}

/// The radial motion with energy E and angular momentum l. H is evaluated by the problem itself, in the digits of the
/// scope.
class Orbit {
 public:
  Orbit(const Scenario& scenario, int digits) : digits_(digits), at_(scenario.request) {
    const bool polar = static_cast<bool>(scenario.problem->to_reference);
    at_.arithmetic = "mp(" + std::to_string(digits) + ")";
    at_.method = {.name = "rk4"};
    at_.kernel = "exact";
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
    // A strength of V that follows from the start has the digits of double among the parameters.
    const Mp given = energy_ - kinetic;
    const Mp found = potential(radius_);
    if (!(found == Mp(0))) strength_ = given / found;
  }

  const Mp& radius() const { return radius_; }
  const Mp& energy() const { return energy_; }
  const Mp& momentum() const { return momentum_; }
  /// |T| + |V| at the start.
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
  /// The zero of E - V_eff near r, by Newton's method.
  std::optional<Mp> turning_point(const Mp& r) {
    return newton(r, [&](const Mp& x) { return Mp((effective(x) - energy_) / slope(x)); });
  }
  /// The zero of V_eff' near r.
  std::optional<Mp> circular_radius(const Mp& r) {
    return newton(r, [&](const Mp& x) { return Mp(slope(x) / curvature(x)); });
  }

  /// From pericentre to apocentre: time and phase. r = r1 + (r2 - r1) sin^2(pi x/2).
  std::optional<std::pair<Mp, Mp>> between(const Mp& r1, const Mp& r2, const Mp& tolerance) {
    const Mp quarter = pi_value<Mp>() / Mp(2);
    const auto rate = [&](const Mp& x, const Mp& rest, Mp& r) {
      const Mp s = sin(quarter * x);
      const Mp c = sin(quarter * rest);
      const Mp inside = (r2 - r1) * s * s;
      const Mp outside = (r2 - r1) * c * c;
      r = x < rest ? Mp(r1 + inside) : Mp(r2 - outside);
      return Mp(Mp(2) * quarter / sqrt(Mp(2) / mass_ * (energy_ - effective(r)) / (inside * outside)));
    };
    const auto time = integral_from_ends(
        [&](const Mp& x, const Mp& rest) {
          Mp r(0);
          return rate(x, rest, r);
        },
        tolerance);
    const auto phase = integral_from_ends(
        [&](const Mp& x, const Mp& rest) {
          Mp r(0);
          const Mp dt = rate(x, rest, r);
          return Mp(dt * momentum_ / (mass_ * r * r));
        },
        tolerance);
    if (!time || !phase) return std::nullopt;
    return std::pair{*time, Mp(abs(*phase))};
  }
  /// From pericentre to infinity: the phase. 1/r = x/r1.
  std::optional<Mp> to_infinity(const Mp& r1, const Mp& tolerance) {
    const auto phase = integral_from_ends(
        [&](const Mp& x, const Mp&) {
          return Mp(momentum_ / (mass_ * r1) / sqrt(Mp(2) / mass_ * (energy_ - effective(r1 / x))));
        },
        tolerance);
    if (!phase) return std::nullopt;
    return Mp(abs(*phase));
  }

 private:
  /// As the parameters have it.
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
      if (!(abs(change) > settled * x)) {  // once more: the digits double
        x = x - step(x);
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

/// The entries that have a value in more digits.
struct Found {
  std::optional<Mp> r_min, r_max, circular_radius, apsidal_angle, radial_period;
};
constexpr std::pair<const char*, std::optional<Mp> Found::*> entries[] = {{"r_min", &Found::r_min},
                                                                          {"r_max", &Found::r_max},
                                                                          {"circular_radius", &Found::circular_radius},
                                                                          {"apsidal_angle", &Found::apsidal_angle},
                                                                          {"radial_period", &Found::radial_period}};

Found found_of(Orbit& orbit, const nlohmann::ordered_json& known, const Mp& tolerance) {
  const auto near = [&](const char* name) -> std::optional<double> {
    const auto& x = known[name];
    if (!x.is_number() || !std::isfinite(x.get<double>()) || !(x.get<double>() > 0)) return std::nullopt;
    return x.get<double>();
  };
  Found found;
  const auto r_min = near("r_min"), r_max = near("r_max"), circle = near("circular_radius");
  if (circle) found.circular_radius = orbit.circular_radius(Mp(*circle));
  if (known["type"] == "circle" || orbit.momentum() == Mp(0)) {
    // A circle, to the digits of the run, where V_eff has its extremum at the start.
    if (found.circular_radius && abs(*found.circular_radius - orbit.radius()) <= tolerance * orbit.radius()) {
      found.r_min = found.r_max = orbit.radius();
    }
    return found;
  }
  if (r_min) found.r_min = orbit.turning_point(Mp(*r_min));
  if (r_max) found.r_max = orbit.turning_point(Mp(*r_max));
  if (found.r_min && found.r_max && near("radial_period") && *found.r_min < *found.r_max) {
    if (const auto both = orbit.between(*found.r_min, *found.r_max, tolerance)) {
      found.radial_period = Mp(2) * both->first;
      found.apsidal_angle = both->second;
    }
  } else if (found.r_min && !r_max && near("apsidal_angle")) {
    found.apsidal_angle = orbit.to_infinity(*found.r_min, tolerance);
  }
  return found;
}

}  // namespace

void add_orbit_digits(const Scenario& scenario, nlohmann::ordered_json& orbit) {
  const int digits = std::min(digits_beyond_double(scenario.request.arithmetic), most_digits);
  // Differences of V_eff near its zeros lose two thirds of the digits.
  const int guarded = 3 * digits + 30;
  const MpDigits scope(guarded);
  const Mp rounding = power_of_ten(-digits);
  const Mp tolerance = rounding / Mp(1000);
  Orbit motion(scenario, guarded);
  const Found found = found_of(motion, orbit, tolerance);
  Orbit by_energy = motion;
  by_energy.move(rounding * motion.size(), Mp(0));
  const Found with_energy = found_of(by_energy, orbit, tolerance);
  Orbit by_momentum = motion;
  by_momentum.move(Mp(0), rounding * motion.momentum());
  const Found with_momentum = found_of(by_momentum, orbit, tolerance);

  nlohmann::ordered_json uncertainty;
  for (const auto& [name, value] : entries) {
    uncertainty[name] = nullptr;
    const std::optional<Mp>& x = found.*value;
    if (!x) continue;
    if (const auto& a = with_energy.*value, &b = with_momentum.*value; a && b) {
      const Mp moved = abs(*a - *x) + abs(*b - *x) + rounding * abs(*x);
      uncertainty[name] = std::max(static_cast<double>(moved), std::numeric_limits<double>::min());
    }
    const MpDigits rounded(digits);
    orbit[name] = written_digits(*x + Mp(0));
  }
  orbit["uncertainty"] = uncertainty;
}

}  // namespace hamflow
