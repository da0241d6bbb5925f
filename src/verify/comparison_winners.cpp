// Which method comes to an error most cheaply, between the steps of each.
#include <algorithm>
#include <cmath>

#include "hamflow/verify/comparison.hpp"

namespace hamflow {

namespace {

struct Curve {
  std::string method;
  std::vector<const ComparisonPoint*> points;
};

/// log10(work) at which a method first reaches log10(error) = level, by the segments between its points.
std::optional<double> work_for(const Curve& method, double level, bool by_time, double floor) {
  std::vector<std::pair<double, double>> curve;  // work, error
  for (const ComparisonPoint* p : method.points) {
    const double work = by_time ? p->seconds : p->evaluations();
    if (work > 0) curve.emplace_back(std::log10(work), std::max(p->error.log10, floor));
  }
  std::sort(curve.begin(), curve.end());
  for (std::size_t i = 0; i + 1 < curve.size(); ++i) {
    const auto [w0, e0] = curve[i];
    const auto [w1, e1] = curve[i + 1];
    if (e0 >= level && e1 <= level) return e0 == e1 ? w0 : w0 + (w1 - w0) * (e0 - level) / (e0 - e1);
  }
  return std::nullopt;
}

/// 10^level, as a text where the doubles end.
Magnitude power_of_ten(int level) { return Magnitude("1e" + std::to_string(level)); }

}  // namespace

std::vector<ComparisonWinner> winners(const Comparison& comparison) {
  // An error that is not well above the uncertainty of the reference is none.
  const double floor = comparison.reference.uncertainty.log10;
  const double told = floor + std::log10(4.0);
  std::vector<Curve> methods;
  double highest = -1e300;
  double lowest = 1e300;
  for (const ComparisonPoint& p : comparison.points) {
    if (methods.empty() || methods.back().method != p.method) methods.push_back({p.method, {}});
    if (!p.done() || !(p.error.log10 < 400)) continue;
    methods.back().points.push_back(&p);
    highest = std::max(highest, std::floor(std::max(p.error.log10, floor)));
    lowest = std::min(lowest, std::ceil(std::max(p.error.log10, told)));
  }
  std::vector<ComparisonWinner> all;
  if (!(lowest > -1e300) || !(highest < 1e300)) return all;
  for (const bool by_time : {false, true}) {
    for (int level = static_cast<int>(highest); level >= static_cast<int>(lowest); --level) {
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
