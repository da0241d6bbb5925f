#include "energy_size.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace hamflow {

VirialTerms virial(const ProblemEntry& problem, const Texts& parameters, const std::vector<double>& q,
                   const std::vector<double>& p) {
  constexpr double part = 0x1p-20;
  const auto slope = [&](double of_q, double of_p) {
    const auto energy = [&](double sign) {
      std::vector<double> moved_q = q;
      std::vector<double> moved_p = p;
      for (double& x : moved_q) x *= 1 + sign * of_q;
      for (double& x : moved_p) x *= 1 + sign * of_p;
      return problem.energy(parameters, moved_q, moved_p);
    };
    return std::abs(energy(1) - energy(-1)) / (2 * part);
  };
  return {slope(part, 0), slope(0, part)};
}

RunEnds ends_of(const Request& request, const Simulation& simulation) {
  constexpr std::size_t most_coordinates = 200;
  RunEnds ends;
  simulation.look(ends.end);
  if (ends.end.q.size() > most_coordinates) return {};
  Request plain = request;
  plain.watch = plain.record = false;
  plain.threads = 1;
  make_simulation(plain)->look(ends.start);
  return ends;
}

/// A sixteenth of the virial at the start is used, because for a high power V of r, r dV/dr is many times V. The end is
/// not used: compared with the energy to which a run has blown up, all earlier errors would look like rounding.
double size_of_energy(const Request& request, const ProblemEntry& problem, const RunEnds& ends, double scale) {
  if (ends.start.q.empty()) return scale;
  const Texts all = complete(problem.info, request.parameters);
  const VirialTerms start = virial(problem, all, ends.start.q, ends.start.p);
  const double size = (start.of_q + start.of_p) / virial_per_size;
  return size > scale && std::isfinite(size) ? size : scale;
}

namespace {
/// Returns |dH/dq_i| from a difference of H.
/// @param v dH/dp
double slope(const ProblemEntry& problem, const Texts& all, const std::vector<double>& q, const std::vector<double>& p,
             const std::vector<double>& v, std::size_t i, double dt) {
  double fastest = 0;
  for (const double x : v) fastest = std::max(fastest, std::abs(x));
  const double in_a_step = std::abs(dt) * (v[i] != 0 ? std::abs(v[i]) : fastest);
  const double moved = in_a_step > 0 ? 0x1p-6 * in_a_step : 0x1p-26 * std::abs(q[i]);  // all momenta are 0
  std::vector<double> above = q;
  std::vector<double> below = q;
  above[i] += moved;
  below[i] -= moved;
  const double apart = above[i] - below[i];
  return apart > 0 ? std::abs(problem.energy(all, above, p) - problem.energy(all, below, p)) / apart : 0;
}
}  // namespace

double rounding_of_state(const Request& request, const ProblemEntry& problem, const RunEnds& ends, double dt) {
  if (ends.start.q.empty()) return 0;
  const Texts all = complete(problem.info, request.parameters);
  const std::vector<double>& q = ends.start.q;  // not the end, because the run may have blown up
  const std::vector<double>& p = ends.start.p;
  const std::vector<double> v = problem.gradient(all, q, p).by_p;
  double sum = 0;
  for (std::size_t i = 0; i < q.size(); ++i) {
    sum += std::abs(p[i] * v[i]) + std::abs(q[i]) * slope(problem, all, q, p, v, i, dt);
  }
  return std::isfinite(sum) ? sum / 4 : 0;
}

double rounding_of_growing(const Request& request, const ProblemEntry& problem, const RunEnds& ends,
                           const std::vector<std::size_t>& growing, double dt) {
  if (ends.start.q.empty()) return 0;
  const Texts all = complete(problem.info, request.parameters);
  const std::vector<double>& p = ends.end.p;
  // The force at the end may be 0 by chance, or that of a close encounter. Therefore the median over states between
  // start and end is used.
  constexpr double on_the_way[] = {0.19, 0.43, 0.62, 0.81, 1.0};
  std::vector<std::vector<double>> slopes(growing.size());
  for (const double part : on_the_way) {
    std::vector<double> q = ends.end.q;
    for (const std::size_t i : growing) q[i] = ends.start.q[i] + part * (ends.end.q[i] - ends.start.q[i]);
    const std::vector<double> v = problem.gradient(all, q, p).by_p;
    for (std::size_t k = 0; k < growing.size(); ++k) {
      slopes[k].push_back(slope(problem, all, q, p, v, growing[k], dt));
    }
  }
  double sum = 0;
  for (std::size_t k = 0; k < growing.size(); ++k) {
    const auto middle = slopes[k].begin() + std::size(on_the_way) / 2;
    if (!std::all_of(slopes[k].begin(), slopes[k].end(), [](double x) { return std::isfinite(x); })) continue;
    std::nth_element(slopes[k].begin(), middle, slopes[k].end());
    const double grown = std::abs(ends.end.q[growing[k]]) - std::abs(ends.start.q[growing[k]]);
    sum += std::max(grown, 0.0) * *middle;
  }
  return std::isfinite(sum) ? sum / 4 : 0;
}

double energy_of_units(const Request& request, const ProblemEntry& problem, const RunEnds& ends) {
  if (request.arithmetic != "lattice" || ends.start.q.empty()) return 0;
  const Texts all = complete(problem.info, request.parameters);
  const auto per = [](double of_all, const std::vector<double>& xs) {
    double most = 0;
    for (const double x : xs) most = std::max(most, std::abs(x));
    return most > 0 ? of_all / most : 0;
  };
  double moved = 0;
  for (const Frame* frame : {&ends.start, &ends.end}) {
    const VirialTerms v = virial(problem, all, frame->q, frame->p);
    const double here = per(v.of_q, frame->q) * request.position_unit + per(v.of_p, frame->p) * request.momentum_unit;
    if (here > moved && std::isfinite(here)) moved = here;
  }
  return moved;
}

}  // namespace hamflow
