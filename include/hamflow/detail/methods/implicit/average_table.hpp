// The coefficients of an implicit step whose unknowns are averages of the motion along the step. With f = J grad H
//     u_i = h sum_l W_il f(y_l),   y_l = (z0 + z1)/2 + sum_j N_lj u_j,   z1 = z0 + sum_j e_j u_j,   i, j < k,  l < s.
// Energy-conserving elements [Gross1999, (1.34), (1.35); BrugnanoIavernaroTrigiante2010]: u_i = h int P_i f dc are the
// coefficients of h z' in orthonormal Legendre polynomials; their number k does not depend on the number s of Gauss
// points,
//     W_il = b_l P_i(c_l),   N_l0 = c_l - 1/2,  N_lj = int_0^(c_l) P_j,   e = (1, 0, .. 0).
// Gauss collocation in stages [HLW2006, II.1.3]: u_i = L_i = h b_i f(Y_i),   Y_i = z0 + sum_j mu_ij L_j,  mu =
// a_ij/b_j,
//     W = diag(b),   N_ij = mu_ij - 1/2,   e = (1, .. 1).
// b_i a_ij + b_j a_ji = b_i b_j means mu_ij + mu_ji = 1, so N is antisymmetric. Only the upper half is computed and the
// lower half copied, so that the map is exactly symplectic with rounded coefficients.   [AntonanaMakazagaMurua2017]
//
// If H = p^T M^-1 p/2 + V(q), the part of u in q follows from the part in p, with exact quadrature:
//     u^q_j = h beta_j M^-1 (omega_j (p0 + p1)/2 + sum_i A_ji u^p_i),   A antisymmetric;
// elements: beta = 1, omega = e, A_(j,j-1) = xi_j; stages: beta = b, omega = 1, A = N.
#pragma once

#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "hamflow/detail/numerics/exact_product.hpp"
#include "hamflow/detail/numerics/legendre.hpp"
#include "hamflow/numerics/gauss_legendre.hpp"

