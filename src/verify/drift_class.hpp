// Private to hamflow_verify: statistics that are used both for one run and for ensembles.
#pragma once

#include "hamflow/detail/verify/drift.hpp"

namespace hamflow {

/// Returns the p-value of the t-test that the increments of one series have mean 0.
double increments_p_value(const std::vector<double>& energies);
/// Returns the class by the rules of docs/design/certificates.md.
DriftClass drift_class(double p_value, double growth_exponent);

}  // namespace hamflow
