// Many bodies on the lattice: every bit back for any number of threads, the total momentum to the last bit, sums
// without order, overflow found; and mutants that each of these catches.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numeric>
#include <thread>

#include "../support/allocations.hpp"
#include "hamflow/arithmetic/lattice.hpp"
#include "hamflow/detail/problems/gravity.hpp"
#include "hamflow/methods/compositions/stv4.hpp"
#include "hamflow/methods/force_gradient.hpp"
#include "hamflow/methods/force_gradient/chin4a.hpp"
#include "hamflow/methods/force_gradient/chin4b.hpp"
#include "hamflow/methods/splitting.hpp"
#include "hamflow/run/catalog.hpp"
#include "hamflow/run/simulation_of.hpp"

namespace hamflow {
namespace {

using Numbers = Vector<double, dynamic>;
using Integers = std::vector<std::int64_t>;

struct Cluster {
  std::vector<double> masses;
  Numbers q;
  Numbers p;
  double softening = 0.1;
  std::size_t bodies() const { return masses.size(); }
  Gravity<double> problem() const { return {masses, 1.0, softening, 3}; }
};

/// Bodies of different masses, 1 together, in a cube with edges of 2.
Cluster cluster(std::size_t bodies) {
  std::uint64_t state = 12345;
  const auto random = [&state] {  // in [-1, 1)   [Knuth1997, 3.3.4, table 1]
    state = state * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(state >> 11) * 0x1p-52 - 1.0;
  };
  Cluster c{std::vector<double>(bodies), Numbers(3 * bodies), Numbers(3 * bodies)};
  for (double& m : c.masses) m = (2 + random()) / (2.0 * static_cast<double>(bodies));
  for (double& x : c.q) x = random();
  for (std::size_t i = 0; i < c.p.size(); ++i) c.p[i] = 0.7 * c.masses[i / 3] * random();
  return c;
}

Lattice lattice(int position, int momentum) {
  Lattice a;
  a.position.set_unit(std::ldexp(1.0, position));
  a.momentum.set_unit(std::ldexp(1.0, momentum));
  return a;
}

std::vector<std::string> texts(const double* begin, const double* end) {
  std::vector<std::string> all;
  for (; begin != end; ++begin) all.push_back(shortest(*begin));
  return all;
}

Request request_for(const Cluster& c, const std::string& method, int threads) {
  Request request;
  request.problem = "n-body";
  std::string& list = request.parameters["masses"];
  for (const double m : c.masses) list += (list.empty() ? "[" : ", ") + shortest(m);
  list += "]";
  request.parameters["softening"] = shortest(c.softening);
  request.start.q = texts(c.q.begin(), c.q.end());
  request.start.p = texts(c.p.begin(), c.p.end());
  request.method = parse_method(method);
  request.dt = "1/128";
  request.arithmetic = "lattice";
  request.position_unit = 0x1p-52;
  request.momentum_unit = 0x1p-60;
  request.threads = threads;
  request.watch = false;
  return request;
}

Integers integers(const Simulation& simulation) {
  const auto bytes = simulation.bits();
  Integers all(bytes.size() / sizeof(std::int64_t));
  std::memcpy(all.data(), bytes.data(), bytes.size());
  return all;
}

/// The sum of the momenta in lattice units, modulo 2^64.
std::array<std::uint64_t, 3> total_momentum(const Integers& state) {
  std::array<std::uint64_t, 3> sum{};
  for (std::size_t i = state.size() / 2; i < state.size(); ++i) sum[i % 3] += static_cast<std::uint64_t>(state[i]);
  return sum;
}

using Stv4 = Composition<compositions::stv4>;

template <class P>
auto on_lattice(const P& problem, const Cluster& c, double h, const Lattice& units = lattice(-52, -60)) {
  return simulate<false, P, Stv4, Lattice>(problem, Stv4{}, c.q, c.p, h, units);
}

template <class S>
bool returns(S& simulation, std::int64_t steps) {
  const auto start = simulation.bits();
  EXPECT_EQ(simulation.advance(steps), Outcome::done);
  EXPECT_NE(simulation.bits(), start);
  simulation.negate_momenta();
  EXPECT_EQ(simulation.advance(steps), Outcome::done);
  simulation.negate_momenta();
  return simulation.bits() == start;
}

TEST(LatticeBodies, EveryBitIsBackAndTheTotalMomentumNeverChanges) {
  for (const auto& [bodies, steps] : {std::pair<std::size_t, std::int64_t>{12, 4000}, {100, 200}}) {
    for (const char* method : {"stv4", "verlet-dkd", "yoshida6"}) {
      Integers far;
      for (const int threads : {1, 2, 4}) {
        SCOPED_TRACE(std::to_string(bodies) + " bodies, " + method + ", threads " + std::to_string(threads));
        const auto simulation = make_simulation(request_for(cluster(bodies), method, threads));
        const Integers start = integers(*simulation);
        ASSERT_EQ(simulation->advance(steps), Outcome::done);
        if (far.empty()) far = integers(*simulation);
        EXPECT_EQ(integers(*simulation), far) << "the same bits for any number of threads";
        EXPECT_NE(far, start);
        EXPECT_EQ(total_momentum(far), total_momentum(start));
        simulation->negate_momenta();
        ASSERT_EQ(simulation->advance(steps), Outcome::done);
        simulation->negate_momenta();
        EXPECT_EQ(integers(*simulation), start);
      }
    }
  }
}

TEST(LatticeBodies, TheSolarSystemComesBackToo) {
  Request request;
  request.problem = "solar-system";
  const auto found_entry = find_problem("solar-system", {});
  const ProblemEntry& entry = *found_entry;
  request.start.q = entry.info.default_q;
  request.start.p = entry.info.default_p;
  request.dt = "50";
  request.arithmetic = "lattice";
  request.position_unit = 0x1p-48;
  request.momentum_unit = 0x1p-70;
  request.threads = 2;
  const auto simulation = make_simulation(request);
  const Integers start = integers(*simulation);
  ASSERT_EQ(simulation->advance(2000), Outcome::done);
  EXPECT_EQ(total_momentum(integers(*simulation)), total_momentum(start));
  simulation->negate_momenta();
  ASSERT_EQ(simulation->advance(2000), Outcome::done);
  simulation->negate_momenta();
  EXPECT_EQ(integers(*simulation), start);
}

/// The bodies in reverse order.
Cluster reversed(const Cluster& c) {
  Cluster r = c;
  const std::size_t n = c.bodies();
  for (std::size_t i = 0; i < n; ++i) {
    r.masses[i] = c.masses[n - 1 - i];
    for (std::size_t k = 0; k < 3; ++k) {
      r.q[3 * i + k] = c.q[3 * (n - 1 - i) + k];
      r.p[3 * i + k] = c.p[3 * (n - 1 - i) + k];
    }
  }
  return r;
}
Integers reversed(const Integers& state) {
  Integers r(state.size());
  const std::size_t rows = state.size() / 3;  // positions, then momenta
  for (std::size_t i = 0; i < rows; ++i) {
    const std::size_t half = i < rows / 2 ? 0 : rows / 2;
    for (std::size_t k = 0; k < 3; ++k) r[3 * i + k] = state[3 * (half + rows / 2 - 1 - (i - half)) + k];
  }
  return r;
}

/// Whether 20 steps give the same bits with the bodies in reverse order.
template <class P>
bool order_does_not_matter(const Cluster& c) {
  auto a = on_lattice(P(c.problem()), c, 1.0 / 128);
  auto b = on_lattice(P(reversed(c).problem()), reversed(c), 1.0 / 128);
  EXPECT_EQ(integers(a), reversed(integers(b)));
  EXPECT_EQ(a.advance(20), Outcome::done);
  EXPECT_EQ(b.advance(20), Outcome::done);
  return integers(a) == reversed(integers(b));
}
template <class P>
bool momentum_is_kept(const Cluster& c) {
  auto a = on_lattice(P(c.problem()), c, 1.0 / 128);
  const auto before = total_momentum(integers(a));
  EXPECT_EQ(a.advance(20), Outcome::done);
  return total_momentum(integers(a)) == before;
}

/// Mutant: no pairs to be seen, so that forces are summed in floating point and then rounded.
class SummedInDouble {
 public:
  using Real = double;
  static constexpr std::size_t dimension = dynamic;
  explicit SummedInDouble(Gravity<double> gravity) : gravity_(std::move(gravity)) {}
  std::size_t size() const { return gravity_.size(); }
  double kinetic(const Numbers& p) const { return gravity_.kinetic(p); }
  double potential(const Numbers& q) const { return gravity_.potential(q); }
  void velocity(const Numbers& p, Numbers& v) const { gravity_.velocity(p, v); }
  void force(const Numbers& q, Numbers& f) const { gravity_.force(q, f); }

