#include "central_orbits.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "hamflow/arithmetic/plain.hpp"
#include "hamflow/core/counter_random.hpp"
#include "hamflow/methods/dop853.hpp"
#include "hamflow/verify/extrapolated_midpoint.hpp"

namespace hamflow::reproduction {

namespace {

template <class R>
struct CentralField {
  using Real = R;
  static constexpr std::size_t dimension = 2;
  static constexpr bool quadratic_kinetic = true;
  Field field;
  R mass, k, lambda;

  template <class S>
  S kinetic(const Vector<S, 2>& p) const {
    return (p[0] * p[0] + p[1] * p[1]) / (R(2) * mass);
  }
  template <class S>
  S potential(const Vector<S, 2>& q) const {
    const S square = q[0] * q[0] + q[1] * q[1];
    switch (field) {
      case Field::kepler:
        return -(S(k) / sqrt(square));
      case Field::hooke:
        return square * (-k / R(2));
      case Field::linear:
        return sqrt(square) * k;
      case Field::binomial:
        break;
    }
    const S off = square - lambda;
    return off * off * (k / R(2));
  }
};

/// Whether V_eff(r') = E for some r' > r, which bounds the motion.
bool is_bounded_outside(const OrbitCase& orbit, double r) {
  const double E = orbit.energy();
  double at = r * 1.01;
  for (int i = 0; i < 400; ++i, at *= 1.06) {
    if (orbit.effective(at) > E) return true;
  }
  return false;
}

template <class R, template <class, class> class Method, class Options>
OrbitPath follow(const OrbitCase& orbit, const Options& options) {
  using Problem = CentralField<R>;
  const Problem problem{orbit.field, R(orbit.mass), R(orbit.k), R(orbit.lambda)};
  Method<Problem, Plain<R>> method(options);
  PhasePoint<Plain<R>, 2> z;
  z.store({R(orbit.q[0]), R(orbit.q[1])}, {R(orbit.p[0]), R(orbit.p[1])});
  OrbitPath path;
  double t = 0;
  const double start = std::hypot(orbit.q[0], orbit.q[1]);
  constexpr int most_steps = 20000;
  for (int step = 0; step <= most_steps; ++step) {
    const double x = static_cast<double>(z.q[0]), y = static_cast<double>(z.q[1]);
    const double px = static_cast<double>(z.p[0]), py = static_cast<double>(z.p[1]);
    const double r = std::hypot(x, y), rate = x * px + y * py;
    if (!path.rate.empty() && (rate < 0) != (path.rate.back() < 0)) ++(rate < 0 ? path.maxima : path.minima);
    path.t.push_back(t);
    path.points.push_back({x, y});
    path.rate.push_back(rate);
    // On a circle the rate is only rounding, and changes its sign often. 90 steps are about one revolution.
    if (path.minima + path.maxima >= 3 && step >= 90) break;
    if (r > 30 * start && rate > 0 && !is_bounded_outside(orbit, r)) {
      path.escaped = true;
      break;
    }
    Vector<R, 2> f{};
    force(problem, Vector<R, 2>{z.q[0], z.q[1]}, f);
    const double pull = std::hypot(static_cast<double>(f[0]), static_cast<double>(f[1]));
    const double v = std::hypot(px, py) / orbit.mass;
    const double h = 0.07 * std::min(r / v, std::sqrt(orbit.mass * r / pull));
    if (method.step(problem, R(h), z) != Outcome::done) break;
    t += h;
  }
  return path;
}

using Six = std::array<std::array<long double, 6>, 6>;

/// Diagonalises a symmetric matrix by Jacobi rotations. The eigenvalues end on its diagonal; the columns of the result
/// are the eigenvectors.
Six diagonalise(Six& m) {
  Six v{};
  for (std::size_t i = 0; i < 6; ++i) v[i][i] = 1;
  for (int sweep = 0; sweep < 40; ++sweep) {
    for (std::size_t p = 0; p < 6; ++p) {
      for (std::size_t q = p + 1; q < 6; ++q) {
        if (m[p][q] == 0) continue;
        const long double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
        const long double t = (theta < 0 ? -1 : 1) / (std::fabs(theta) + std::sqrt(theta * theta + 1));
        const long double c = 1 / std::sqrt(t * t + 1), s = t * c;
        for (std::size_t i = 0; i < 6; ++i) {
          const long double a = m[i][p], b = m[i][q];
          m[i][p] = c * a - s * b;
          m[i][q] = s * a + c * b;
        }
        for (std::size_t i = 0; i < 6; ++i) {
          const long double a = m[p][i], b = m[q][i];
          m[p][i] = c * a - s * b;
          m[q][i] = s * a + c * b;
        }
        for (std::size_t i = 0; i < 6; ++i) {
          const long double a = v[i][p], b = v[i][q];
          v[i][p] = c * a - s * b;
          v[i][q] = s * a + c * b;
        }
      }
    }
  }
  return v;
}

/// Transforms the points of a path to mean 0 and covariance 1, by the Cholesky factor of their covariance. It omits
/// distant points of an escaping path, which show little more than the asymptote.
std::vector<std::array<long double, 2>> normalised_points(const OrbitPath& path) {
  std::vector<std::array<long double, 2>> all;
  const double limit = 6 * std::hypot(path.points.front()[0], path.points.front()[1]);
  for (const auto& point : path.points) {
    if (!path.escaped || std::hypot(point[0], point[1]) < limit) all.push_back({point[0], point[1]});
  }
  const auto count = static_cast<long double>(all.size());
  long double mx = 0, my = 0, xx = 0, xy = 0, yy = 0;
  for (const auto& a : all) {
    mx += a[0] / count;
    my += a[1] / count;
  }
  for (const auto& a : all) {
    xx += (a[0] - mx) * (a[0] - mx) / count;
    xy += (a[0] - mx) * (a[1] - my) / count;
    yy += (a[1] - my) * (a[1] - my) / count;
  }
  const long double l11 = std::sqrt(xx), l21 = xy / l11, l22 = std::sqrt(yy - l21 * l21);
  for (auto& a : all) {
    const long double u = (a[0] - mx) / l11;
    a = {u, (a[1] - my - l21 * u) / l22};
  }
  return all;
}

}  // namespace

double OrbitCase::V(double r) const {
  return static_cast<double>(CentralField<double>{field, mass, k, lambda}.potential(Vector<double, 2>{r, 0}));
}
double OrbitCase::effective(double r) const {
  const double l = angular_momentum();
  return V(r) + l * l / (2 * mass * r * r);
}
double OrbitCase::energy() const { return (p[0] * p[0] + p[1] * p[1]) / (2 * mass) + V(std::hypot(q[0], q[1])); }
std::string OrbitCase::told() const {
  return fmt::format("k = {:.6g}{}, mu = {:.6g}, q = ({:.6g}, {:.6g}), p = ({:.6g}, {:.6g})", k,
                     field == Field::binomial ? fmt::format(", lambda = {:.6g}", lambda) : "", mass, q[0], q[1], p[0],
                     p[1]);
}

OrbitPath orbit_path(const OrbitCase& orbit) {
  return follow<double, DormandPrince853>(orbit, AdaptiveOptions{.tolerance = 1e-13});
}
OrbitPath orbit_path_confirmed(const OrbitCase& orbit) {
  return follow<long double, ExtrapolatedMidpointMethod>(orbit, ExtrapolationOptions{.tolerance = 1e-17});
}

ConicFit conic_through(const OrbitPath& path) {
  const auto points = normalised_points(path);
  Six m{};
  for (const auto& [x, y] : points) {
    const std::array<long double, 6> row{x * x, x * y, y * y, x, y, 1};
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j < 6; ++j) m[i][j] += row[i] * row[j] / static_cast<long double>(points.size());
    }
  }
  const Six v = diagonalise(m);
  std::size_t least = 0;
  for (std::size_t i = 1; i < 6; ++i) {
    if (m[i][i] < m[least][least]) least = i;
  }
  long double second = 1e30L;
  for (std::size_t i = 0; i < 6; ++i) {
    if (i != least) second = std::min(second, m[i][i]);
  }
  ConicFit fit;
  fit.misfit = static_cast<double>(std::sqrt(std::max(m[least][least], 0.0L)));
  fit.discriminant = static_cast<double>(v[1][least] * v[1][least] - 4 * v[0][least] * v[2][least]);
  // The normal equations resolve squares down to 1e-19, so a misfit below 1e-9 is rounding. The error of the
  // coefficients is the misfit divided by the misfit of the second best conic (`distance`).
  constexpr double floor = 1e-9;
  const double distance = static_cast<double>(std::sqrt(std::max(second, 0.0L)));
  const double unsure = 20 * std::max(fit.misfit, floor) / distance;
  if (!(fit.misfit >= 0) || !(distance > 0)) return fit;
  if (fit.misfit > 1e-6) {
    fit.shape = OrbitShape::no_conic;
  } else if (fit.misfit < 10 * floor && unsure < 1e-2) {
    fit.shape = std::abs(fit.discriminant) < unsure ? OrbitShape::parabola
                : fit.discriminant < 0              ? OrbitShape::ellipse
                                                    : OrbitShape::hyperbola;
  }
  return fit;
}

double drawn(std::uint64_t seed, std::uint64_t number) { return (counter_uniform(seed, number) + 1) / 2; }

}  // namespace hamflow::reproduction
