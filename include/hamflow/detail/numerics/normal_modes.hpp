// The symmetric generalised eigenvalue problem of small oscillations.
#pragma once

#include <cstddef>

namespace hamflow {

/// C l = lambda M l for symmetric C and symmetric positive M of n rows, both row after row: the eigenvalues, ascending,
/// and the eigenvectors with l_i^T M l_j = delta_ij as the columns of `vectors`, row after row.
/// @return false if M is not positive definite or an entry is not finite
bool normal_modes(const long double* m, const long double* c, std::size_t n, long double* eigenvalues,
                  long double* vectors);

}  // namespace hamflow