 private:
  Gravity<double> gravity_;
};

TEST(LatticeBodies, TheOrderOfTheBodiesDoesNotMatter) {
  EXPECT_TRUE(order_does_not_matter<Gravity<double>>(cluster(20)));
  EXPECT_TRUE(momentum_is_kept<Gravity<double>>(cluster(20)));
}

TEST(Mutant, SumsInFloatingPointDependOnTheOrderOfTheBodies) {
  EXPECT_FALSE(order_does_not_matter<SummedInDouble>(cluster(20)));
  EXPECT_FALSE(momentum_is_kept<SummedInDouble>(cluster(20)));
  std::printf("mutant \"lattice summing forces in double\" caught by: order of bodies, total momentum\n");
}

/// Mutant: a list of neighbours that is made anew every 20 forces; a pair that is not on it is left out.
class WithMemory : public Gravity<double> {
 public:
  explicit WithMemory(const Gravity<double>& gravity) : Gravity<double>(gravity) {}
  template <class Difference, class Sink>
  void pair_kicks(double factor, const Difference& difference, std::size_t first, std::size_t last, Sink& sink) const {
    const std::size_t n = pair_rows();
    if (memory_->first++ % 20 == 0) {
      memory_->second.assign(n * n, false);
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = i + 1; j < n; ++j) {
          double u = 0;
          for (std::size_t k = 0; k < 3; ++k) {
            const double d = difference(3 * i + k, 3 * j + k);
            u += d * d;
          }
          memory_->second[n * i + j] = u < 1;
        }
      }
    }
    const auto& near = memory_->second;
    auto only_near = [&](std::size_t up, std::size_t down, double r) {
      if (near[n * (down / 3) + up / 3]) sink(up, down, r);
    };
    Gravity<double>::pair_kicks(factor, difference, first, last, only_near);
  }

