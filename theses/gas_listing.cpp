#include "gas_listing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace hamflow::reproduction {

namespace {
constexpr double radius = 1.5;

/// sqrt(trace(d' d))/N^2 with N^2 particles.
double mean_error(const std::vector<double>& a, const std::vector<double>& b) {
  double squares = 0;
  for (std::size_t i = 0; i < a.size(); ++i) squares += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(squares) / (static_cast<double>(a.size()) / 2);
}

double speed(const ListedGas& gas, std::size_t i) { return std::hypot(gas.p()[i], gas.p()[i + 1]); }

/// The index of the x coordinate of the fastest particle. A NaN counts as the highest speed.
std::size_t fastest(const ListedGas& gas) {
  std::size_t found = 0;
  for (std::size_t i = 0; i < gas.p().size(); i += 2) found = speed(gas, i) <= speed(gas, found) ? found : i;
  return found;
}

double nearest(const std::vector<double>& q, std::size_t i) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t j = 0; j < q.size(); j += 2) {
    if (j != i) least = std::min(least, std::hypot(q[i] - q[j], q[i + 1] - q[j + 1]));
  }
  return least;
}
}  // namespace

ListedGas::ListedGas(double scale, double dt, std::vector<double> q, std::vector<double> p, int power)
    : scale_(scale), dt_(dt), q_(std::move(q)), p_(std::move(p)), force_(q_.size()), power_(power) {
  evaluate();
}

void ListedGas::evaluate() {
  const double S2 = scale_ * scale_;
  for (std::size_t i = 0; i < q_.size(); i += 2) {
    const double room = radius * radius - (q_[i] * q_[i] + q_[i + 1] * q_[i + 1]);
    const double wall = power_ == 1 ? -1 / (S2 * S2) * (1 / (room * room))  // as listed, to the last bit
                                    : -power_ / (S2 * S2 * std::pow(room, power_ + 1));
    force_[i] = q_[i] * wall;
    force_[i + 1] = q_[i + 1] * wall;
  }
  for (std::size_t i = 0; i < q_.size(); i += 2) {
    double x = 0, y = 0;
    for (std::size_t j = i + 2; j < q_.size(); j += 2) {
      const double dx = q_[i] - q_[j], dy = q_[i + 1] - q_[j + 1];
      const double inverse = 1 / ((dx * dx + dy * dy) * S2);
      const double squared = inverse * inverse, fourth = squared * squared;
      const double factor = 12 * (fourth * squared * inverse - fourth);
      x += dx * factor;
      y += dy * factor;
      force_[j] -= dx * factor;
      force_[j + 1] -= dy * factor;
    }
    force_[i] += x;
    force_[i + 1] += y;
  }
}

void ListedGas::step() {
  // The force at the end of a sub-step is the force at the start of the next one. The listing computes it twice.
  for (const double w : {1.35120719195966, -1.70241438391932, 1.35120719195966}) {
    for (std::size_t i = 0; i < q_.size(); ++i) p_[i] += force_[i] * w * dt_ / 2;
    for (std::size_t i = 0; i < q_.size(); ++i) q_[i] += p_[i] * w * dt_;
    evaluate();
    for (std::size_t i = 0; i < q_.size(); ++i) p_[i] += force_[i] * w * dt_ / 2;
  }
}

void ListedGas::negate_momenta() {
  for (double& x : p_) x = -x;
}

int ListedGas::put_crossers_at_the_origin() {
  int all = 0;
  for (std::size_t i = 0; i < q_.size(); i += 2) {
    if (!(std::hypot(q_[i], q_[i + 1]) >= radius)) continue;
    q_[i] = q_[i + 1] = 0;
    ++all;
  }
  if (all > 0) evaluate();
  return all;
}

int ListedGas::outside() const {
  int all = 0;
  for (std::size_t i = 0; i < q_.size(); i += 2) all += std::hypot(q_[i], q_[i + 1]) < radius ? 0 : 1;
  return all;
}

double ListedGas::energy() const {
  const double S2 = scale_ * scale_;
  double sum = 0;
  for (std::size_t i = 0; i < q_.size(); i += 2) {
    sum += (p_[i] * p_[i] + p_[i + 1] * p_[i + 1]) / 2;
    sum += 1 / (2 * S2 * S2 * std::pow(radius * radius - (q_[i] * q_[i] + q_[i + 1] * q_[i + 1]), power_));
    for (std::size_t j = i + 2; j < q_.size(); j += 2) {
      const double dx = q_[i] - q_[j], dy = q_[i + 1] - q_[j + 1];
      const double sixth = std::pow((dx * dx + dy * dy) * S2, -3);
      sum += (sixth * sixth - 2 * sixth) / S2;
    }
  }
  return sum;
}

ListedReturn listed_return(ListedGas gas, std::int64_t steps, bool by_hand, const std::function<void()>& breathe) {
  const std::vector<double> q = gas.q(), p = gas.p();
  const double energy = gas.energy();
  ListedReturn all;
  const auto go = [&](bool there) {
    for (std::int64_t k = 1; k <= steps; ++k) {
      breathe();
      gas.step();
      if (there && all.first_outside == 0 && gas.outside() > 0) all.first_outside = k;
      if (by_hand) all.put_to_origin += gas.put_crossers_at_the_origin();
    }
  };
  go(true);
  all.turn = gas.q();
  all.outside_at_turn = gas.outside();
  all.energy_error = std::abs(gas.energy() - energy) / std::abs(energy);
  gas.negate_momenta();
  go(false);
  gas.negate_momenta();
  all.end = gas.q();
  for (std::size_t i = 0; i < all.end.size(); i += 2) all.nowhere += std::isfinite(all.end[i]) ? 0 : 1;
  all.position = mean_error(gas.q(), q);
  all.momentum = mean_error(gas.p(), p);
  return all;
}

std::int64_t first_outside(ListedGas gas, std::int64_t steps, const std::function<void()>& breathe) {
  for (std::int64_t k = 1; k <= steps; ++k) {
    breathe();
    gas.step();
    if (gas.outside() > 0) return k;
  }
  return 0;
}

Passage passage(ListedGas gas, std::int64_t steps, const std::function<void()>& breathe) {
  const double fast = 2 * speed(gas, fastest(gas));
  Passage all;
  bool is_fast = false;
  for (std::int64_t k = 1; k <= steps; ++k) {
    breathe();
    const std::vector<double> before = gas.q();
    gas.step();
    const std::size_t first = fastest(gas);
    if (!is_fast && !(speed(gas, first) <= fast)) {
      is_fast = true;
      all.is_after_collision = gas.scale() * nearest(before, first) < 1;
    }
    if (gas.outside() == 0) continue;
    all.step = k;
    return all;
  }
  return {};
}

}  // namespace hamflow::reproduction
