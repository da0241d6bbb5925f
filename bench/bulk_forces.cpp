// Compares forces of many particles with hand-written loops and, if it is installed, with LAMMPS. This is a separate
// program (target bulk_bench). It measures processor time in interleaved rounds, and reports medians of ratios within a
// round. The workloads:
//   W3 Lennard-Jones, all pairs, in the plane;   W6 gravity, all pairs, in space;
//   W4 the melt of LAMMPS' bench/in.lj, complete steps with lists;   W10 the melt on threads, and with more particles.
#include "hamflow/core/bulk_forces.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <random>
#include <string>

#include "bulk_loops.hpp"

namespace bench {
namespace {

using hamflow::BulkForces;
using hamflow::BulkKernel;
using hamflow::BulkPairSystem;
using hamflow::BulkSet;

double processor_seconds() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}
double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v[v.size() / 2];
}
double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; }

struct TimedMethod {
  std::string name;
  std::function<void()> run;
  std::vector<double> seconds{};
};
/// @param opponents the number of racers, from the first on, whose times ratios are divided by
/// @param calls the calls of a racer in a round
void race(const char* title, std::vector<TimedMethod> racers, std::size_t opponents, int calls, double units) {
  for (int round = 0; round < 15; ++round) {
    for (std::size_t r = 0; r < racers.size(); ++r) {
      TimedMethod& racer = racers[(r + static_cast<std::size_t>(round)) % racers.size()];
      const double begin = processor_seconds();
      for (int n = 0; n < calls; ++n) racer.run();
      racer.seconds.push_back((processor_seconds() - begin) / calls);
    }
  }
  // The order rotates, but the k-th time of every racer is from the same round.
  std::printf("%s\n", title);
  for (const TimedMethod& racer : racers) {
    std::printf("  %-16s %8.3f ns a pair", racer.name.c_str(), median(racer.seconds) / units * 1e9);
    for (std::size_t o = 0; o < opponents; ++o) {
      std::vector<double> ratio;
      for (std::size_t k = 0; k < racer.seconds.size(); ++k) ratio.push_back(racers[o].seconds[k] / racer.seconds[k]);
      std::printf("   %s/this %5.2f", racers[o].name.c_str(), median(ratio));
    }
    std::printf("\n");
  }
}

template <class Pair, std::size_t Space>
void all_pairs(const char* title, std::size_t per_side, BulkPairSystem::Law law) {
  std::mt19937_64 random(1);
  ParticleArrays swarm{Space, per_side * per_side * (Space == 3 ? per_side : 1), {}, {}};
  std::vector<double> q;
  for (std::size_t i = 0; i < swarm.count; ++i) {
    const std::size_t at[3] = {i % per_side, i / per_side % per_side, i / per_side / per_side};
    for (std::size_t k = 0; k < Space; ++k) {
      q.push_back(static_cast<double>(at[k]) + 0.1 * uniform(random));
      swarm.x[k].push_back(q.back());
    }
  }
  BulkPairSystem s;
  s.space = Space;
  s.particles = swarm.count;
  s.law = law;
  std::vector<double> f(q.size());
  std::vector<TimedMethod> racers{{"plain", [&] { plain_loop<Pair, Space>(swarm); }}};
  if (BulkForces::has(BulkSet::avx2)) racers.push_back({"hand avx2", [&] { loop_avx2<Pair, Space>(swarm); }});
  if (BulkForces::has(BulkSet::avx512)) racers.push_back({"hand avx512", [&] { loop_avx512<Pair, Space>(swarm); }});
  const std::size_t opponents = racers.size();
  for (const BulkSet set : {BulkSet::sse2, BulkSet::avx2, BulkSet::avx512}) {
    if (!BulkForces::has(set)) continue;
    const std::string name = set == BulkSet::sse2 ? "sse2" : set == BulkSet::avx2 ? "avx2" : "avx512";
    racers.push_back({name, [&f, &q, bulk = BulkForces(s, set)] { bulk.force(q.data(), f.data()); }});
  }
  // Check that the loops and the library agree.
  plain_loop<Pair, Space>(swarm);
  BulkForces(s).force(q.data(), f.data());
  for (std::size_t i = 0; i < swarm.count; ++i) {
    for (std::size_t k = 0; k < Space; ++k) {
      if (std::abs(f[Space * i + k] - swarm.f[k][i]) > 1e-10) std::printf("  the loop by hand differs\n"), std::exit(1);
    }
  }
  const auto pairs = static_cast<double>(swarm.count * (swarm.count - 1) / 2);
  race(title, std::move(racers), opponents, static_cast<int>(2e6 / pairs) + 1, pairs);
}