 private:
  std::shared_ptr<std::pair<int, std::vector<bool>>> memory_ =
      std::make_shared<std::pair<int, std::vector<bool>>>(0, std::vector<bool>{});
};

TEST(Mutant, AForceWithMemoryDoesNotComeBack) {
  static_assert(PairwiseForces<WithMemory> && !PairwiseForces<SummedInDouble>);
  const Cluster c = cluster(20);
  auto sound = on_lattice(c.problem(), c, 1.0 / 128);
  EXPECT_TRUE(returns(sound, 101));
  auto mutant = on_lattice(WithMemory(c.problem()), c, 1.0 / 128);
  EXPECT_FALSE(returns(mutant, 101));
  std::printf("mutant \"force with a list of neighbours\" caught by: exact return\n");
}

TEST(LatticeBodies, MovedByALatticeVectorTheMotionIsTheSame) {
  Cluster c = cluster(8);
  for (double& x : c.q) x = std::ldexp(std::round(std::ldexp(x, 40)), -40);
  Cluster moved = c;
  for (double& x : moved.q) x += 500;
  auto here = on_lattice(c.problem(), c, 1.0 / 128);
  auto there = on_lattice(moved.problem(), moved, 1.0 / 128);
  ASSERT_EQ(here.advance(100), Outcome::done);
  ASSERT_EQ(there.advance(100), Outcome::done);
  Integers expected = integers(here);
  for (std::size_t i = 0; i < expected.size() / 2; ++i) expected[i] += std::int64_t{500} << 52;
  EXPECT_EQ(integers(there), expected);
}

TEST(LatticeBodies, RoundingIsOddAtTiesToo) {
  const Lattice::Axis axis;
  const double u = axis.unit;
  for (const auto& [x, rounded] : {std::pair<double, std::int64_t>{0.5, 0}, {1.5, 2}, {2.5, 2}, {3.5, 4}, {0.49, 0}}) {
    std::int64_t up = 99;
    std::int64_t down = 99;
    ASSERT_TRUE(axis.units(x * u, 0x1p62, up) && axis.units(-x * u, 0x1p62, down));
    EXPECT_EQ(up, rounded);
    EXPECT_EQ(down, -rounded);
  }
  std::int64_t k = 99;
  EXPECT_FALSE(axis.units(8 * u, 8, k) || axis.units(-8 * u, 8, k) || axis.units(NAN, 8, k) ||
               axis.units(INFINITY, 8, k));
  EXPECT_EQ(k, 99);
}

