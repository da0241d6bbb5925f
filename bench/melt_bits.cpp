// Checks that the melt of 32 768 particles has the same bits for any number of threads, instruction set and skin, and
// however often lists are made (target melt_bits). It prints the hash for each setting, and its exit status is 1 if two
// differ. The argument is the number of steps, default 10000, which take some minutes for each setting.
#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "hamflow/core/bulk_forces.hpp"
#include "hamflow/core/counter_random.hpp"

namespace {

using hamflow::BulkForces;
using hamflow::BulkKernel;
using hamflow::BulkPairSystem;
using hamflow::BulkSet;

constexpr std::size_t per_side = 32;
constexpr double spacing = 1.0579850391;  // density 0.8442

/// The system of examples/melt.toml, in the length unit of the potential.
BulkPairSystem melt() {
  BulkPairSystem s;
  s.space = 3;
  s.particles = per_side * per_side * per_side;
  s.factor = 4;
  s.attraction = 1;
  s.cutoff = BulkPairSystem::Cutoff::shifted;
  s.radius = 2.5;
  s.edges = {per_side * spacing, per_side * spacing, per_side * spacing};
  return s;
}

struct Settings {
  BulkSet set = BulkSet::best;
  std::size_t threads = 1;
  double skin = 0.3;
  bool rebuilt = false;
};

const char* name_of(BulkSet set) {
  return set == BulkSet::sse2 ? "sse2" : set == BulkSet::avx2 ? "avx2" : set == BulkSet::avx512 ? "avx512" : "best";
}

/// Integrates with Verlet, step size 0.005.   @return a hash of positions, momenta and potential energy
std::uint64_t hash_of(const Settings& settings, int steps) {
  BulkPairSystem system = melt();
  system.skin = settings.skin;
  system.rebuild_every_time = settings.rebuilt;
  std::vector<double> q, p, f(3 * system.particles);
  for (std::size_t i = 0; i < system.particles; ++i) {
    for (const std::size_t at : {i % per_side, i / per_side % per_side, i / per_side / per_side}) {
      q.push_back((static_cast<double>(at) - 0.5 * (per_side - 1)) * spacing);
      p.push_back(std::sqrt(3 * 1.44) * hamflow::counter_uniform(1, p.size()));
    }
  }
  const BulkForces forces(system, BulkKernel::exact, settings.set);
  forces.use_threads(settings.threads);
  const auto begin = std::chrono::steady_clock::now();
  forces.force(q.data(), f.data());
  double potential = 0;
  constexpr double h = 0.005;
  for (int n = 0; n < steps; ++n) {
    for (std::size_t i = 0; i < q.size(); ++i) q[i] += h * (p[i] += h / 2 * f[i]);
    potential = forces.force_and_potential(q.data(), f.data());
    for (std::size_t i = 0; i < q.size(); ++i) p[i] += h / 2 * f[i];
  }
  std::uint64_t hash = std::bit_cast<std::uint64_t>(potential);
  for (const auto* x : {&q, &p}) {
    for (const double y : *x) hash = hash * 0x9e3779b97f4a7c15u + std::bit_cast<std::uint64_t>(y);
  }
  std::printf("%-7s %zu threads, skin %.1f%s: %016llx, V = %.15g, %llu lists, %.0f s\n", name_of(settings.set),
              settings.threads, settings.skin, settings.rebuilt ? ", lists at every step" : "",
              static_cast<unsigned long long>(hash), potential, static_cast<unsigned long long>(forces.counts().lists),
              std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  std::fflush(stdout);
  return hash;
}

}  // namespace

int main(int count, char** arguments) {
  const int steps = count > 1 ? std::atoi(arguments[1]) : 10000;
  std::vector<Settings> all{{}, {.threads = 2}, {.threads = 4}, {.skin = 0.1}, {.skin = 1}, {.rebuilt = true}};
  for (const BulkSet set : {BulkSet::sse2, BulkSet::avx2, BulkSet::avx512}) {
    if (BulkForces::has(set)) all.push_back({.set = set});
  }
  std::vector<std::uint64_t> hashes;
  for (const Settings& settings : all) hashes.push_back(hash_of(settings, steps));
  const bool same = std::all_of(hashes.begin(), hashes.end(), [&](std::uint64_t hash) { return hash == hashes[0]; });
  std::printf("%d steps, %zu settings: %s\n", steps, all.size(), same ? "one hash" : "hashes DIFFER");
  return same ? 0 : 1;
}
