// Sets the grid spacing of the lattice: the one that the scenario gives, or one that suits the start.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "gas/container.hpp"
#include "run_keys.hpp"
#include "scenario_reader.hpp"

namespace hamflow {

/// Chooses the default grid spacing: 2^-52 of the largest number of the start, so that numbers may grow to 1024 times
/// this number. If the largest number is between 1/512 and 2, the spacing is 2^-52, because a start near rest says
/// little about the motion. For bodies that attract each other, the expected momenta are those with a kinetic energy as
/// large as the current potential energy. The kick of a pair may be at most 2^62 units divided by the number of pairs
/// (PairSums). For a gas of more than a thousand particles that is less than the largest momentum, which one encounter
/// can reverse. Therefore the spacing is increased until a kick may be four times the largest momentum.
void ScenarioReader::usual_units() {
  const auto largest = [](const std::vector<double>& values) {
    double most = 0;
    for (const double x : values) most = std::max(most, std::abs(x));
    return most;
  };
  const auto unit_for = [](double most, int coarsest) {
    const int exponent = most > 0 && std::isfinite(most) ? std::clamp(std::ilogb(most), -900, 900) : 0;
    return std::ldexp(1.0, -52 + (exponent < coarsest || exponent > 0 ? exponent : 0));
  };
  Request& request = scenario_.request;
  // Particles of a gas repel each other before they come close.
  const bool gas = scenario_.problem != nullptr && scenario_.problem->particles;
  const bool pairwise =
      !gas && scenario_.problem != nullptr && scenario_.problem->has_pairwise_forces && !scenario_.start_q.empty();
  // Positions behind a mirror, as far from it as those in front of it, have to be exact in double, too.
  std::vector<double> positions = scenario_.start_q;
  const auto& walls = request.walls;
  if (walls && (pairwise ? walls->rule == WallRule::mirror : walls->hard())) {
    for (const Walls::Interval& wall : walls->intervals) {
      for (const std::string& text : {wall.min, wall.max})
        positions.push_back(text.empty() ? 0 : 4 * number_value(text));
    }
  }
  if (!pairwise) {
    request.position_unit = unit_for(largest(positions), -9);
    request.momentum_unit = unit_for(largest(scenario_.start_p), -9);
    if (!gas) return;
    const std::size_t space = scenario_.problem->particles(request.parameters).space;
    const auto bits = static_cast<int>(std::bit_width(scenario_.start_q.size() / space));
    if (bits > 10) request.momentum_unit = std::ldexp(request.momentum_unit, bits - 8);
    return;
  }
  // The expected momenta are those of the start (or equal ones, if they are 0), scaled so that T = |V|.
  const double most = largest(scenario_.start_p);
  const auto energy_with = [&](double factor) {
    std::vector<double> p = scenario_.start_p;
    for (double& x : p) x = factor * (most > 0 ? x / most : 1.0);
    return scenario_.problem->energy(request.parameters, scenario_.start_q, p);
  };
  const double potential = energy_with(0);
  double factor = 1;
  while (energy_with(factor) - potential < 0x1p-20 * std::abs(potential) && factor < 0x1p400) factor *= 0x1p30;
  const double to_come = factor * std::sqrt(std::abs(potential) / (energy_with(factor) - potential));
  request.position_unit = unit_for(largest(positions), 0);
  request.momentum_unit = unit_for(std::isfinite(to_come) ? std::max(most, to_come) : most, 0);
}

void ScenarioReader::read_lattice(TomlTable& table) {
  const bool on_lattice = scenario_.request.arithmetic == "lattice";
  const std::string& key = run_keys().lattice.name;
  if (table.has(key)) {
    TomlTable lattice = table.table(key);
    const auto read_unit = [&](const OptionInfo& unit, double& out) {
      const auto value = lattice.number(unit);
      if (!value) return;
      int exponent = 0;
      if (std::frexp(*value, &exponent) != 0.5 || std::abs(exponent) > 1000) {
        lattice.complain(
            unit.name, lattice.found(unit.name) + "; allowed a power of two from 2^-1000 to 2^999, such as \"2^-52\"");
        return;
      }
      out = *value;
    };
    read_unit(lattice_keys().position, scenario_.request.position_unit);
    read_unit(lattice_keys().momentum, scenario_.request.momentum_unit);
    lattice.finish();
    if (!on_lattice) {
      table.complain(key, "found grid spacings with arithmetic \"" + scenario_.request.arithmetic +
                              "\"; allowed with arithmetic = \"lattice\"");
    }
  } else {
    table.know(key);
    if (on_lattice) usual_units();
  }
  if (!on_lattice) return;
  if (scenario_.problem != nullptr && scenario_.problem->container == ContainerNames::periodic) round_edges(table);
  const auto rounding = [](const std::vector<double>& values, double unit) {
    double most = 0;
    for (const double x : values) most = std::max(most, std::abs(std::remainder(x, unit)));
    return most;
  };
  const auto reach = [](const std::vector<double>& values) {
    double most = 0;
    for (const double x : values) most = std::max(most, std::abs(x));
    return most;
  };
  // Positions and momenta have different units, so each gets its own note.
  const auto tell = [&](const char* what, const std::vector<double>& values, double unit) {
    const double lost = rounding(values, unit);
    if (!(lost > 1e-12 * reach(values))) return;
    scenario_.notes.push_back(std::string("the ") + what + " of the start are rounded to the lattice by up to " +
                              shortest(lost));
  };
  tell("positions", scenario_.start_q, scenario_.request.position_unit);
  tell("momenta", scenario_.start_p, scenario_.request.momentum_unit);
  const auto check = [&](const char* what, double largest, double unit) {
    if (largest > 0 && largest < unit) {
      table.complain(key, std::string("found ") + what + " of at most " + shortest(largest) +
                              " at the start, but the grid spacing " + shortest(unit) +
                              "; allowed a much smaller spacing");
      return;
    }
    if (largest < unit * 0x1p62) return;
    table.complain(key, std::string("found ") + what + " up to " + shortest(largest) +
                            " at the start, but the grid spacing " + shortest(unit) +
                            "; allowed less than 2^62 grid spacings; choose a larger power of two");
  };
  check("positions", reach(scenario_.start_q), scenario_.request.position_unit);
  check("momenta", reach(scenario_.start_p), scenario_.request.momentum_unit);
}

}  // namespace hamflow
