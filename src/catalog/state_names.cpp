#include "hamflow/run/state_names.hpp"

#include "hamflow/run/gas.hpp"
#include "hamflow/run/socket.hpp"

namespace hamflow {

namespace {

/// The dimension of the space in which bodies move; 0 if the coordinates are not those of bodies. It is the number of
/// components of the total momentum, taken from the problem without walls, since walls remove that invariant. A gas,
/// whose container may remove it, has a parameter for the dimension.
std::size_t space_of_bodies(const ProblemEntry& problem, const Texts& parameters, std::size_t size) {
  if (problem.info.name == GasKeys::problem) return number_value(parameters.at(GasKeys::dimension)) == 3 ? 3 : 2;
  if (problem.info.name == SocketKeys::problem) return 3;
  const auto bare_entry = find_problem(problem.info.name, {});
  const ProblemEntry& bare = *bare_entry;
  const std::vector<InvariantInfo>& invariants = bare.info.invariants;
  for (std::size_t i = 0; i < invariants.size(); ++i) {
    if (invariants[i].components == Components::space) return bare.invariant_sizes(parameters, size).at(i);
  }
  return 0;
}

}  // namespace

std::string momentum_name(const std::string& coordinate) {
  return coordinate.starts_with('q') ? "p" + coordinate.substr(1) : "p_" + coordinate;
}

StateNames numbered_names(std::size_t size) {
  StateNames names;
  for (std::size_t i = 1; i <= size; ++i) {
    names.q.push_back("q" + std::to_string(i));
    names.p.push_back("p" + std::to_string(i));
  }
  return names;
}

StateNames state_names(const ProblemEntry& problem, const Texts& parameters, std::size_t size) {
  StateNames names;
  const std::size_t space = problem.dimension > 0 ? 0 : space_of_bodies(problem, parameters, size);
  if (problem.dimension == 0 && space == 0) return numbered_names(size);
  if (space == 0) names.q = problem.info.coordinates;
  for (std::size_t i = 0; space > 0 && i < size; ++i) {
    names.q.push_back(std::string(1, "xyz"[i % space]) + std::to_string(i / space + 1));
  }
  names.p = problem.momenta;
  if (!names.p.empty()) return names;
  for (const std::string& name : names.q) names.p.push_back(momentum_name(name));
  return names;
}

}  // namespace hamflow
