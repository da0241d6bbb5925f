#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "hamflow/figures/curves.hpp"

namespace hamflow::figures {

namespace {

struct Point {
  double x = 0;
  double y = 0;
};

/// Marching squares; the crossings are found by bisection.
class LevelTracer {
 public:
  LevelTracer(const std::function<double(double, double)>& h, double level, const Extent& q, const Extent& p)
      : h_(h), level_(level), q_(q), p_(p), value_(nodes * nodes) {
    for (int j = 0; j <= cells; ++j) {
      for (int i = 0; i <= cells; ++i) value_[node(i, j)] = excess(q_at(i), p_at(j));
    }
  }

  Curve trace() {
    for (int j = 0; j < cells; ++j) {
      for (int i = 0; i < cells; ++i) cross_cell(i, j);
    }
    Curve curve;
    for (const bool open : {true, false}) {  // first the branches that end at the border, then closed ones
      for (const auto& [edge, links] : links_) {
        if (!done_.contains(edge) && (!open || links.size() == 1)) follow(edge, curve);
      }
    }
    return curve;
  }

 private:
  static constexpr int cells = 400;
  static constexpr std::size_t nodes = cells + 1;
  using Edge = std::size_t;  // twice the index of its lower left node, plus one if the edge is vertical

  static std::size_t node(int i, int j) { return static_cast<std::size_t>(j) * nodes + static_cast<std::size_t>(i); }
  static double between(double low, double high, double part) { return low * (1 - part) + high * part; }
  double q_at(double i) const { return between(q_.low, q_.high, i / cells); }
  double p_at(double j) const { return between(p_.low, p_.high, j / cells); }
  double excess(double q, double p) const { return h_(q, p) - level_; }

  void cross_cell(int i, int j) {
    const std::array<double, 4> corner{value_[node(i, j)], value_[node(i + 1, j)], value_[node(i + 1, j + 1)],
                                       value_[node(i, j + 1)]};
    for (const double f : corner) {
      if (!std::isfinite(f)) return;
    }
    const std::array<Edge, 4> side{2 * node(i, j), 2 * node(i + 1, j) + 1, 2 * node(i, j + 1), 2 * node(i, j) + 1};
    std::array<std::size_t, 4> crossed{};
    std::size_t count = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      if ((corner[k] < 0) != (corner[(k + 1) % 4] < 0) && find(side[k])) crossed[count++] = k;
    }
    if (count == 2) {
      link(side[crossed[0]], side[crossed[1]]);
    } else if (count == 4) {  // a saddle; the value at the centre decides which crossings belong together
      const bool centre = excess(q_at(i + 0.5), p_at(j + 0.5)) < 0;
      const bool turned = centre == (corner[0] < 0);
      link(side[0], side[turned ? 1 : 3]);
      link(side[2], side[turned ? 3 : 1]);
    }
  }

  /// Finds the crossing of an edge. Returns false at a pole, where H changes sign without being zero.
  bool find(Edge edge) {
    if (points_.contains(edge)) return true;
    const int i = static_cast<int>((edge / 2) % nodes);
    const int j = static_cast<int>((edge / 2) / nodes);
    const bool up = edge % 2 == 1;
    const auto at = [&](double part) { return up ? Point{q_at(i), p_at(j + part)} : Point{q_at(i + part), p_at(j)}; };
    const auto f = [&](double part) { return excess(at(part).x, at(part).y); };
    const double start = f(0);
    double low = 0;
    double high = 1;
    for (int n = 0; n < 60; ++n) {
      const double middle = 0.5 * (low + high);
      ((f(middle) < 0) == (start < 0) ? low : high) = middle;
    }
    if (!(std::abs(f(high)) <= std::max(std::abs(start), std::abs(f(1))))) return false;
    points_[edge] = at(high);
    return true;
  }
  void link(Edge a, Edge b) {
    links_[a].push_back(b);
    links_[b].push_back(a);
  }
  void follow(Edge start, Curve& curve) {
    Edge edge = start;
    for (bool more = true; more;) {
      done_.insert(edge);
      curve.add(points_[edge].x, points_[edge].y);
      more = false;
      for (const Edge next : links_[edge]) {
        if (done_.contains(next)) continue;
        edge = next;
        more = true;
        break;
      }
    }
    const std::vector<Edge>& last = links_[edge];
    const bool closes = edge != start && links_[start].size() == 2 && std::count(last.begin(), last.end(), start) > 0;
    if (closes) curve.add(points_[start].x, points_[start].y);
    curve.lift();
  }

  const std::function<double(double, double)>& h_;
  double level_;
  Extent q_;
  Extent p_;
  std::vector<double> value_;
  std::map<Edge, Point> points_;
  std::map<Edge, std::vector<Edge>> links_;
  std::set<Edge> done_;
};

}  // namespace

Curve level_curve(const std::function<double(double, double)>& h, double level, const Extent& q, const Extent& p) {
  return LevelTracer(h, level, q, p).trace();
}

}  // namespace hamflow::figures
