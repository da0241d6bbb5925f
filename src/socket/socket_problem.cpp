#include "socket_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace hamflow {

const ClientForces::Evaluation& ClientForces::at(const Vector<double, dynamic>& q) {
  const auto is_at = [&](const Evaluation& known) {
    return known.q.size() == q.size() && std::equal(q.begin(), q.end(), known.q.begin());
  };
  kept_is_used_ = !is_at(last_) && is_at(kept_);
  if (kept_is_used_) return kept_;
  if (is_at(last_)) return last_;
  positions_.assign(q.begin(), q.end());
  if (length_ != 1) {
    for (double& x : positions_) x *= length_;
  }
  server_->evaluate(positions_, cell_, timeout_, wire_);
  last_.q.assign(q.begin(), q.end());
  last_.potential = wire_.energy / energy_;
  std::swap(last_.force, wire_.forces);
  if (const double factor = length_ / energy_; factor != 1) {
    for (double& x : last_.force) x *= factor;
  }
  return last_;
}

namespace {
/// A motion that is not finite ends by itself, without the client.
bool is_finite(const Vector<double, dynamic>& q) {
  return std::all_of(q.begin(), q.end(), [](double x) { return std::isfinite(x); });
}
constexpr double undefined = std::numeric_limits<double>::quiet_NaN();
}  // namespace

double ClientForces::potential(const Vector<double, dynamic>& q) {
  if (!is_finite(q)) return undefined;
  const std::scoped_lock lock(mutex_);
  return at(q).potential;
}

void ClientForces::force(const Vector<double, dynamic>& q, Vector<double, dynamic>& f) {
  if (!is_finite(q)) return std::fill(f.begin(), f.end(), undefined);
  const std::scoped_lock lock(mutex_);
  const Evaluation& here = at(q);
  std::copy(here.force.begin(), here.force.end(), f.begin());
}

void ClientForces::keep() {
  const std::scoped_lock lock(mutex_);
  if (!kept_is_used_) std::swap(last_, kept_);
  kept_is_used_ = true;
}

double SocketProblem::kinetic(const V& p) const {
  double sum = 0;
  for (std::size_t i = 0; i < p.size(); ++i) sum += p[i] * p[i] / (2 * mass(i));
  return sum;
}

void SocketProblem::velocity(const V& p, V& v) const {
  for (std::size_t i = 0; i < p.size(); ++i) v[i] = p[i] / mass(i);
}

}  // namespace hamflow
