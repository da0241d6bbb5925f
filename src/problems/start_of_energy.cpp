// The component of a start that the energy determines, in every number type of a run.
#include "start_of_energy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "hamflow/arithmetic/double_double.hpp"
#include "hamflow/arithmetic/mp.hpp"
#include "hamflow/arithmetic/quad.hpp"
#include "hamflow/core/math.hpp"
#include "numerics/outer_root.hpp"
#include "walls/soft_energy.hpp"

namespace hamflow {

namespace {

template <class R>
bool is_number(const R& x) {
  return x - x == R(0);
}

/// Whether H(x) = c + b x + a x^2 to rounding, at 16 points for each power of 2 from 2^-20 to 2^20, of both signs.
/// Other terms of a smooth H would show in the last digits at many of these points.
template <class R>
bool is_parabola(const EnergyLine<R>& line, const R& c, const R& b, const R& a) {
  const R tolerance = R(10000) * std::numeric_limits<R>::epsilon();
  for (int i = -20 * 16; i <= 20 * 16; ++i) {
    const R magnitude(exp2(static_cast<double>(i) / 16));
    for (const R& x : {magnitude, R(-magnitude)}) {
      const R linear = b * x;
      const R square = a * x * x;
      const R off = abs(line.energy(x) - c - linear - square);
      if (!(off <= tolerance * (abs(c) + abs(linear) + abs(square)))) return false;
    }
  }
  return true;
}

/// "p[0]".
std::string name_of_open(const StartSpec& spec) {
  const std::vector<std::string>& given = spec.v.empty() ? spec.p : spec.v;
  const auto at = std::find_if(given.begin(), given.end(), is_left_to_energy);
  return std::string(spec.v.empty() ? "p" : "v") + "[" + std::to_string(at - given.begin()) + "]";
}

}  // namespace

template <class R>
R component_for_energy(const EnergyLine<R>& without_walls, const Request& request) {
  const StartSpec& spec = request.start;
  EnergyLine<R> line = without_walls;
  if (const auto walls = request.walls) {
    const R of_walls = soft_energy<R>(*walls, line.q);
    // A start beyond a wall has no energy; it is refused elsewhere, with the name of the wall.
    if (is_number(of_walls))
      line.energy = [&without_walls, of_walls](const R& x) { return R(without_walls.energy(x) + of_walls); };
  }
  const std::vector<std::string>& given = spec.v.empty() ? spec.p : spec.v;
  const bool largest = std::find(given.begin(), given.end(), largest_root) != given.end();
  const R level = evaluate_number<R>(spec.energy);

  // H = H(0) + b x + a x^2, if that holds.
  const R a = line.curvature(R(0)) / R(2);
  const R b = line.slope(R(0));
  const R at_base = line.energy(R(0));
  const R epsilon = std::numeric_limits<R>::epsilon();
  const R noise = R(8) * epsilon * (abs(at_base) + abs(level));
  const auto root = quadratic_root<R>(a, b, at_base - level, noise, largest);
  bool quadratic = is_number(a) && is_number(b) && is_number(at_base) && abs(a) > R(0);
  if (!line.is_parabola) {
    const R reach = R(1) + (root ? R(2) * abs(*root) : R(0));
    for (const R& x : {reach, R(-reach)}) {
      if (!quadratic) break;
      const R there = line.curvature(x) / R(2);
      quadratic = abs(there - a) <= R(1000) * epsilon * abs(a);
    }
    quadratic = quadratic && is_parabola<R>(line, at_base, b, a);
  }
  const std::string open = name_of_open(spec);
  if (quadratic) {
    if (root) return *root;
    const R extreme = at_base - b * b / (R(4) * a);
    throw NoStart("no " + open + " has this energy: along " + open + " H is at " + (a > R(0) ? "least " : "most ") +
                  shortest(static_cast<double>(extreme)));
  }
  // H(x) equals the energy up to the rounding of x and of the terms of H, which are as large as H between 0 and x. The
  // rounding of a large x may account for at most 10^6 roundings of H.
  const auto has_energy = [&](const R& x) {
    const R found = line.energy(x);
    R size = abs(found) + abs(level);
    for (const R& part : {R(0), R(0.25), R(0.5), R(0.75)}) {
      const R there = abs(line.energy(part * x));
      if (is_number(there) && there > size) size = there;
    }
    const R slack = R(64) * epsilon * size + R(4) * epsilon * abs(x * line.slope(x));
    const R most = R(1e6) * epsilon * size;
    return abs(found - level) <= (slack < most ? slack : most);
  };
  const auto above = [&](double x) { return static_cast<double>(line.energy(R(x)) - level); };
  const auto refined = [&](double x) { return refined_root<R>([&](const R& y) { return line.energy(y) - level; }, x); };
  const OuterRoot outer = outer_root(above, largest, [&](double x) { return has_energy(refined(x)); });
  if (!outer.is_decided) {
    throw NoStart(std::string("no ") + (largest ? "largest" : "smallest") + " root along " + open +
                  " was found: H oscillates, or equals the energy, in the whole range that was searched; give " + open +
                  " as a number");
  }
  if (outer.x) {
    const R x = refined(*outer.x);
    if (has_energy(x)) return x;
  }
  throw NoStart("no " + open + " with this energy was found: H - energy has no zero for |" + open +
                "| up to 2^100, except perhaps between two points of the search");
}

template double component_for_energy(const EnergyLine<double>&, const Request&);
template DoubleDouble component_for_energy(const EnergyLine<DoubleDouble>&, const Request&);
template Quad component_for_energy(const EnergyLine<Quad>&, const Request&);
template Mp component_for_energy(const EnergyLine<Mp>&, const Request&);

}  // namespace hamflow