TEST(LatticeBodies, OverflowIsFoundAndLeavesTheLastStateInside) {
  for (const int threads : {1, 2}) {
    for (const std::int64_t block : {1, 1000}) {
      SCOPED_TRACE(std::to_string(threads) + " threads, blocks of " + std::to_string(block));
      Request request = request_for(cluster(8), "stv4", threads);
      request.momentum_unit = 0x1p-64;  // a range of 1/4; a limit of 1/64 for one pair's kick
      request.parameters["softening"] = "0.001";
      const auto simulation = make_simulation(request);
      Outcome outcome = Outcome::done;
      while (outcome == Outcome::done && simulation->step() < 100'000) outcome = simulation->advance(block);
      EXPECT_EQ(outcome, Outcome::lattice_overflow);
      EXPECT_GT(simulation->step(), 0);
      const auto last = make_simulation(request);
      ASSERT_EQ(last->advance(simulation->step()), Outcome::done);
      EXPECT_EQ(last->bits(), simulation->bits());
      EXPECT_EQ(last->advance(1), Outcome::lattice_overflow);
    }
  }
}

TEST(LatticeBodies, SumsOfTheLargestContributionsDoNotOverflow) {
  // All bodies but the first at one point: its kicks all have one direction and almost the size of the limit.
  constexpr std::size_t bodies = 63;
  Cluster c{std::vector<double>(bodies, 1.0), Numbers(3 * bodies), Numbers(3 * bodies), 0.01};
  for (std::size_t i = 3; i < c.q.size(); ++i) c.q[i] = 1;
  Lattice units = lattice(-52, 0);
  const double one = 1.0 / std::pow(3 + 1e-4, 1.5);
  units.momentum.set_unit(
      std::ldexp(1.0, -56 + std::ilogb(one) + 1));  // one contribution: 1/2 .. 1 of 2^(62 - 6) units
  PhasePoint<Lattice, dynamic> z{.arithmetic = units};
  z.store(c.q, c.p);
  const PairSums<Gravity<double>, Lattice> sums;
  Vector<std::int64_t, dynamic> kick(c.q.size());
  ASSERT_TRUE(sums.evaluate(c.problem(), 1.0, z, kick));
  EXPECT_GT(kick[0], std::int64_t{1} << 60);
  for (std::size_t axis = 0; axis < 3; ++axis) {  // each by itself: together they would not fit
    std::int64_t sum = 0;
    for (std::size_t i = axis; i < kick.size(); i += 3) sum += kick[i];
    EXPECT_EQ(sum, 0);
  }
  EXPECT_FALSE(sums.evaluate(c.problem(), 2.0, z, kick)) << "twice that is beyond the limit";
}

TEST(LatticeBodies, TwoBodiesAtOnePointAreAnOverflow) {
  Cluster c = cluster(3);
  for (std::size_t k = 0; k < 3; ++k) c.q[3 + k] = c.q[k];
  c.softening = 0;
  auto simulation = on_lattice(c.problem(), c, 1.0 / 128);
  EXPECT_EQ(simulation.advance(1), Outcome::lattice_overflow);
}

TEST(LatticeBodies, AKeptKickIsTheOneThatWouldBeComputed) {
  for (const int threads : {1, 2}) {
    const auto kept = make_simulation(request_for(cluster(10), "stv4", threads));
    const auto anew = make_simulation(request_for(cluster(10), "stv4", threads));
    ASSERT_EQ(kept->advance(50), Outcome::done);
    for (int i = 0; i < 50; ++i) {
      ASSERT_EQ(anew->advance(1), Outcome::done);
      anew->negate_momenta();  // drops the kept kick
      anew->negate_momenta();
    }
    EXPECT_EQ(kept->bits(), anew->bits());
    EXPECT_EQ(kept->effort().force, 3 * 50 + 1);
    EXPECT_EQ(anew->effort().force, 4 * 50);
  }
}

TEST(LatticeBodies, SavedClonedAndContinuedByAnotherNumberOfThreadsTheBitsAreTheSame) {
  using P = Gravity<double>;
  using M = Stv4::Stepper<P, Lattice>;
  const Cluster c = cluster(10);
  const auto with_threads = [&](std::size_t threads) {
    M method = Stv4{}.bind<P, Lattice>(c.problem());
    method.use_threads(threads);
    return SimulationOf<P, M, Lattice>(c.problem(), method, c.q, c.p, 1.0 / 128, lattice(-52, -60));
  };
  auto simulation = with_threads(2);
  ASSERT_EQ(simulation.advance(50), Outcome::done);
  const auto saved = simulation.save();
  const auto clone = simulation.clone();
  auto restored = with_threads(1);
  restored.restore(saved);
  ASSERT_EQ(simulation.advance(50), Outcome::done);
  ASSERT_EQ(clone->advance(50), Outcome::done);
  ASSERT_EQ(restored.advance(50), Outcome::done);
  EXPECT_EQ(clone->bits(), simulation.bits());
  EXPECT_EQ(restored.bits(), simulation.bits());
  EXPECT_EQ(restored.effort().force, 3 * 100 + 1) << "the kept kick was saved too";
}

/// chin4a, chin4b: the kick with gradient, pair by pair, is that of the Hessian; reversible, without order, momentum
/// kept.
TEST(LatticeBodies, ForceGradientsArePairByPairToo) {
  using P = Gravity<double>;
  for (const ForceGradientTable* table : {&force_gradient::chin4a, &force_gradient::chin4b}) {
    const Cluster c = cluster(20);
    const ForceGradient recipe{table};
    const auto with = [&]<class A>(const Cluster& start, const A& arithmetic, std::size_t threads) {
      auto method = recipe.bind<P, A>(start.problem());
      if constexpr (requires { method.use_threads(1); }) method.use_threads(threads);
      return SimulationOf<P, decltype(method), A>(start.problem(), method, start.q, start.p, 1.0 / 64, arithmetic);
    };
    auto simulation = with(c, lattice(-52, -60), 1);
    const Integers start = integers(simulation);
    auto by_two = with(c, lattice(-52, -60), 2);
    auto renumbered = with(reversed(c), lattice(-52, -60), 1);
    auto plain = with(c, Plain<double>{}, 1);
    for (auto* s : {&simulation, &by_two, &renumbered}) ASSERT_EQ(s->advance(100), Outcome::done);
    ASSERT_EQ(plain.advance(100), Outcome::done);
    EXPECT_EQ(integers(by_two), integers(simulation));
    EXPECT_EQ(reversed(integers(renumbered)), integers(simulation));
    EXPECT_EQ(total_momentum(integers(simulation)), total_momentum(start));
    EXPECT_EQ(simulation.effort().force, plain.effort().force);
    Frame a;
    Frame b;
    simulation.look(a);
    plain.look(b);
    // Rounding makes about 1e-13 of it, as in the test above; left out, the gradient is missed by up to 1e-6.
    for (std::size_t i = 0; i < a.q.size(); ++i) EXPECT_NEAR(a.q[i], b.q[i], 1e-11);
    simulation.negate_momenta();
    ASSERT_EQ(simulation.advance(100), Outcome::done);
    simulation.negate_momenta();
    EXPECT_EQ(integers(simulation), start);
  }
}

TEST(LatticeBodies, ErrorsAreThoseOfRounding) {
  // Each kick adds an error of (N - 1)/12 units^2 to a momentum, each drift 1/12 to a coordinate, all independent; the
  // motion amplifies them like a random displacement of the start, which is measured in compensated double. (q, v) in
  // one norm: times and lengths are of order 1.
  const Cluster c = cluster(30);
  constexpr std::int64_t steps = 256;
  const auto phase = [&](const auto& simulation) {
    Frame frame;
    simulation.look(frame);
    std::vector<double> x = frame.q;
    for (std::size_t i = 0; i < frame.p.size(); ++i) x.push_back(frame.p[i] / c.masses[i / 3]);
    return x;
  };
  const auto distance = [](const std::vector<double>& a, const std::vector<double>& b) {
    double square = 0;
    for (std::size_t i = 0; i < a.size(); ++i) square += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(square);
  };
  const auto end = [&]<class A>(const Cluster& start, const A& arithmetic) {
    auto s = simulate<false, Gravity<double>, Stv4, A>(c.problem(), Stv4{}, start.q, start.p, 1.0 / 128, arithmetic);
    auto before = phase(s);
    EXPECT_EQ(s.advance(steps), Outcome::done);
    return std::pair{before, phase(s)};
  };
  Cluster displaced = c;
  for (std::size_t i = 0; i < c.q.size(); ++i) {
    displaced.q[i] += 1e-8 * std::sin(1.0 + 37.0 * static_cast<double>(i));
    displaced.p[i] += 1e-8 * c.masses[i / 3] * std::sin(2.0 + 53.0 * static_cast<double>(i));
  }
  const auto best = end(c, Compensated<double>{});
  const auto other = end(displaced, Compensated<double>{});
  const double growth = std::max(1.0, distance(best.second, other.second) / distance(best.first, other.first));
  double variance = 0;  // of one kick and one drift
  for (const double m : c.masses) {
    variance += 3 * (0x1p-104 / 12 + static_cast<double>(c.bodies() - 1) * (0x1p-60 / m) * (0x1p-60 / m) / 12);
  }
  const double expected = growth * std::sqrt(3 * static_cast<double>(steps) * variance);
  const double lattice_error = distance(end(c, lattice(-52, -60)).second, best.second);
  const double double_error = distance(end(c, Plain<double>{}).second, best.second);
  std::printf("30 bodies, %lld steps: errors %.1e on the lattice, %.1e in double; expected %.1e, growth %.1e\n",
              static_cast<long long>(steps), lattice_error, double_error, expected, growth);
  EXPECT_LT(lattice_error, 4 * expected);
  EXPECT_LT(lattice_error, 10 * double_error);
}

TEST(LatticeBodies, CopiesShareTheirThreadsAndTakeTurns) {
  const Cluster c = cluster(40);
  PhasePoint<Lattice, dynamic> z{.arithmetic = lattice(-52, -60)};
  z.store(c.q, c.p);
  PairSums<Gravity<double>, Lattice> alone;
  PairSums<Gravity<double>, Lattice> shared;
  shared.use_threads(3);
  Vector<std::int64_t, dynamic> expected(c.q.size());
  ASSERT_TRUE(alone.evaluate(c.problem(), 0.01, z, expected));
  std::atomic<int> wrong = 0;
  const auto work = [&](PairSums<Gravity<double>, Lattice> copy) {
    const Gravity<double> problem = c.problem();
    Vector<std::int64_t, dynamic> kick(c.q.size());
    for (int i = 0; i < 500; ++i) {
      const double factor = i % 2 == 0 ? 0.01 : -0.01;
      if (!copy.evaluate(problem, factor, z, kick)) ++wrong;
      for (std::size_t k = 0; k < kick.size(); ++k)
        wrong += kick[k] == (factor > 0 ? expected[k] : -expected[k]) ? 0 : 1;
    }
  };
  {
    const std::jthread one(work, shared);
    const std::jthread two(work, shared);
  }
  EXPECT_EQ(wrong, 0);
}

TEST(LatticeBodies, AStepAllocatesNothing) {
  if (!test::counts_allocations()) GTEST_SKIP();
  for (const int threads : {1, 3}) {
    const auto simulation = make_simulation(request_for(cluster(10), "stv4", threads));
    ASSERT_EQ(simulation->advance(10), Outcome::done);
    const long long before = test::allocations();
    ASSERT_EQ(simulation->advance(1000), Outcome::done);
    EXPECT_EQ(test::allocations(), before) << threads << " threads";
  }
}

TEST(LatticeBodies, ThreadsAreRefusedWhereTheyWouldChangeBitsOrServeNothing) {
  const auto why_not = [](Request request) -> std::string {
    try {
      (void)make_simulation(request);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  Request request = request_for(cluster(3), "stv4", 2);
  EXPECT_EQ(why_not(request), "");
  request.arithmetic = "compensated";
  EXPECT_NE(why_not(request).find("order of floating-point sums"), std::string::npos) << why_not(request);
  request.arithmetic = "lattice";
  for (const int threads : {0, -1, most_threads + 1}) {
    request.threads = threads;
    EXPECT_NE(why_not(request).find("1 to 256"), std::string::npos) << why_not(request);
  }
  request = Request{};
  request.problem = "pendulum";
  request.start.q = {"1"};
  request.start.p = {"0"};
  request.arithmetic = "lattice";
  request.threads = 2;
  EXPECT_NE(why_not(request).find("n-body"), std::string::npos) << why_not(request);
}

}  // namespace
}  // namespace hamflow
