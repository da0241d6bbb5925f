// [Gross1999, tables 2.1 to 2.4]: which orbits the central potentials have. Random orbits, k <= 0 and l near 0
// included, are integrated and classified by their points; a row falls with one counter-example.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../central_orbits.hpp"
#include "../experiment.hpp"
#include "../trajectories.hpp"
#include "hamflow/numerics/quadrature.hpp"

namespace hamflow::reproduction {

namespace orbit_tables {

enum class Expected { ellipse, circle, parabola, hyperbola, line, bounded };
enum class Finding { agrees, counter_example, unclear };

/// Numbers of one draw, in their order.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : seed_(seed) {}
  double between(double a, double b) { return a + (b - a) * drawn(seed_, next_++); }
  double power(double a, double b) { return std::pow(10, between(a, b)); }
  double sign() { return drawn(seed_, next_++) < 0.5 ? -1 : 1; }

 private:
  std::uint64_t seed_;
  std::uint64_t next_ = 0;
};

struct Row {
  const char* name;
  const char* statement;
  const char* printed;
  Expected expected;
  std::function<OrbitCase(Dice&)> draw;
};
struct Table {
  const char* id;
  const char* page;
  const char* title;
  std::vector<Row> rows;
};

/// On the x-axis, inwards; l from 0.001 to 4, either sign.
OrbitCase inwards(Dice& dice, Field field, double k) {
  OrbitCase orbit{.field = field, .mass = dice.power(-0.5, 0.5), .k = k};
  const double r = dice.power(-0.5, 0.5);
  orbit.q = {r, 0};
  orbit.p = {-dice.between(0.01, 2), dice.sign() * dice.power(-3, 0.6) / r};
  if (field == Field::binomial) orbit.lambda = dice.between(-2, 2);
  return orbit;
}
/// With the energy that is asked for: the radial momentum follows; outwards of the pericentre.
OrbitCase of_energy(OrbitCase orbit, double energy) {
  const double r = orbit.q[0];
  const double square = 2 * orbit.mass * (energy - orbit.V(r)) - orbit.p[1] * orbit.p[1];
  orbit.p[0] = -std::sqrt(square);
  return orbit;
}
/// A circle: V'(r) = l^2/(mu r^3).
OrbitCase circling(OrbitCase orbit, double slope) {
  const double r = orbit.q[0];
  orbit.p = {0, std::copysign(std::sqrt(orbit.mass * r * slope), orbit.p[1])};
  return orbit;
}
template <class Draw, class Accept>
OrbitCase until(const Draw& draw, const Accept& accept) {
  for (int i = 0; i < 1000; ++i) {
    const OrbitCase orbit = draw();
    if (accept(orbit)) return orbit;
  }
  return draw();
}
OrbitCase kepler_of(Dice& dice, int sign_of_energy) {
  return until([&] { return inwards(dice, Field::kepler, dice.power(-0.5, 0.5)); },
               [&](const OrbitCase& o) { return o.energy() * sign_of_energy > 1e-3; });
}
OrbitCase parabola(Dice& dice) {
  return of_energy(until([&] { return inwards(dice, Field::kepler, dice.power(-0.5, 0.5)); },
                         [](const OrbitCase& o) { return o.effective(o.q[0]) < 0; }),
                   0);
}

const std::vector<Table>& tables() {
  static const std::vector<Table> all{
      {"T2.1",
       "39",
       "orbits of the Kepler potential",
       {{"hyperbola", "for E > 0 orbits are hyperbolas", "Hyperbel", Expected::hyperbola,
         [](Dice& dice) { return kepler_of(dice, 1); }},
        {"parabola", "for E = 0 orbits are parabolas", "Parabel", Expected::parabola, parabola},
        {"ellipse", "for E0 < E < 0 orbits are ellipses", "Ellipse", Expected::ellipse,
         [](Dice& dice) { return kepler_of(dice, -1); }},
        {"circle", "for E = E0 orbits are circles", "Kreis", Expected::circle,
         [](Dice& dice) {
           const OrbitCase o = inwards(dice, Field::kepler, dice.power(-0.5, 0.5));
           return circling(o, o.k / (o.q[0] * o.q[0]));
         }}}},
      {"T2.2",
       "49",
       "orbits of the Hooke potential",
       {{"hyperbola", "for k > 0 orbits are hyperbolas", "Hyperbel", Expected::hyperbola,
         [](Dice& dice) { return inwards(dice, Field::hooke, dice.power(-1, 0.3)); }},
        {"line", "for k = 0 orbits are straight lines", "Gerade", Expected::line,
         [](Dice& dice) { return inwards(dice, Field::hooke, 0); }},
        {"ellipse", "for k0 < k < 0 orbits are ellipses", "Ellipse", Expected::ellipse,
         [](Dice& dice) { return inwards(dice, Field::hooke, -dice.power(-1, 0.3)); }},
        {"circle", "for k = k0 orbits are circles", "Kreis", Expected::circle,
         [](Dice& dice) {
           const OrbitCase o = inwards(dice, Field::hooke, -dice.power(-1, 0.3));
           return circling(o, -o.k * o.q[0]);
         }}}},
      {"T2.3",
       "61",
       "orbits of the linear potential",
       {{"hyperbola", "for k < 0 orbits are hyperbolas", "Hyperbel", Expected::hyperbola,
         [](Dice& dice) { return inwards(dice, Field::linear, -dice.power(-1, 0.3)); }},
        {"line", "for k = 0 orbits are straight lines", "Gerade", Expected::line,
         [](Dice& dice) { return inwards(dice, Field::linear, 0); }},
        {"bounded", "for k > 0 and E > E0 orbits are bounded", "begrenzte Bahn", Expected::bounded,
         [](Dice& dice) { return inwards(dice, Field::linear, dice.power(-1, 0.3)); }},
        {"circle", "for k > 0 and E = E0 orbits are circles", "Kreis", Expected::circle,
         [](Dice& dice) {
           const OrbitCase o = inwards(dice, Field::linear, dice.power(-1, 0.3));
           return circling(o, o.k);
         }}}},
      {"T2.4",
       "63",
       "orbits of the binomial potential",
       {{"hyperbola", "for k < 0 orbits are hyperbolas", "Hyperbel", Expected::hyperbola,
         [](Dice& dice) { return inwards(dice, Field::binomial, -dice.power(-1, 0.3)); }},
        {"line", "for k = 0 orbits are straight lines", "Gerade", Expected::line,
         [](Dice& dice) { return inwards(dice, Field::binomial, 0); }},
        {"bounded", "for k > 0 and E > E0 orbits are bounded", "begrenzte Bahn", Expected::bounded,
         [](Dice& dice) { return inwards(dice, Field::binomial, dice.power(-1, 0.3)); }},
        {"circle", "for k > 0 and E = E0 orbits are circles", "Kreis", Expected::circle, [](Dice& dice) {
           const auto slope = [](const OrbitCase& o) { return 2 * o.k * o.q[0] * (o.q[0] * o.q[0] - o.lambda); };
           const OrbitCase o = until([&] { return inwards(dice, Field::binomial, dice.power(-1, 0.3)); },
                                     [&](const OrbitCase& any) { return slope(any) > 0.01; });
           return circling(o, slope(o));
         }}}}};
  return all;
}

Finding about_shape(OrbitShape shape, OrbitShape expected) {
  if (shape == OrbitShape::unclear) return Finding::unclear;
  return shape == expected ? Finding::agrees : Finding::counter_example;
}

Finding finding(const OrbitPath& path, Expected expected) {
  const auto small = [](double x, double limit) { return x < limit ? Finding::agrees : Finding::counter_example; };
  if (expected == Expected::circle) {
    double off = 0;
    const double r = std::hypot(path.points[0][0], path.points[0][1]);
    for (const auto& [x, y] : path.points) off = std::max(off, std::abs(std::hypot(x, y) / r - 1));
    return small(off, 1e-8);
  }
  if (expected == Expected::line) {
    const auto& a = path.points.front();
    const auto& b = path.points.back();
    const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
    double off = 0;
    for (const auto& [x, y] : path.points) {
      off = std::max(off, std::abs((x - a[0]) * (b[1] - a[1]) - (y - a[1]) * (b[0] - a[0])) / (length * length));
    }
    return small(off, 1e-10);
  }
  if (path.bounded() == path.escaped) return Finding::unclear;
  const bool has_to_stay = expected == Expected::ellipse || expected == Expected::bounded;
  if (path.bounded() != has_to_stay) return Finding::counter_example;
  if (expected == Expected::bounded) return Finding::agrees;
  const OrbitShape shape = expected == Expected::ellipse    ? OrbitShape::ellipse
                           : expected == Expected::parabola ? OrbitShape::parabola
                                                            : OrbitShape::hyperbola;
  return about_shape(conic_through(path).shape, shape);
}

/// Draws one row, and confirms its first counter-examples by another method in more digits.
void carry_out(Study& study, const Table& table, const Row& row, std::uint64_t seed, int draws) {
  int counter = 0, unclear = 0, staying = 0, tried = 0, confirmed = 0;
  std::string example;
  for (int i = 0; i < draws; ++i) {
    study.breathe();
    Dice dice(seed + 1000003 * static_cast<std::uint64_t>(i));
    const OrbitCase orbit = row.draw(dice);
    const OrbitPath path = orbit_path(orbit);
    const Finding found = finding(path, row.expected);
    if (found == Finding::unclear) ++unclear;
    if (found != Finding::counter_example) continue;
    ++counter;
    if (path.bounded()) ++staying;
    if (tried == 3) continue;
    ++tried;
    if (finding(orbit_path_confirmed(orbit), row.expected) != Finding::counter_example) continue;
    if (confirmed++ == 0) {
      example = fmt::format("{}: {}, misfit of the nearest conic {:.2g}", orbit.told(),
                            path.bounded() ? "bounded" : "escapes", conic_through(path).misfit);
    }
  }
  const bool too_few = 2 * unclear > draws;
  std::vector<Measured> measured{{too_few ? std::nan("") : counter, 0,
                                  fmt::format("counter-examples among {} orbits by dop853, {} of them bounded; {} "
                                              "unclear",
                                              draws, staying, unclear)}};
  if (counter > 0) {
    measured.push_back({static_cast<double>(confirmed), 0,
                        fmt::format("of the first {} confirmed by extrapolation in long double; {}", tried, example)});
  }
  const std::string potential = std::string(table.title).substr(std::string("orbits of ").size());
  study.claim({row.name, std::string(row.statement) + " in " + potential, row.printed}, none_of("counter-examples"),
              measured, Grounds::ways, "random orbits whose class is clear");
}

/// The outward distance of an orbit with k < 0 in the linear potential from the line to which its direction tends.
void claim_asymptote(Study& study) {
  OrbitCase orbit{.field = Field::linear, .mass = 2, .k = -0.1, .q = {2, 0}};
  orbit.p = {0, std::sqrt(0.4)};
  const double l = orbit.angular_momentum(), E = orbit.energy();
  const auto distance = [&](double r) {
    // The angle still to be turned beyond r, with r' = r/s^2.
    const auto rest = integrate(
        [&](long double s) -> long double {
          if (s <= 0) return 0;
          const double at = r / static_cast<double>(s * s);
          return 2 * l / (orbit.mass * at * static_cast<double>(s)) /
                 std::sqrt(2 / orbit.mass * (E - orbit.effective(at)));
        },
        0, 1);
    return r * std::sin(static_cast<double>(rest.value));
  };
  const double near = distance(1e4), far = distance(4e4);
  study.claim({"asymptote", "the orbit of figure 2.21 approaches an asymptote", "an asymptote", "61"},
              within(0.5, 0.05, "the distance falls like r^(-1/2): it is halved at four times the radius"),
              {{far / near, 1e-6,
                fmt::format("distances {:.4g} and {:.4g} at r = 10000, 40000 from the line through the centre to which "
                            "it turns, by quadrature",
                            near, far)}});
}

/// The two orbits with k < 0 of the binomial potential that no hyperbola resembles.
void claim_binomial(Study& study) {
  const OrbitCase inside{.field = Field::binomial, .k = -1, .lambda = 1, .q = {0.3, 0}, .p = {0, 0.05}};
  const auto crossings =
      roots([&](double r) { return inside.effective(r) - inside.energy(); }, geometric_grid(1e-3, 0.99, 2000));
  const OrbitPath path = orbit_path(inside);
  double least = 1, most = 0;
  for (const auto& [x, y] : path.points) {
    least = std::min(least, std::hypot(x, y));
    most = std::max(most, std::hypot(x, y));
  }
  study.claim(
      {"bounded_inside",
       "for k < 0 orbits in the binomial potential are hyperbolas, which turn once; tested with " + inside.told(),
       "Hyperbel"},
      within(1, 0.5, "number of turning points"),
      {{static_cast<double>(crossings.size()), 0, "zeros of E - V_eff within r^2 < lambda"},
       {path.bounded() ? 2.0 : 1.0, 0,
        fmt::format("kinds of turns of the orbit, r from {:.4g} to {:.4g}, dop853", least, most)}},
      Grounds::ways);
  OrbitCase outside = inside;
  outside.q = {1.2, 0};
  outside.p = {0, 0.5};
  const double E = outside.energy();
  // r = r0/s: dt = dr/rdot, with r0 the pericentre; 1/sqrt(1 - s) is integrable.
  const auto time = integrate_from_ends(
      [&](long double s, long double to_one) -> long double {
        const long double r = 1.2L / s;
        if (!(s > 0)) return 0;
        // E - V_eff(r) without cancellation near r0: a difference of polynomials in u = r^2, over (u - u0).
        const long double u = r * r, u0 = 1.44L, l2 = 0.36L;
        const long double gap = 1.44L * to_one * (2 - to_one) / (s * s);
        const long double slope = (u + u0 - 2) / 2 + l2 / (2 * u * u0);
        return 1.2L / (s * s) / std::sqrt(2 * gap * slope);
      },
      1);
  const OrbitPath away = orbit_path(outside);
  const double r_end = std::hypot(away.points.back()[0], away.points.back()[1]);
  // Beyond the last point r' = r^2 to first order: 1/r is left.
  const double by_path = away.t.back() + 1 / r_end;
  study.claim(
      {"finite_time",
       "for k < 0 orbits in the binomial potential are hyperbolas, on which it takes infinite time to reach infinity; "
       "tested with " +
           outside.told(),
       "Hyperbel"},
      at_most(0, "1/time to infinity is 0 on a hyperbola"),
      {{1 / static_cast<double>(time.value), 1e-10,
        fmt::format("infinity is reached at t = {:.8g} by quadrature, E = {:.6g}", static_cast<double>(time.value), E)},
       {1 / by_path, 1e-3, fmt::format("{:.6g} by the orbit up to r = {:.4g}, dop853", by_path, r_end)}},
      Grounds::ways);
}

/// Equation 2.107 has k > 0; repelled orbits are told beside the claims.
void tell_repelled(Study& study, int draws) {
  int hyperbolas = 0;
  for (int i = 0; i < draws; ++i) {
    study.breathe();
    Dice dice(104729 + 1000003 * static_cast<std::uint64_t>(i));
    const OrbitPath path = orbit_path(inwards(dice, Field::kepler, -dice.power(-0.5, 0.5)));
    hyperbolas += finding(path, Expected::hyperbola) == Finding::agrees ? 1 : 0;
  }
  study.note(fmt::format(
      "With k < 0, which equation 2.107 excludes, {} of {} random orbits are hyperbolas as well, by dop853.",
      hyperbolas, draws));
}

void carry_out(Study& study, const Table& table, std::uint64_t number) {
  const int draws = study.sized(40, 600, 6000);
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    carry_out(study, table, table.rows[i], 7919 * (number + 1) + 104729 * i, draws);
  }
  if (table.id == std::string("T2.1")) tell_repelled(study, draws);
  if (table.id == std::string("T2.3")) claim_asymptote(study);
  if (table.id == std::string("T2.4")) claim_binomial(study);
}

}  // namespace orbit_tables

std::vector<Experiment> orbit_tables_experiments() {
  std::vector<Experiment> all;
  const auto& tables = orbit_tables::tables();
  for (std::size_t i = 0; i < tables.size(); ++i) {
    const auto& table = tables[i];
    all.push_back({{table.id, gross, table.page, table.title},
                   [&table, i](Study& study) { orbit_tables::carry_out(study, table, i); }});
  }
  return all;
}

}  // namespace hamflow::reproduction
