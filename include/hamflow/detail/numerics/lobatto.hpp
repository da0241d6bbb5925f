// Lobatto quadrature on [0, 1] and the collocation matrices of the pair IIIA, IIIB.   [HLW2006, Sect. II.1.4, II.2.2]
//     c_1 = 0, c_s = 1, between them the zeros of P'_(s-1), b_i = 1/(s (s - 1) P_(s-1)(2 c_i - 1)^2): exact to degree
//     2 s - 3.   a_ij = int_0^(c_i) l_j of IIIA,   b_i A_ij + b_j a_ji = b_i b_j for A of IIIB.
// With a_ij/b_j = 1/2 + nu_ij this condition means A_ij/b_j = 1/2 - nu_ji: a pair that uses the same nu for both is
// symplectic, whatever the rounding of nu. The orthonormal shifted Legendre polynomials are orthogonal in the discrete
// sense too, with the norm gamma = (2 s - 1)/(s - 1) of the last one and 1 of the others, and so
//     nu_ij = int_(1/2)^(c_i) 1 + sum_(m>0) P_m(c_j) I_m(c_i)/gamma_m,   I_m(c) = int_0^c P_m.
#pragma once

#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "hamflow/core/number.hpp"
#include "hamflow/detail/arithmetic/number_types.hpp"
#include "hamflow/detail/numerics/legendre.hpp"

namespace hamflow {

template <class R>
struct LobattoPair {
  int stages = 0;
  std::vector<R> offset;  // c - 1/2, odd about the middle of the step to the last bit
  std::vector<R> b;
  std::vector<R> nu;  // row by row, nu_(s+1-i,s+1-j) = -nu_ij; -1/2 in the first row, 1/2 in the last
};

namespace detail {

/// x in (-1, 1) with (1 - x^2) P'_n(x) = n (P_(n-1) - x P_n) = 0, and P_n there, by Newton's iteration from `x`.
template <class R>
std::pair<R, R> lobatto_zero(int n, R x) {
  R last(0);
  for (int pass = 0; pass < 12; ++pass) {  // quadratic from a tenth
    R before(1);
    last = x;
    for (int k = 2; k <= n; ++k) {
      const R next = (R(2 * k - 1) * x * last - R(k - 1) * before) / R(k);
      before = last;
      last = next;
    }
    x = x + (before - x * last) / (R(n + 1) * last);
  }
  return {x, last};
}

template <class R>
LobattoPair<R> made_lobatto_pair(int stages) {
  const auto s = static_cast<std::size_t>(stages);
  LobattoPair<R> pair{stages, std::vector<R>(s), std::vector<R>(s), std::vector<R>(s * s)};
  const int n = stages - 1;
  for (std::size_t i = 0; 2 * i < s; ++i) {
    const std::size_t j = s - 1 - i;
    const bool in_the_middle = i == j;
    R x(1);
    R p(1);
    if (i > 0) {
      const auto found =
          lobatto_zero<R>(n, in_the_middle ? R(0) : R(cos(pi_value<R>() * R(static_cast<int>(i)) / R(n))));
      x = in_the_middle ? R(0) : found.first;
      p = found.second;
    }
    pair.offset[i] = -x / R(2);
    pair.offset[j] = in_the_middle ? R(0) : R(x / R(2));
    pair.b[i] = pair.b[j] = R(1) / (R(stages) * R(n) * p * p);
  }
  std::vector<std::vector<R>> values;
  std::vector<std::vector<R>> integrals;
  for (const R& x : pair.offset) {
    values.push_back(legendre_values<R>(stages, x));
    integrals.push_back(legendre_integrals<R>(stages, x));
  }
  const R gamma = R(2 * stages - 1) / R(n);
  for (std::size_t i = 0; i < s; ++i) {
    for (std::size_t j = 0; j < s; ++j) {
      const std::size_t here = i * s + j;
      const std::size_t there = (s - 1 - i) * s + (s - 1 - j);
      if (here > there) continue;
      R nu = integrals[i][s - 1] * values[j][s - 1] / gamma;
      for (std::size_t m = s - 1; m-- > 0;) nu += integrals[i][m] * values[j][m];
      if (i == 0) nu = R(-0.5);
      pair.nu[here] = nu;
      pair.nu[there] = here == there ? R(0) : R(-nu);
      if (here == there) pair.nu[here] = R(0);
    }
  }
  return pair;
}
}  // namespace detail

/// Returns a pair, which is computed once for each number type and keeps its address.   @param stages at least 2
template <class R>
const LobattoPair<R>& lobatto_pair(int stages) {
  static std::mutex mutex;
  static std::map<std::pair<long, int>, LobattoPair<R>> pairs;
  const std::lock_guard lock(mutex);
  const std::pair key{precision_in_use<R>(), stages};
  const auto found = pairs.find(key);
  if (found != pairs.end()) return found->second;
  if constexpr (std::is_same_v<R, double>) {  // computed in Wide and rounded once
    const auto fine = detail::made_lobatto_pair<Wide>(stages);
    LobattoPair<double> pair{stages, {}, {}, {}};
    for (const Wide& x : fine.offset) pair.offset.push_back(static_cast<double>(x));
    for (const Wide& x : fine.b) pair.b.push_back(static_cast<double>(x));
    for (const Wide& x : fine.nu) pair.nu.push_back(static_cast<double>(x));
    return pairs.emplace(key, std::move(pair)).first->second;
  } else {
    return pairs.emplace(key, detail::made_lobatto_pair<R>(stages)).first->second;
  }
}

}  // namespace hamflow
