// Exact solutions in time: pendulum, harmonic oscillator, free fall, against the reference flow.
#include "../support/exact_motion.hpp"
#include "hamflow/core/counter_random.hpp"
#include "hamflow/detail/numerics/elliptic.hpp"
#include "hamflow/problems/free_fall.hpp"
#include "hamflow/problems/harmonic.hpp"
#include "hamflow/problems/pendulum.hpp"

namespace hamflow {
namespace {

using Long = long double;
using test::distance_from_reference;
using test::long_epsilon;
using test::reference_units;
using test::within;
using Start1 = Start<Long, 1>;

const Long pi = pi_value<Long>();

TEST(ExactInTime, PendulumIsTheReferenceFlow) {
  Long worst = 0;
  for (const Long gravity : {1.3L, -0.9L, 0.0L}) {
    const Pendulum<Long> problem(1.7L, 0.8L, gravity);
    for (std::uint64_t i = 0; i < 60; ++i) {
      // Several turns away from 0; small and large energies, both directions.
      const Start1 start{{9 * static_cast<Long>(counter_uniform(41, 3 * i))},
                         {4 * static_cast<Long>(counter_uniform(41, 3 * i + 1)) * (i % 3 == 0 ? 0.1L : 1)}};
      const Long t = 9 * static_cast<Long>(counter_uniform(41, 3 * i + 2));
      const Long distance = distance_from_reference(problem, start, t);
      worst = larger(worst, distance);
      EXPECT_LE(distance, reference_units) << "g = " << static_cast<double>(gravity) << ", start " << i;
    }
  }
  RecordProperty("worst", std::to_string(static_cast<double>(worst)));
}

TEST(ExactInTime, PendulumAtItsSpecialStarts) {
  const Pendulum<Long> one;
  // From the lowest point, at rest, released from a turning point; the separatrix q = 2 gd(t), p = 2 sech t.
  for (const Start1& start : {Start1{{0}, {0.5L}}, Start1{{0}, {-3}}, Start1{{2}, {0}}, Start1{{-3}, {0}},
                              Start1{{1e-12L}, {0}}, Start1{{3.1L}, {1e-7L}}, Start1{{-3.14L}, {-2e-3L}}}) {
    for (const Long t : {0.0L, 0.5L, -3.0L, 8.0L}) EXPECT_LE(distance_from_reference(one, start, t), reference_units);
  }
  for (const Long t : {0.0L, 1.0L, 7.0L, -7.0L, 30.0L}) {
    const auto z = one.exact({0}, {2}, t);
    EXPECT_TRUE(within(z->q[0], 2 * std::atan(std::sinh(t)), 8 * pi * long_epsilon));
    EXPECT_TRUE(within(z->p[0], 2 / std::cosh(t), 8 * long_epsilon));
    const auto back = one.exact({2 * pi}, {-2}, t);  // the other branch, a turn away
    EXPECT_TRUE(within(back->q[0], 2 * pi - 2 * std::atan(std::sinh(t)), 16 * pi * long_epsilon));
  }
  for (const Long t : {-5.0L, 100.0L}) {
    EXPECT_EQ(one.exact({0}, {0}, t)->q[0], 0);
    const auto unstable = Pendulum<Long>(1, 1, -1).exact({0}, {0}, t);  // upside down: q = 0 is the unstable rest
    EXPECT_EQ(unstable->q[0], 0);
    EXPECT_EQ(unstable->p[0], 0);
    EXPECT_EQ(Pendulum<Long>(1, 1, 0).exact({0.7L}, {0}, t)->q[0], 0.7L);
  }
}

TEST(ExactInTime, PendulumNearItsUnstableRestKnowsItsTurn) {
  // A few roundings about odd multiples of pi, where q/(2 pi) rounds to either side.
  for (int n = -25; n <= 25; n += 2) {
    for (const Long offset : {-3.0L, -2.0L, -1.0L, 0.0L, 1.0L, 2.0L, 3.0L}) {
      const Long q = n * pi * (1 + offset * long_epsilon);
      const auto z = Pendulum<Long>().exact({q}, {0}, 0.5L);
      EXPECT_TRUE(within(z->q[0], q, 16 * std::fabs(q) * long_epsilon)) << n << ", " << offset;
      EXPECT_TRUE(within(z->p[0], 0, 16 * std::fabs(q) * long_epsilon)) << n << ", " << offset;
    }
  }
}

TEST(ExactInTime, PendulumHasItsPeriods) {
  const Pendulum<Long> one;
  const Long amplitude = 2.5L;
  const Long libration = 4 * complete_k(std::sin(amplitude / 2) * std::sin(amplitude / 2));
  const auto z = one.exact({amplitude}, {0}, 50 * libration);
  const Long phase = 4 * 50 * libration * long_epsilon;
  EXPECT_TRUE(within(z->q[0], amplitude, phase));
  EXPECT_TRUE(within(z->p[0], 0, phase));
  EXPECT_TRUE(within(one.exact({amplitude}, {0}, libration / 2)->q[0], -amplitude, phase));
  // Rotation with p = 3 at the bottom: k^2 = 9/4, a turn takes (2/k) K(1/k^2), and q is not wrapped.
  const Long turn = 2 / 1.5L * complete_k(4 / 9.0L);
  EXPECT_TRUE(within(one.exact({0}, {3}, 1000 * turn)->q[0], 2000 * pi, 8 * 2000 * pi * long_epsilon));
  EXPECT_TRUE(within(one.exact({0}, {-3}, 1000 * turn)->q[0], -2000 * pi, 8 * 2000 * pi * long_epsilon));
}

TEST(ExactInTime, PendulumConservesEnergyNearTheSeparatrix) {
  const Pendulum<Long> one;
  for (const Long off : {1e-3L, 1e-9L, 1e-15L, -1e-15L, -1e-9L, -1e-3L}) {
    const Start1 start{{0}, {2 + off}};
    for (Long t = -60; t <= 60; t += 1.7L) {
      const auto z = one.exact(start.q, start.p, t);
      EXPECT_TRUE(within(energy(one, z->q, z->p), energy(one, start.q, start.p), 32 * long_epsilon));
      // There and back. Passing near the unstable rest turns roundings of the phase into e^t times themselves at most,
      // up to the time ln(4/sqrt m1) that the passage takes.
      const auto home = one.exact(z->q, z->p, -t);
      const Long grown = larger(Long(1), 16 / std::fabs(off));
      EXPECT_TRUE(within(home->q[0], 0, 64 * (1 + std::fabs(t)) * grown * long_epsilon)) << static_cast<double>(t);
    }
  }
}

TEST(ExactInTime, TheCheckNoticesAnotherPendulum) {
  struct Slightly : Pendulum<Long> {
    Slightly() = default;
    std::optional<Start1> exact(const Vector<Long, 1>& q, const Vector<Long, 1>& p, Long t) const {
      return Pendulum<Long>(1, 1, 1 + 1e-13L).exact(q, p, t);
    }
  };
  EXPECT_GT(distance_from_reference(Slightly(), Start1{{1}, {0.5L}}, 3.0L), reference_units);
  EXPECT_LE(distance_from_reference(Pendulum<Long>(), Start1{{1}, {0.5L}}, 3.0L), reference_units);
}

TEST(ExactInTime, HarmonicAndFreeFall) {
  for (std::uint64_t i = 0; i < 40; ++i) {
    const Start1 start{{3 * static_cast<Long>(counter_uniform(42, 3 * i))},
                       {3 * static_cast<Long>(counter_uniform(42, 3 * i + 1))}};
    const Long t = 9 * static_cast<Long>(counter_uniform(42, 3 * i + 2));
    EXPECT_LE(distance_from_reference(Harmonic<Long>(1.7L, 2.3L), start, t), reference_units);
    EXPECT_LE(distance_from_reference(Harmonic<Long>(1.7L, 0.0L), start, t), reference_units);
    EXPECT_LE(distance_from_reference(FreeFall<Long>(1.7L, 9.81L), start, t), reference_units);
    EXPECT_LE(distance_from_reference(FreeFall<Long>(0.3L, -2.0L), start, t), reference_units);
  }
  const auto thrown = FreeFall<Long>(2, 10).exact({5}, {40}, 2);  // v = 20: 5 + 40 - 20, 40 - 40
  EXPECT_EQ(thrown->q[0], 25);
  EXPECT_EQ(thrown->p[0], 0);
}

}  // namespace
}  // namespace hamflow
