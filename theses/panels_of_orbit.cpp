#include "panels_of_orbit.hpp"

#include <algorithm>
#include <cmath>

#include "hamflow/figures/panel_axes.hpp"

namespace hamflow::reproduction {

using namespace figures;

Page orbit_page(const std::string& title, const Trajectory& dots, const Trajectory& exact,
                const std::function<double(double)>& V, double mu) {
  Panel orbit;
  const Curve line{exact.coordinate(0), exact.coordinate(1)};
  const Curve points{dots.coordinate(0), dots.coordinate(1)};
  Extent x, y;
  x.include(line.x);
  x.include(points.x);
  y.include(line.y);
  y.include(points.y);
  x.include(0);
  y.include(0);
  fit_equal_axes(orbit, x, y);
  orbit.x_label = "{/:Italic x}";
  orbit.y_label = "{/:Italic y}";
  orbit.series.push_back({Ink::exact, "exact", line});
  orbit.series.push_back({Ink::dots, "cg(1,5)", points});

  // E over t and V_eff over r share one axis of energies, as in the thesis.
  const double l = dots.q[0][0] * dots.p[0][1] - dots.q[0][1] * dots.p[0][0];
  const double energy = dots.energy.front();
  Curve effective;
  double furthest = 0, nearest = 1e300;
  for (const auto& q : exact.q) {
    const double r = std::hypot(q[0], q[1]);
    furthest = std::max(furthest, r);
    nearest = std::min(nearest, r);
  }
  const auto at = [&](double r) { return V(r) + l * l / (2 * mu * r * r); };
  double lowest = energy;
  for (int i = 0; i <= 400; ++i) lowest = std::min(lowest, at(nearest + (furthest - nearest) * i / 400.0));
  const double room = std::max(2 * (energy - lowest), 0.5 * std::max(std::abs(energy), std::abs(V(nearest))));
  const double end = std::max(1.4 * furthest, dots.t.back());
  for (int i = 0; i <= 800; ++i) {
    const double r = nearest / 3 * std::pow(3 * end / nearest, i / 800.0);
    if (std::abs(at(r) - energy) <= room) effective.add(r, at(r));
  }
  Extent across, up;
  across.include(0);
  across.include(dots.t);
  across.include(1.4 * furthest);
  up.include(effective.y);
  up.include(energy);
  Panel below;
  below.x = fit_axis(across, 0, {7, 40});
  below.y = fit_axis(up, padding, {6});
  below.x_label = "{/:Italic t}, {/:Italic r}";
  below.y_label = "{/:Italic E}, {/:Italic V}'";
  below.series.push_back({Ink::line, "{/:Italic V}'({/:Italic r})", effective, {.colour = "#d55e00", .dash = 2}});
  below.series.push_back({Ink::exact, "exact", {{0, dots.t.back()}, {energy, energy}}});
  below.series.push_back({Ink::dots, "{/:Italic E}({/:Italic t})", thin_out({dots.t, dots.energy}, 200)});
  return {title, {orbit, below}};
}

}  // namespace hamflow::reproduction