/// The melt of in.lj: density 0.8442, cut-off 2.5, dt 0.005, starting on a lattice. in.lj has a skin of 0.3, which does
/// not change a bit.
struct Melt {
  std::size_t space;
  BulkPairSystem system{};
  std::vector<double> q{}, p{}, f{};
  double potential = 0;

  Melt(std::size_t dimension, std::size_t cells, double skin = 0.3) : space(dimension) {
    const double edge = static_cast<double>(cells) * (space == 3 ? std::cbrt(4 / 0.8442) : std::sqrt(1 / 0.8442));
    const double a = edge / static_cast<double>(cells);
    const double faces[4][3] = {{0, 0, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}, {0.5, 0.5, 0}};
    std::mt19937_64 random(5);
    for (std::size_t z = 0; z < (space == 3 ? cells : 1); ++z) {
      for (std::size_t y = 0; y < cells; ++y) {
        for (std::size_t x = 0; x < cells; ++x) {
          for (int b = 0; b < (space == 3 ? 4 : 1); ++b) {
            const std::size_t at[3] = {x, y, z};
            for (std::size_t k = 0; k < space; ++k)
              q.push_back((static_cast<double>(at[k]) + faces[b][k]) * a - edge / 2);
          }
        }
      }
    }
    // Uniformly distributed momenta with temperature 1.44.
    for (std::size_t i = 0; i < q.size(); ++i) p.push_back(std::sqrt(3 * 1.44) * uniform(random));
    f.resize(q.size());
    system.space = space;
    system.particles = q.size() / space;
    system.factor = 4;
    system.attraction = 1;
    system.cutoff = BulkPairSystem::Cutoff::shifted;
    system.radius = 2.5;
    system.skin = skin;
    for (std::size_t k = 0; k < space; ++k) system.edges[k] = edge;
  }
  void steps(const BulkForces& bulk, int count) {
    const double h = 0.005;
    for (int n = 0; n < count; ++n) {
      for (std::size_t i = 0; i < q.size(); ++i) q[i] += h * (p[i] += h / 2 * f[i]);
      bulk.force(q.data(), f.data());
      for (std::size_t i = 0; i < q.size(); ++i) p[i] += h / 2 * f[i];
    }
  }
};

/// Returns nanoseconds of processor time per atom and step, or 0 if LAMMPS is not installed.
/// @param checked whether LAMMPS makes lists when an atom has moved by half of the skin, as hamflow does. Otherwise it
/// makes them every 20 steps, as in in.lj, and may miss pairs that come within the cut-off in between
double lammps(std::size_t space, std::size_t cells, int steps, bool checked) {
  const std::string input =
      std::string(space == 3 ? "" : "dimension 2\n") + "units lj\natom_style atomic\nlattice " +
      (space == 3 ? "fcc" : "sq") + " 0.8442\nregion box block 0 " + std::to_string(cells) + " 0 " +
      std::to_string(cells) + (space == 3 ? " 0 " + std::to_string(cells) : " -0.5 0.5") +
      "\ncreate_box 1 box\ncreate_atoms 1 box\nmass 1 1.0\nvelocity all create 1.44 87287 loop geom\n"
      "pair_style lj/cut 2.5\npair_modify shift yes\npair_coeff 1 1 1.0 1.0 2.5\nneighbor 0.3 bin\n" +
      (checked ? "neigh_modify delay 0 every 1 check yes" : "neigh_modify delay 0 every 20 check no") +
      "\nfix 1 all nve\n" + (space == 3 ? "" : "fix 2 all enforce2d\n") + "run " + std::to_string(steps) + "\n";
  const std::string command = "printf '" + input + "' | OMP_NUM_THREADS=1 lmp -sf opt -log none 2>/dev/null";
  FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return 0;
  char line[400];
  double loop = 0, percent = 0, atoms = 1;
  while (std::fgets(line, sizeof line, pipe) != nullptr) {
    int done = 0, ranks = 0;
    (void)std::sscanf(line, "Loop time of %lf on %d procs for %d steps with %lf atoms", &loop, &ranks, &done, &atoms);
    (void)std::sscanf(line, "%lf%% CPU use", &percent);
  }
  pclose(pipe);
  return loop * percent / 100 / atoms / steps * 1e9;
}

