#include "hamflow/detail/verify/drift.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

#include "drift_class.hpp"

namespace hamflow {

double student_p_value(double t, int degrees_of_freedom) {
  return 2 * boost::math::cdf(boost::math::complement(boost::math::students_t(degrees_of_freedom), std::abs(t)));
}

double student_quantile(double p_value, int degrees_of_freedom) {
  return boost::math::quantile(boost::math::complement(boost::math::students_t(degrees_of_freedom), p_value / 2));
}

double fitted_slope(const std::vector<double>& x, const std::vector<double>& y) {
  const double count = static_cast<double>(x.size());
  double mean_x = 0;
  double mean_y = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += x[i] / count;
    mean_y += y[i] / count;
  }
  double xy = 0;
  double xx = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xy += (x[i] - mean_x) * (y[i] - mean_y);
    xx += (x[i] - mean_x) * (x[i] - mean_x);
  }
  return xy / xx;
}

double increments_p_value(const std::vector<double>& energies) {
  const std::size_t blocks = energies.size() - 1;
  const double mean = (energies.back() - energies.front()) / static_cast<double>(blocks);
  double squares = 0;
  for (std::size_t b = 0; b < blocks; ++b) {
    const double deviation = energies[b + 1] - energies[b] - mean;
    squares += deviation * deviation;
  }
  const double variance_of_mean = squares / static_cast<double>(blocks - 1) / static_cast<double>(blocks);
  if (variance_of_mean == 0) return mean == 0 ? 1 : 0;
  const double p = student_p_value(mean / std::sqrt(variance_of_mean), static_cast<int>(blocks) - 1);
  return p < std::numeric_limits<double>::min() ? 0 : p;  // a subnormal number has lost digits
}

DriftClass drift_class(double p_value, double growth_exponent) {
  if (p_value < DriftStatistics::level || growth_exponent > DriftStatistics::linear_above) return DriftClass::linear;
  return growth_exponent > DriftStatistics::random_walk_above ? DriftClass::random_walk : DriftClass::bounded;
}

namespace {
/// Returns the growth exponent of the RMS of H - H0 over all starts and over the blocks of the windows [2^j, 2^(j+1)).
double growth_exponent(const std::vector<std::vector<double>>& energies) {
  std::vector<double> log_time;
  std::vector<double> log_error;
  const std::size_t blocks = energies.front().size() - 1;
  for (std::size_t begin = 1; begin * 2 - 1 <= blocks; begin *= 2) {
    double squares = 0;
    for (const auto& series : energies) {
      for (std::size_t b = begin; b < 2 * begin; ++b) squares += std::pow(series[b] - series.front(), 2);
    }
    if (squares == 0) continue;  // no energy has changed
    log_time.push_back(std::log2(static_cast<double>(begin)));
    log_error.push_back(std::log2(squares / static_cast<double>(begin * energies.size())) / 2);
  }
  return log_time.size() < 2 ? 0 : fitted_slope(log_time, log_error);
}
}  // namespace

DriftStatistics classify_drift(const std::vector<std::vector<double>>& energies) {
  DriftStatistics found;
  std::size_t longest = 0;
  for (const auto& series : energies) longest = std::max(longest, series.size());
  const bool broken = longest < 33 || std::any_of(energies.begin(), energies.end(), [&](const auto& series) {
                        return series.size() < longest ||
                               !std::all_of(series.begin(), series.end(), [](double h) { return std::isfinite(h); });
                      });
  if (broken) {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    return {unknown, unknown, std::nullopt};
  }
  // The smallest of m p-values is multiplied by m (Bonferroni correction). So a drift whose sign depends on the start
  // is found, too.
  double smallest = 1;
  for (const auto& series : energies) smallest = std::min(smallest, increments_p_value(series));
  found.p_value = std::min(1.0, smallest * static_cast<double>(energies.size()));
  found.growth_exponent = growth_exponent(energies);
  found.drift = drift_class(found.p_value, found.growth_exponent);
  return found;
}

}  // namespace hamflow
