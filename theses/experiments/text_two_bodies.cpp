// [Gross1999]: what the text says of its figures of chapter 2 that can be measured, by page.
#include <fmt/format.h>

#include <cmath>

#include "../experiment.hpp"
#include "../scenarios.hpp"

namespace hamflow::reproduction {

namespace text_two_bodies {

Trajectory run(Study& study, const char* name, const char* figure, int steps) {
  return study.run(name, scenario_of(figure),
                   in_steps("0.01", steps, 1, "method={ name = \"taylor\", tolerance = 1e-14 }"));
}

/// The length of the path from pericentre, where it starts, to the second apocentre less that to the first.
double length_between_touches(const Trajectory& t) {
  double length = 0, first = 0;
  int touches = 0;
  for (std::size_t i = 1; i < t.size(); ++i) {
    length += std::hypot(t.q[i][0] - t.q[i - 1][0], t.q[i][1] - t.q[i - 1][1]);
    const auto rate = [&](std::size_t k) { return t.q[k][0] * t.p[k][0] + t.q[k][1] * t.p[k][1]; };
    if (rate(i - 1) > 0 && rate(i) <= 0) {
      if (++touches == 2) return length - first;
      first = length;
    }
  }
  return std::nan("");
}

void carry_out(Study& study) {
  const Trajectory linear = run(study, "linear", "G2.20", 4000), binomial = run(study, "binomial", "G2.24", 4000);
  const double a = length_between_touches(linear), b = length_between_touches(binomial);
  study.claim(
      {"shorter", "between two touches of the outer circle the orbit of figure 2.24 is shorter than that of 2.20",
       "shorter", "65"},
      at_most(1, "ratio of both lengths"),
      {{b / a, 1e-2, fmt::format("lengths {:.4g} and {:.4g} by Taylor series", b, a)}});
  study.claim(
      {"larger_energy", "the orbit of figure 2.24 has a larger energy than that of 2.20, between the same circles",
       "larger", "65"},
      at_least(1, "ratio of both energies"),
      {{binomial.energy[0] / linear.energy[0], 1e-12,
        fmt::format("E = {:.6g} and {:.6g}", binomial.energy[0], linear.energy[0])}});
  const auto slope = [](const Trajectory& t) { return t.p.back()[1] / t.p.back()[0]; };
  const Trajectory hooke = run(study, "hooke", "G2.17", 4000), kepler = run(study, "kepler", "G2.11", 40000);
  study.claim(
      {"slope_hooke", "the asymptote of the Hooke hyperbola of figure 2.17 has a positive slope", "positive", "56"},
      at_least(0, "slope"), {{slope(hooke), 1e-3, "direction of p at t = 40"}});
  study.claim(
      {"slope_kepler", "the asymptote of the Kepler hyperbola of figure 2.11 has a negative slope", "negative", "56"},
      at_most(0, "slope"), {{slope(kepler), 1e-2, "direction of p at t = 400"}});
}

}  // namespace text_two_bodies

std::vector<Experiment> text_two_bodies_experiments() {
  return {{{"G-C56", gross, "56, 65", "what the text says of figures 2.11, 2.17, 2.20 and 2.24"},
           text_two_bodies::carry_out}};
}

}  // namespace hamflow::reproduction
