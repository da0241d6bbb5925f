// Private to hamflow_verify: what the statistics of a run and those of an ensemble share.
#pragma once

#include "hamflow/detail/verify/drift.hpp"

namespace hamflow {

/// p-value of the t-test that the increments of one series have mean 0.
double increments_p_value(const std::vector<double>& energies);
/// The class by the rules of docs/design/certificates.md.
DriftClass drift_class(double p_value, double growth_exponent);

}  // namespace hamflow
