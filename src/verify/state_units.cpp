#include "hamflow/detail/verify/state_units.hpp"

#include <algorithm>
#include <cmath>

#include "hamflow/formula/problem_texts.hpp"
#include "hamflow/run/state_names.hpp"

namespace hamflow {

namespace {

// relative to the largest group; anything smaller is rounding errors of the other groups
constexpr double of_the_largest = 0x1p-40;

/// Returns "x" for "x[12]".
std::string family(const std::string& name) { return name.substr(0, name.find('[')); }

std::size_t place_of(std::vector<std::string>& names, const std::string& name) {
  const auto at = std::find(names.begin(), names.end(), name);
  const auto place = static_cast<std::size_t>(at - names.begin());
  if (at == names.end()) names.push_back(name);
  return place;
}

void include_in(std::vector<double>& most, const std::vector<double>& x) {
  most.resize(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) most[i] = std::max(most[i], std::abs(x[i]));
}

}  // namespace

UnitGroups unit_groups(const ProblemEntry& problem, std::size_t size) {
  const ProblemInfo& info = problem.info;
  UnitGroups groups;
  // problems of any size, such as bodies, particles or links, have one group
  if (info.coordinates.size() != size) return groups;
  if (has_typed_hamiltonian(problem)) {
    groups.q.clear();
    groups.p.clear();
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t place = place_of(groups.q, family(info.coordinates[i]));
      groups.of.push_back(place);
      const std::string momentum = i < problem.momenta.size() ? problem.momenta[i] : momentum_name(info.coordinates[i]);
      if (place == groups.p.size()) groups.p.push_back(family(momentum));
    }
    return groups;
  }
  const auto is_angle = [&](const std::string& name) {
    return std::find(info.angles.begin(), info.angles.end(), name) != info.angles.end();
  };
  const auto angles = std::count_if(info.coordinates.begin(), info.coordinates.end(), is_angle);
  if (angles == 0 || angles == static_cast<std::ptrdiff_t>(size)) return groups;
  groups.q = {"lengths", "angles"};
  groups.p = {"their momenta", "momenta of angles"};
  for (const std::string& name : info.coordinates) groups.of.push_back(is_angle(name) ? 1 : 0);
  for (std::size_t g = 0; g < 2; ++g) {
    if (std::count(groups.of.begin(), groups.of.end(), g) != 1) continue;
    const auto i = static_cast<std::size_t>(std::find(groups.of.begin(), groups.of.end(), g) - groups.of.begin());
    groups.q[g] = info.coordinates[i];
    groups.p[g] = i < problem.momenta.size() ? problem.momenta[i] : momentum_name(info.coordinates[i]);
  }
  return groups;
}

void StateSizes::include(const std::vector<double>& at_q, const std::vector<double>& at_p) {
  include_in(q, at_q);
  include_in(p, at_p);
}

GroupSizes group_sizes(const UnitGroups& groups, const StateSizes& sizes) {
  const std::size_t n = groups.count();
  GroupSizes found{std::vector<double>(2 * n), std::vector<bool>(2 * n)};
  for (const bool momenta : {false, true}) {
    const std::vector<double>& own = momenta ? sizes.p : sizes.q;
    const std::size_t first = momenta ? n : 0;
    double largest = 0;
    for (std::size_t i = 0; i < own.size(); ++i) {
      double& size = found.size[first + groups.group(i)];
      size = std::max(size, own[i]);
      largest = std::max(largest, own[i]);
    }
    for (std::size_t g = first; g < first + n; ++g) {
      found.is_rounding[g] = found.size[g] < of_the_largest * largest;
      if (found.is_rounding[g]) found.size[g] = of_the_largest * largest;
    }
  }
  return found;
}

std::vector<GroupDistance> group_distances(const UnitGroups& groups, const StateSizes& sizes, const Frame& a,
                                           const Frame& b) {
  const std::size_t n = groups.count();
  const std::vector<double> size = group_sizes(groups, sizes).size;
  std::vector<GroupDistance> all(2 * n);
  for (const bool momenta : {false, true}) {
    const std::vector<double>& x = momenta ? a.p : a.q;
    const std::vector<double>& y = momenta ? b.p : b.q;
    const std::vector<std::string>& x_digits = momenta ? a.digits.p : a.digits.q;
    const std::vector<std::string>& y_digits = momenta ? b.digits.p : b.digits.q;
    const std::size_t first = momenta ? n : 0;
    std::vector<std::vector<std::string>> of_a(n), of_b(n);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const std::size_t g = groups.group(i);
      double& most = all[first + g].distance.value;
      most = std::max(most, std::abs(x[i] - y[i]));
      if (x_digits.empty()) continue;
      of_a[g].push_back(x_digits[i]);
      of_b[g].push_back(y_digits[i]);
    }
    for (std::size_t g = 0; g < n; ++g) {
      GroupDistance& here = all[first + g];
      here.name = momenta ? groups.p[g] : groups.q[g];
      here.size = size[first + g];
      if (!x_digits.empty()) here.distance = largest_difference(of_a[g], of_b[g]);
      here.relative = here.size > 0 ? quotient(here.distance, here.size) : here.distance;
    }
  }
  return all;
}

}  // namespace hamflow
