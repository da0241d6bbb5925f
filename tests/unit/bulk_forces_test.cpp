// Bulk forces against a plain loop over pairs in double-double, and their bits against themselves.
#include "hamflow/core/bulk_forces.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <new>
#include <random>

#include "hamflow/arithmetic/double_double.hpp"
#include "hamflow/core/error.hpp"
#include "hamflow/run/catalog.hpp"

namespace {
std::atomic<long> allocations{0};
}  // namespace
void* operator new(std::size_t bytes) {
  ++allocations;
  if (void* const memory = std::malloc(bytes)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace hamflow {
namespace {

using D = DoubleDouble;
using Kind = BulkPairSystem::Law;
using Cutoff = BulkPairSystem::Cutoff;
constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// A jittered lattice, of unit spacing along each axis.
std::vector<double> lattice(std::size_t space, std::size_t per_side, double jitter, double from) {
  std::mt19937_64 random(7);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; };
  std::vector<double> q;
  const std::size_t layers = space == 3 ? per_side : 1;
  for (std::size_t z = 0; z < layers; ++z) {
    for (std::size_t y = 0; y < per_side; ++y) {
      for (std::size_t x = 0; x < per_side; ++x) {
        q.push_back(from + static_cast<double>(x) + jitter * uniform());
        q.push_back(from + static_cast<double>(y) + jitter * uniform());
        if (space == 3) q.push_back(from + static_cast<double>(z) + jitter * uniform());
      }
    }
  }
  return q;
}

/// phi and dphi/dr of the pair law as the header states them, and the sizes of the terms that they are made of.
struct Stated {
  D phi;
  D slope;
  double size_of_phi;
  double size_of_slope;
};
Stated law_at(const BulkPairSystem& s, const D& r) {
  if (s.law == Kind::lennard_jones) {
    const D w = D(s.sigma) / r;
    const D w2 = w * w;
    const D w6 = w2 * w2 * w2;
    const D up = D(s.factor) * w6 * w6;
    const D down = D(s.factor * s.attraction) * w6;
    return {up - down, (D(6) * down - D(12) * up) / r, static_cast<double>(up + down),
            static_cast<double>((D(6) * down + D(12) * up) / r)};
  }
  const D u = r * r + D(s.softening) * D(s.softening);
  const D phi = D(s.factor) / sqrt(u);
  const D slope = phi * r / u;
  return {-phi, slope, static_cast<double>(phi), static_cast<double>(slope)};
}
Stated cut_law_at(const BulkPairSystem& s, const D& r) {
  const D R(s.radius);
  if (s.cutoff != Cutoff::none && !(r < R)) return {D(0), D(0), 0, 0};
  Stated here = law_at(s, r);
  const Stated end = s.cutoff == Cutoff::none ? here : law_at(s, R);
  if (s.cutoff == Cutoff::shifted || s.cutoff == Cutoff::force_shifted) {
    here.phi = here.phi - end.phi;
    here.size_of_phi += end.size_of_phi;
  }
  if (s.cutoff == Cutoff::force_shifted) {
    here.phi = here.phi - (r - R) * end.slope;
    here.slope = here.slope - end.slope;
    here.size_of_phi += s.radius * 2 * end.size_of_slope;
    here.size_of_slope += end.size_of_slope;
  }
  if (s.cutoff == Cutoff::smooth && r > D(s.inner)) {
    const D width = R * R - D(s.inner) * D(s.inner);
    const D x = (r * r - D(s.inner) * D(s.inner)) / width;
    const D x5 = x * x * x * x * x;
    const D fade = D(1) - x5 * (D(126) - D(420) * x + D(540) * x * x - D(315) * x * x * x + D(70) * x * x * x * x);
    const D y = x * (D(1) - x);
    const D turn = D(-630) * y * y * y * y * D(2) * r / width;
    here.slope = here.slope * fade + here.phi * turn;
    here.phi = here.phi * fade;
    // The polynomial's terms at x <= 1 sum to at most 1471; and x itself is a difference, of numbers up to R^2.
    const double terms = 1471 * (1 + s.radius * s.radius / static_cast<double>(width));
    here.size_of_phi *= terms;
    here.size_of_slope =
        here.size_of_slope * terms + here.size_of_phi * 630 * 2 * s.radius / static_cast<double>(width);
  }
  return here;
}

struct Reference {
  std::vector<double> force, force_bound;
  double potential = 0, potential_bound = 0;
};
/// Sums in double-double, and what each rounding of the kernel may make of them: a length of relative error delta
/// changes a term by at most 14 delta of its size (r^-14 is the steepest), the law itself has some 40 operations at
/// most, those of the smooth end included, and a sum of n terms adds n/8 + 3 roundings of all that is summed. In a
/// periodic box a coordinate is moved by a rounded multiple of the edge first.
Reference reference(const BulkPairSystem& s, const std::vector<double>& q) {
  Reference all;
  const std::size_t n = s.space;
  all.force.assign(q.size(), 0);
  all.force_bound.assign(q.size(), 0);
  const double edge = std::max({s.edges[0], s.edges[1], s.edges[2]});
  D potential(0);
  for (std::size_t i = 0; i < s.particles; ++i) {
    D force[3] = {D(0), D(0), D(0)};
    for (std::size_t j = 0; j < s.particles; ++j) {
      if (i == j) continue;
      D d[3];
      D u(0);
      for (std::size_t k = 0; k < n; ++k) {
        d[k] = D(q[i * n + k]) - D(q[j * n + k]);
        if (s.edges[k] != 0) {
          d[k] = d[k] - D(std::nearbyint(static_cast<double>(d[k]) / s.edges[k])) * D(s.edges[k]);
        }
        u = u + d[k] * d[k];
      }
      const D r = sqrt(u);
      const Stated pair = cut_law_at(s, D(s.length_scale) * r);
      const D w = s.strengths.empty() ? D(1) : D(s.strengths[i]) * D(s.strengths[j]);
      const D push = D(0) - D(s.prefactor * s.length_scale) * w * pair.slope / r;
      const double distance = static_cast<double>(r);
      const double delta = epsilon * (1 + 4 * edge / distance);
      const double roundings = 14 * delta + (40 + static_cast<double>(s.particles) / 8 + 3) * epsilon;
      const double strength = std::abs(static_cast<double>(w) * s.prefactor);
      for (std::size_t k = 0; k < n; ++k) {
        force[k] = force[k] + push * d[k];
        all.force_bound[i * n + k] += strength * s.length_scale * pair.size_of_slope *
                                      (roundings * std::abs(static_cast<double>(d[k])) / distance + delta);
      }
      potential = potential + D(s.prefactor) * w * pair.phi / D(2);
      all.potential_bound += strength / 2 * pair.size_of_phi * (roundings + 12 * delta);
    }
    for (std::size_t k = 0; k < n; ++k) all.force[i * n + k] = static_cast<double>(force[k]);
  }
  all.potential = static_cast<double>(potential);
  all.potential_bound += std::abs(all.potential) * epsilon * static_cast<double>(s.particles);
  return all;
}

std::vector<BulkSet> sets() {
  std::vector<BulkSet> all{BulkSet::sse2};
  for (const BulkSet set : {BulkSet::avx2, BulkSet::avx512}) {
    if (BulkForces::has(set)) all.push_back(set);
  }
  return all;
}

void expect_reference(const BulkPairSystem& s, const std::vector<double>& q, const std::string& what) {
  const Reference wanted = reference(s, q);
  std::vector<double> first;
  for (const BulkSet set : sets()) {
    const BulkForces forces(s, set);
    std::vector<double> f(q.size());
    const double v = forces.force_and_potential(q.data(), f.data());
    EXPECT_LE(std::abs(v - wanted.potential), wanted.potential_bound) << what;
    for (std::size_t i = 0; i < f.size(); ++i) {
      ASSERT_LE(std::abs(f[i] - wanted.force[i]), wanted.force_bound[i]) << what << ", force " << i;
    }
    std::vector<double> again(q.size());
    forces.force(q.data(), again.data());
    EXPECT_EQ(again, f) << what << ": without the energy";
    if (first.empty()) first = f;
    EXPECT_EQ(f, first) << what << ": another instruction set";
  }
}

BulkPairSystem melt(std::size_t space, std::size_t per_side) {
  BulkPairSystem s;
  s.space = space;
  s.particles = space == 3 ? per_side * per_side * per_side : per_side * per_side;
  s.cutoff = Cutoff::shifted;
  s.radius = 2.5;
  const double edge = static_cast<double>(per_side);
  s.edges = {edge, edge, space == 3 ? edge : 0};
  return s;
}

TEST(BulkForces, AreThoseOfThePairLawsInEveryCutOffBoxAndSpace) {
  for (const std::size_t space : {2u, 3u}) {
    const std::size_t per_side = space == 2 ? 9 : 6;
    const auto q = lattice(space, per_side, 0.15, -0.5 * static_cast<double>(per_side));
    for (const Kind law : {Kind::lennard_jones, Kind::newton}) {
      BulkPairSystem s;
      s.space = space;
      s.particles = q.size() / space;
      s.law = law;
      s.factor = 0.8;
      s.prefactor = 0.7;
      s.length_scale = 1.25;
      s.sigma = 1.1;
      if (law == Kind::newton) {
        s.softening = 0.05;
        for (std::size_t i = 0; i < s.particles; ++i) s.strengths.push_back(0.5 + static_cast<double>(i % 5));
      }
      expect_reference(s, q, "all pairs");
      for (const Cutoff cutoff : {Cutoff::shifted, Cutoff::force_shifted, Cutoff::smooth}) {
        for (const bool periodic : {false, true}) {
          s.cutoff = cutoff;
          s.radius = 2.9;
          s.inner = 2.2;
          const double edge = static_cast<double>(per_side);
          s.edges = {};
          if (periodic) s.edges = {edge, edge + 0.5, space == 3 ? edge : 0};
          expect_reference(s, q,
                           "space " + std::to_string(space) + ", law " + std::to_string(static_cast<int>(law)) +
                               ", cut-off " + std::to_string(static_cast<int>(cutoff)) +
                               (periodic ? ", periodic" : ""));
        }
      }
    }
  }
}

TEST(BulkForces, SeeThroughTheEdgesOfBoxesOfAnyNumberOfCells) {
  // From a box that is twice the cut-off to one of several cells, and particles that have left it.
  for (const std::size_t per_side : {5u, 6u, 8u, 9u, 12u}) {
    BulkPairSystem s = melt(2, per_side);
    auto q = lattice(2, per_side, 0.1, 0.3);
    for (std::size_t i = 0; i < q.size(); i += 7) q[i] += 3 * s.edges[0];
    for (std::size_t i = 3; i < q.size(); i += 11) q[i] -= 2 * s.edges[0];
    expect_reference(s, q, "edge " + std::to_string(per_side));
  }
}

/// The hash of the states of a melt after so many steps of Verlet.
std::uint64_t hash_of_motion(const BulkPairSystem& s, BulkSet set, std::size_t threads, int steps, long* lists) {
  const double h = 0.005;
  const std::size_t per_side = static_cast<std::size_t>(s.edges[0]);
  std::vector<double> q = lattice(s.space, per_side, 0.01, 0);
  std::vector<double> p = lattice(s.space, per_side, 1, 0);
  std::vector<double> f(q.size());
  for (std::size_t i = 0; i < p.size(); ++i) p[i] -= std::nearbyint(p[i]);
  const BulkForces forces(s, set);
  forces.use_threads(threads);
  std::uint64_t hash = 1;
  double v = forces.force_and_potential(q.data(), f.data());
  for (int n = 0; n < steps; ++n) {
    for (std::size_t i = 0; i < q.size(); ++i) q[i] += h * (p[i] += h / 2 * f[i]);
    v = forces.force_and_potential(q.data(), f.data());
    for (std::size_t i = 0; i < q.size(); ++i) p[i] += h / 2 * f[i];
  }
  for (const auto* x : {&q, &p, &f}) {
    for (const double y : *x) hash = hash * 0x9e3779b97f4a7c15u + std::bit_cast<std::uint64_t>(y);
  }
  hash = hash * 0x9e3779b97f4a7c15u + std::bit_cast<std::uint64_t>(v);
  if (lists != nullptr) *lists = static_cast<long>(forces.counts().lists);
  return hash;
}

TEST(BulkForces, HaveTheSameBitsForAnyThreadsRegistersSkinsAndLists) {
  constexpr int steps = 1000;
  BulkPairSystem s = melt(3, 6);
  long usual = 0;
  const std::uint64_t wanted = hash_of_motion(s, BulkSet::best, 1, steps, &usual);
  EXPECT_GT(usual, 3);
  EXPECT_LT(usual, steps / 4);
  for (const BulkSet set : sets()) {
    for (const std::size_t threads : {1u, 2u, 4u}) {
      EXPECT_EQ(hash_of_motion(s, set, threads, threads == 1 ? steps : steps / 10, nullptr),
                threads == 1 ? wanted : hash_of_motion(s, BulkSet::best, 1, steps / 10, nullptr));
    }
  }
  for (const double skin : {0.0, 0.1, 1.0}) {
    s.skin = skin;
    long lists = 0;
    EXPECT_EQ(hash_of_motion(s, BulkSet::best, 1, steps, &lists), wanted) << skin;
    EXPECT_TRUE(skin == 1 ? lists < usual : lists > usual) << skin;
  }
  s.skin = 0.3;
  s.rebuild_every_time = true;
  long lists = 0;
  EXPECT_EQ(hash_of_motion(s, BulkSet::best, 1, steps, &lists), wanted);
  EXPECT_EQ(lists, steps + 1);
}

TEST(BulkForces, HaveTheSameBitsForAnyThreadsWithoutLists) {
  BulkPairSystem s;
  s.particles = 101;
  auto q = lattice(2, 11, 0.2, 0);
  q.resize(2 * s.particles);
  std::vector<double> one(q.size()), many(q.size());
  for (const Kind law : {Kind::lennard_jones, Kind::newton}) {
    s.law = law;
    const BulkForces forces(s);
    const double v = forces.force_and_potential(q.data(), one.data());
    for (const std::size_t threads : {2u, 4u}) {
      forces.use_threads(threads);
      EXPECT_EQ(forces.force_and_potential(q.data(), many.data()), v);
      EXPECT_EQ(many, one);
    }
  }
}

/// Of a jittered lattice: forces and potential.
std::uint64_t hash_of_forces(BulkPairSystem s, std::size_t per_side, BulkSet set) {
  const auto q = lattice(s.space, per_side, 0.15, -0.5 * static_cast<double>(per_side));
  s.particles = q.size() / s.space;
  if (s.law == Kind::newton) {
    for (std::size_t i = 0; i < s.particles; ++i) s.strengths.push_back(0.5 + static_cast<double>(i % 5));
  }
  std::vector<double> f(q.size());
  const BulkForces forces(s, set);
  forces.use_threads(2);
  f.push_back(forces.force_and_potential(q.data(), f.data()));
  std::uint64_t hash = 1;
  for (const double y : f) hash = hash * 0x9e3779b97f4a7c15u + std::bit_cast<std::uint64_t>(y);
  return hash;
}

// Runs are resumed by later versions: the bits of exact are part of what it promises. Only +, -, *, / and roots make
// them, so that these hashes hold on every machine.
TEST(BulkForces, HaveTheBitsThatTheyHadInTheFirstVersion) {
  BulkPairSystem s;
  s.sigma = 1.1;
  s.radius = 2.45;
  s.inner = 1.9;
  BulkPairSystem attracting = s;
  attracting.space = 3;
  attracting.law = Kind::newton;
  attracting.softening = 0.125;
  for (const BulkSet set : sets()) {
    EXPECT_EQ(hash_of_forces(s, 3, set), 0x39fd4901f4eb2fd8u);  // one group of sixteen
    EXPECT_EQ(hash_of_forces(s, 11, set), 0xd0854eaf899fb467u);
    EXPECT_EQ(hash_of_forces(attracting, 4, set), 0x1da201ed15af95a8u);  // whole groups of sixteen
    EXPECT_EQ(hash_of_forces(attracting, 5, set), 0x9206d22c70d2af74u);
    BulkPairSystem cut = s;
    cut.cutoff = Cutoff::force_shifted;
    cut.edges = {11, 11.5, 0};
    EXPECT_EQ(hash_of_forces(cut, 11, set), 0x239e0efc26587eacu);
    cut = attracting;
    cut.cutoff = Cutoff::smooth;
    EXPECT_EQ(hash_of_forces(cut, 6, set), 0x0a64ea4336f16596u);
  }
}

TEST(BulkForces, GiveThePotentialOfTheLastForceWithoutAnotherPass) {
  const BulkPairSystem s = melt(2, 8);
  auto q = lattice(2, 8, 0.1, 0);
  std::vector<double> f(q.size());
  const BulkForces forces(s);
  const BulkForces copy = forces;
  const double v = forces.force_and_potential(q.data(), f.data());
  EXPECT_EQ(copy.potential(q.data()), v);
  EXPECT_EQ(forces.counts().evaluations, 1u);
  q[5] = std::nextafter(q[5], 100);
  const double moved = forces.potential(q.data());
  EXPECT_EQ(forces.counts().evaluations, 2u);
  EXPECT_EQ(moved, BulkForces(s).potential(q.data()));
}

TEST(BulkForces, LearnAfterWhichForceThePotentialIsWanted) {
  const BulkPairSystem s = melt(2, 8);
  auto q = lattice(2, 8, 0.1, 0);
  std::vector<double> f(q.size());
  for (const int stages : {1, 3}) {
    const BulkForces forces(s);
    for (int step = 0; step < 10; ++step) {
      for (int k = 0; k < stages; ++k) {
        for (double& x : q) x += 1e-3;
        forces.force(q.data(), f.data());
      }
      EXPECT_EQ(forces.potential(q.data()), BulkForces(s).potential(q.data()));
    }
    EXPECT_EQ(forces.counts().evaluations, static_cast<std::uint64_t>(10 * stages + 1)) << "one pass to learn";
  }
}

TEST(BulkForces, AllocateNothingAfterTheFirstList) {
  const BulkPairSystem s = melt(3, 9);
  const auto places = lattice(3, 9, 0, 0);
  std::vector<double> q = places;
  std::vector<double> f(q.size());
  std::mt19937_64 random(3);
  for (const std::size_t threads : {1u, 2u}) {
    const BulkForces forces(s);
    forces.use_threads(threads);
    double v = forces.force_and_potential(q.data(), f.data());
    const long before = allocations;
    const auto lists = forces.counts().lists;
    for (int n = 0; n < 20; ++n) {
      for (std::size_t i = 0; i < q.size(); ++i) {
        q[i] = places[i] + 0.15 * (static_cast<double>(random() >> 11) * 0x1p-52 - 1);
      }
      forces.force(q.data(), f.data());
      v += forces.potential(q.data());
      v += forces.force_and_potential(q.data(), f.data());
    }
    EXPECT_EQ(allocations, before) << threads << " threads, " << v;
    EXPECT_GT(forces.counts().lists, lists + 5);
  }
}

/// Blocks of one step too, each of which copies problem, method and state: arrays of coordinates come from the pool.
TEST(BulkForces, LeaveNothingForStepsOfAGasToAllocate) {
  const std::map<std::string, std::string> choices{{"container", "periodic"}, {"cutoff_kind", "shifted"}};
  Request request{.problem = "gas",
                  .variant = choices,
                  .parameters = complete(find_problem("gas", choices)->info,
                                         {{"dimension", "3"}, {"size", "[10, 10, 10]"}, {"cutoff", "2"}}),
                  .method = {.name = "stv4"},
                  .dt = "0.0001"};
  const auto places = lattice(3, 10, 0.05, -4.5);
  for (const double x : places) {
    request.start.q.push_back(std::to_string(x));
    request.start.p.emplace_back("0");
  }
  for (const char* arithmetic : {"double", "lattice"}) {
    request.arithmetic = arithmetic;
    const auto simulation = make_simulation(request);
    for (int block = 0; block < 3; ++block) ASSERT_EQ(simulation->advance(1), Outcome::done);
    const long before = allocations;
    for (const std::int64_t steps : {1, 10, 1, 1}) EXPECT_EQ(simulation->advance(steps), Outcome::done);
    EXPECT_EQ(allocations, before) << arithmetic;
  }
}

TEST(BulkForces, DoNotHideEqualPositionsNorNumbersThatAreNone) {
  for (const bool cut : {false, true}) {
    BulkPairSystem s = melt(2, 8);
    if (!cut) {
      s.cutoff = Cutoff::none;
      s.edges = {};
    }
    auto q = lattice(2, 8, 0.1, 0);
    std::vector<double> f(q.size());
    const BulkForces forces(s);
    q[2] = q[40];
    q[3] = q[41];
    EXPECT_FALSE(std::isfinite(forces.force_and_potential(q.data(), f.data())));
    for (const std::size_t i : {2u, 3u, 40u, 41u}) EXPECT_FALSE(std::isfinite(f[i])) << i;
    EXPECT_TRUE(std::isfinite(f[20]) || !cut);
    for (const double none : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      q[2] = none;
      EXPECT_FALSE(std::isfinite(forces.force_and_potential(q.data(), f.data())));
      EXPECT_FALSE(std::isfinite(f[2]));
    }
    q = lattice(2, 8, 0.1, 0);
    EXPECT_TRUE(std::isfinite(forces.force_and_potential(q.data(), f.data())));
  }
}

TEST(BulkForces, SumToNothing) {
  BulkPairSystem s = melt(3, 6);
  s.cutoff = Cutoff::smooth;
  s.inner = 2;
  const auto q = lattice(3, 6, 0.15, 0);
  std::vector<double> f(q.size());
  BulkForces(s).force(q.data(), f.data());
  const Reference bounds = reference(s, q);
  for (std::size_t k = 0; k < 3; ++k) {
    double sum = 0;
    double bound = 0;
    for (std::size_t i = 0; i < s.particles; ++i) {
      sum += f[3 * i + k];
      bound += bounds.force_bound[3 * i + k];
    }
    EXPECT_LE(std::abs(sum), bound);
  }
}

TEST(BulkForces, RefuseWhatTheyCannotDo) {
  const auto refused = [](BulkPairSystem s, const std::string& text) {
    try {
      (void)BulkForces(s);
      FAIL() << "accepted, wanted: " << text;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
    }
  };
  BulkPairSystem s = melt(2, 8);
  s.space = 4;
  refused(s, "space: found 4; allowed 2, 3");
  s = melt(2, 8);
  s.radius = 4.5;
  refused(s, "edges: found 8; allowed 0, or at least twice the radius");
  s = melt(2, 8);
  s.cutoff = Cutoff::none;
  refused(s, "allowed 0 without a cut-off");
  s = melt(2, 8);
  s.cutoff = Cutoff::smooth;
  s.inner = 2.5;
  refused(s, "inner: found 2.5");
  s = melt(2, 8);
  s.skin = std::numeric_limits<double>::quiet_NaN();
  refused(s, "skin: found");
}

}  // namespace
}  // namespace hamflow
