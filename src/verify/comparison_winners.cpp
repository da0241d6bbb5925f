// Finds the method that reaches an error with the least work, by interpolation between the step sizes of each method.
#include <algorithm>
#include <cmath>

#include "hamflow/verify/comparison.hpp"

namespace hamflow {

namespace {

struct Curve {
  std::string method;
  std::vector<const ComparisonPoint*> points;
};

/// Returns the least log10(work) with which a method reaches log10(error) = level: that of a point at or below the
/// level, or that of the place at which a segment between two points reaches it. If the largest step of a method is
/// already below the level, its point counts.
std::optional<double> work_for(const Curve& method, double level, bool by_time, double floor) {
  std::vector<std::pair<double, double>> curve;  // pairs of log10(work) and log10(error)
  for (const ComparisonPoint* p : method.points) {
    const double work = by_time ? p->seconds : p->evaluations();
    if (work > 0) curve.emplace_back(std::log10(work), std::max(p->error.log10, floor));
  }
  std::sort(curve.begin(), curve.end());
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const auto [w1, e1] = curve[i];
    if (e1 > level) continue;
    if (i == 0 || std::isinf(e1)) return w1;  // the error is 0, so there is nothing to interpolate
    const auto [w0, e0] = curve[i - 1];       // its error is above the level, otherwise the loop had ended there
    return w0 + (w1 - w0) * (e0 - level) / (e0 - e1);
  }
  return std::nullopt;
}

/// 10^level, as text if it is outside the range of double.
Magnitude power_of_ten(int level) { return Magnitude("1e" + std::to_string(level)); }

}  // namespace

std::vector<ComparisonWinner> winners(const Comparison& comparison) {
  // An error that is not well above the uncertainty of the reference does not count.
  const double floor = comparison.reference.uncertainty.log10;
  const double least_error = floor + std::log10(4.0);
  constexpr double size = 0;  // log10 of a relative error of 1; with a larger error a method approximates nothing
  std::vector<Curve> methods;
  // Levels are powers of ten in the range of mp(100000). An error of exactly 0 gives no level.
  constexpr int least = -100000;
  int highest = least;
  int lowest = 400;
  for (const ComparisonPoint& p : comparison.points) {
    if (methods.empty() || methods.back().method != p.method) methods.push_back({p.method, {}});
    if (!p.done() || !(p.error.log10 < size)) continue;
    methods.back().points.push_back(&p);
    const double error = std::max(p.error.log10, floor);
    if (!(error >= least)) continue;
    highest = std::max(highest, static_cast<int>(std::floor(error)));
    lowest = std::min(lowest, static_cast<int>(std::ceil(std::max(error, least_error))));
  }
  std::vector<ComparisonWinner> all;
  for (const bool by_time : {false, true}) {
    for (int level = highest; level >= lowest; --level) {
      std::vector<std::pair<double, std::string>> ranking;
      for (const Curve& method : methods) {
        if (const auto work = work_for(method, level, by_time, floor)) ranking.emplace_back(*work, method.method);
      }
      if (ranking.empty()) continue;
      std::sort(ranking.begin(), ranking.end());
      ComparisonWinner w{power_of_ten(level),
                         by_time ? "seconds" : "evaluations",
                         ranking[0].second,
                         std::pow(10.0, ranking[0].first),
                         "",
                         0};
      if (ranking.size() > 1) {
        w.second = ranking[1].second;
        w.second_work = std::pow(10.0, ranking[1].first);
      }
      all.push_back(w);
    }
  }
  return all;
}

}  // namespace hamflow