namespace hamflow {

template <class R>
struct AverageTable {
  int points = 0;    // s
  int averages = 0;  // k
  // Matrices are stored such that sums run over contiguous entries. Symmetries about the middle of the step are exact
  // to the last bit.
  std::vector<R> inner;        // N_lj at [j s + l]
  std::vector<R> weight;       // W_il at [l k + i]
  std::vector<R> unit_weight;  // kappa W_il, see detail::golden_ratio
  bool diagonal = false;       // whether W is diagonal
  std::vector<R> increment;    // e_j
  std::vector<R> scale;        // beta_j
  std::vector<R> middle;       // omega_j
  std::vector<R> coupling;     // A_ij at [i k + j]
  std::vector<R> next;         // maps the averages of a polynomial motion to those of the next step, at [j k + i]
  // Only for the Jacobian, at index [l k k + i k + j].
  std::vector<R> tangent_weights;          // W_il dy_l/du_j, dy_l/du_j = e_j/2 + N_lj
  std::vector<R> natural_tangent_weights;  // W_il dq_l/du^p_j, without h M^-1
};

namespace detail {

/// Extrapolated to the next step, P_j grows by up to 5.8^j, and so does the rounding of u_j. Legendre terms from this
/// degree on are not extrapolated.
inline constexpr int most_continued = 8;

/// Computes the coefficients that follow from the others.
template <class R>
void complete(AverageTable<R>& t) {
  const auto k = static_cast<std::size_t>(t.averages);
  const auto s = static_cast<std::size_t>(t.points);
  for (const R& w : t.weight) t.unit_weight.push_back(golden_ratio<R>() * w);
  for (std::size_t l = 0; l < s; ++l) {
    for (std::size_t i = 0; i < k; ++i) {
      const R& w = t.weight[l * k + i];
      for (std::size_t j = 0; j < k; ++j) {
        t.tangent_weights.push_back(w * (t.increment[j] / R(2) + t.inner[j * s + l]));
        R reach(0);
        for (std::size_t m = 0; m < k; ++m) {
          const R by_momenta = t.scale[m] * (t.middle[m] * t.increment[j] / R(2) + t.coupling[m * k + j]);
          reach += (t.increment[m] / R(2) + t.inner[m * s + l]) * by_momenta;
        }
        t.natural_tangent_weights.push_back(w * reach);
      }
    }
  }
}

template <class R>
AverageTable<R> made_element_table(int averages, int points) {
  const GaussRule<R>& rule = gauss_rule<R>(points);
  const auto k = static_cast<std::size_t>(averages);
  const auto s = static_cast<std::size_t>(points);
  AverageTable<R> t{points, averages};
  t.inner.resize(k * s);
  t.weight.resize(k * s);
  t.increment.resize(k);
  t.middle.resize(k);
  t.scale.assign(k, R(1));
  t.coupling.resize(k * k);
  t.next.resize(k * k);
  t.increment[0] = t.middle[0] = R(1);
  for (std::size_t l = 0; l < s; ++l) {
    const std::vector<R> p = legendre_values<R>(averages, rule.offset[l]);
    const std::vector<R> integrals = legendre_integrals<R>(averages, rule.offset[l]);
    for (std::size_t j = 0; j < k; ++j) {
      t.weight[l * k + j] = rule.b[l] * p[j];
      t.inner[j * s + l] = integrals[j];
    }
  }
  for (std::size_t j = 1; j < k; ++j) {
    t.coupling[j * k + j - 1] = legendre_step<R>(static_cast<int>(j));
    t.coupling[(j - 1) * k + j] = -t.coupling[j * k + j - 1];
  }
  // int P_i(c) P_j(1 + c) dc, exact with k points.
  const GaussRule<R>& exact = gauss_rule<R>(averages);
  for (std::size_t l = 0; l < k; ++l) {
    const std::vector<R> p = legendre_values<R>(averages, exact.offset[l]);
    const std::vector<R> after = legendre_values<R>(averages, R(1) + exact.offset[l]);
    for (std::size_t i = 0; i < k; ++i) {
      for (std::size_t j = i; j < k && j < most_continued; ++j) t.next[j * k + i] += exact.b[l] * p[i] * after[j];
    }
  }
  complete(t);
  return t;
}

template <class R>
AverageTable<R> made_stage_table(int stages) {
  const GaussRule<R>& rule = gauss_rule<R>(stages);
  const auto k = static_cast<std::size_t>(stages);
  AverageTable<R> t{stages, stages};
  t.inner.resize(k * k);
  t.weight.resize(k * k);
  t.diagonal = true;
  t.increment.assign(k, R(1));
  t.middle.assign(k, R(1));
  t.scale = rule.b;
  t.coupling.resize(k * k);
  t.next.resize(k * k);
  std::vector<std::vector<R>> p;
  std::vector<std::vector<R>> integrals;
  std::vector<std::vector<R>> after;
  for (const R& x : rule.offset) {
    p.push_back(legendre_values<R>(stages, x));
    integrals.push_back(legendre_integrals<R>(stages, x));
    after.push_back(legendre_values<R>(stages, R(1) + x));
  }
  for (std::size_t i = 0; i < k; ++i) t.weight[i * k + i] = rule.b[i];
  for (std::size_t i = 0; i < k; ++i) {
    for (std::size_t j = i + 1; j < k && i + j < k; ++j) {
      // mu_ij = sum_m I_m(c_i) P_m(c_j), and by reflection of the step mu_ij = 1 - mu_(k-1-i,k-1-j).
      R n(0);
      for (std::size_t m = k; m-- > 0;) n += integrals[i][m] * p[j][m];
      t.coupling[i * k + j] = t.coupling[(k - 1 - j) * k + k - 1 - i] = n;
      t.coupling[j * k + i] = t.coupling[(k - 1 - i) * k + k - 1 - j] = -n;
    }
  }
  for (std::size_t i = 0; i < k; ++i) {
    for (std::size_t j = 0; j < k; ++j) t.inner[j * k + i] = t.coupling[i * k + j];
  }
  for (std::size_t i = 0; i < k; ++i) {
    for (std::size_t j = 0; j < k; ++j) {
      for (std::size_t m = 0; m < k && m < most_continued; ++m) t.next[j * k + i] += rule.b[i] * after[i][m] * p[j][m];
    }
  }
  complete(t);
  return t;
}

template <class To, class From>
AverageTable<To> rounded(const AverageTable<From>& t) {
  const auto round = [](const std::vector<From>& from) {
    std::vector<To> to;
    for (const From& x : from) to.push_back(static_cast<To>(x));
    return to;
  };
  return {t.points,
          t.averages,
          round(t.inner),
          round(t.weight),
          round(t.unit_weight),
          t.diagonal,
          round(t.increment),
          round(t.scale),
          round(t.middle),
          round(t.coupling),
          round(t.next),
          round(t.tangent_weights),
          round(t.natural_tangent_weights)};
}

/// Tables by number. Each is made once, and its address does not change.
/// @param make() makes the table; for double in Wide, to round only once
template <class R, class Make>
const AverageTable<R>& kept_table(int averages, int points, const Make& make) {
  static std::mutex mutex;
  static std::map<std::pair<long, std::pair<int, int>>, AverageTable<R>> tables;
  const std::lock_guard lock(mutex);
  const std::pair key{precision_in_use<R>(), std::pair{averages, points}};
  const auto found = tables.find(key);
  if (found != tables.end()) return found->second;
  if constexpr (std::is_same_v<R, double>) {
    return tables.emplace(key, rounded<double>(make.template operator()<Wide>())).first->second;
  } else {
    return tables.emplace(key, make.template operator()<R>()).first->second;
  }
}

}  // namespace detail

/// cg(averages, points). @param points averages .. most_gauss_points
template <class R>
const AverageTable<R>& element_table(int averages, int points) {
  return detail::kept_table<R>(averages, points,
                               [&]<class Fine>() { return detail::made_element_table<Fine>(averages, points); });
}

/// gauss(stages).
template <class R>
const AverageTable<R>& stage_table(int stages) {
  return detail::kept_table<R>(stages, stages, [&]<class Fine>() { return detail::made_stage_table<Fine>(stages); });
}

}  // namespace hamflow