void melts() {
  constexpr int steps = 200;
  for (const std::size_t space : {3u, 2u}) {
    const std::size_t cells = space == 3 ? 20 : 179;
    std::printf("W4 melt, %zu-D, whole steps of verlet, processor time in ns an atom and step\n", space);
    for (const BulkSet set : {BulkSet::avx2, BulkSet::avx512}) {
      if (!BulkForces::has(set)) continue;
      constexpr double skins[] = {0.3, 0.5};
      std::vector<Melt> melts;
      std::vector<BulkForces> bulk;
      for (const double skin : skins) {
        melts.emplace_back(space, cells, skin);
        bulk.emplace_back(melts.back().system, BulkKernel::exact, set);
        bulk.back().force(melts.back().q.data(), melts.back().f.data());
      }
      const double atom_steps = steps * static_cast<double>(melts[0].system.particles);
      std::vector<double> ours[2], theirs, checked, ratios[2], checked_ratios[2];
      for (int round = 0; round < 5; ++round) {
        theirs.push_back(lammps(space, cells, steps, false));
        checked.push_back(lammps(space, cells, steps, true));
        for (std::size_t k = 0; k < 2; ++k) {
          const double begin = processor_seconds();
          melts[k].steps(bulk[k], steps);
          ours[k].push_back((processor_seconds() - begin) / atom_steps * 1e9);
          ratios[k].push_back(theirs.back() / ours[k].back());
          checked_ratios[k].push_back(checked.back() / ours[k].back());
        }
      }
      std::printf("  LAMMPS -sf opt, skin 0.3: %.1f with lists every 20 steps unchecked, %.1f with checked ones\n",
                  median(theirs), median(checked));
      for (std::size_t k = 0; k < 2; ++k) {
        std::printf(
            "  exact %-7s skin %.1f %6.1f   LAMMPS/this %5.2f   LAMMPS checked/this %5.2f   lists every %.1f steps\n",
            set == BulkSet::avx2 ? "avx2" : "avx512", skins[k], median(ours[k]), median(ratios[k]),
            median(checked_ratios[k]), 5.0 * steps / static_cast<double>(bulk[k].counts().lists));
      }
    }
  }
}

void threads_and_sizes(const std::vector<std::size_t>& sizes) {
  std::printf("W10 melt, 3-D, exact: wall time in ns an atom and step\n");
  for (const std::size_t cells : sizes) {
    Melt melt(3, cells);
    const BulkForces bulk(melt.system);
    bulk.force(melt.q.data(), melt.f.data());
    const int steps = cells > 40 ? 20 : 60;
    melt.steps(bulk, steps);
    std::vector<double> by[2], ratios;
    for (int round = 0; round < 5; ++round) {
      for (const std::size_t threads : {1u, 2u}) {
        bulk.use_threads(threads);
        bulk.force(melt.q.data(), melt.f.data());  // makes the first list
        const double begin = wall_seconds();
        melt.steps(bulk, steps);
        by[threads - 1].push_back((wall_seconds() - begin) / steps / static_cast<double>(melt.system.particles) * 1e9);
      }
      ratios.push_back(by[0].back() / by[1].back());
    }
    std::printf("  %8zu atoms: %6.1f, on 2 threads %6.1f, ratio %5.2f\n", melt.system.particles, median(by[0]),
                median(by[1]), median(ratios));
  }
}

}  // namespace
}  // namespace bench

/// Arguments: any of pairs, melt, threads, large (a million atoms). Default: the first three.
int main(int count, char** arguments) {
  using namespace bench;
  const std::string which = count > 1 ? arguments[1] : "";
  if (which.empty() || which == "pairs") {
    using Law = hamflow::BulkPairSystem::Law;
    all_pairs<LennardJonesPair, 2>("W3 Lennard-Jones, 2-D, all pairs of 121", 11, Law::lennard_jones);
    all_pairs<LennardJonesPair, 2>("W3 Lennard-Jones, 2-D, all pairs of 441", 21, Law::lennard_jones);
    all_pairs<NewtonPair, 3>("W6 gravity, 3-D, all pairs of 1000", 10, Law::newton);
  }
  if (which.empty() || which == "melt") melts();
  if (which.empty() || which == "threads") threads_and_sizes({20, 32});
  if (which == "large") threads_and_sizes({20, 63});
}
