// Private to hamflow_verify.
#pragma once

#include <cmath>
#include <vector>

namespace hamflow {

/// Visits the entries of M^T J M - J for a 2n x 2n matrix M given by rows, J = ((0, I), (-I, 0)). They are all 0 if M
/// is symplectic. The matrix is antisymmetric bit for bit, so only entries (a, b) with a > b are visited.   [HLW2006,
/// Def. VI.2.1]
/// @param take called with the absolute value of each entry and the sum of the absolute values of its terms
template <class Take>
void for_each_symplectic_defect(const std::vector<std::vector<double>>& m, Take take) {
  const std::size_t n = m.size() / 2;
  for (std::size_t a = 0; a < 2 * n; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      double value = a == b + n ? 1 : 0;  // -J_ab
      double terms = 1;
      for (std::size_t i = 0; i < n; ++i) {
        const double left = m[i][a] * m[n + i][b];
        const double right = m[n + i][a] * m[i][b];
        value += left - right;
        terms += std::abs(left) + std::abs(right);
      }
      take(std::abs(value), terms);
    }
  }
}

/// The same along some directions: b_a^T (M^T J M - J) b_b. A map of a manifold is symplectic on the tangent spaces of
/// the manifold.
template <class Take>
void for_each_symplectic_defect_along(const std::vector<std::vector<double>>& m,
                                      const std::vector<std::vector<double>>& directions, Take take) {
  const std::size_t n = m.size() / 2;
  std::vector<std::vector<double>> images;
  for (const auto& b : directions) {
    images.emplace_back(2 * n);
    for (std::size_t i = 0; i < 2 * n; ++i) {
      for (std::size_t j = 0; j < 2 * n; ++j) images.back()[i] += m[i][j] * b[j];
    }
  }
  for (std::size_t a = 0; a < directions.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      double value = 0;
      double terms = 1;
      const auto form = [&](const std::vector<double>& x, const std::vector<double>& y, int sign) {
        for (std::size_t i = 0; i < n; ++i) {
          const double left = x[i] * y[n + i];
          const double right = x[n + i] * y[i];
          value += sign * (left - right);
          terms += std::abs(left) + std::abs(right);
        }
      };
      form(images[a], images[b], 1);
      form(directions[a], directions[b], -1);
      take(std::abs(value), terms);
    }
  }
}

}  // namespace hamflow
