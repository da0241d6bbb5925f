// rattle on the manifold, as `hamflow verify` measures it, and what happens without its velocity step.
#include "../support/bound_mass.hpp"
#include "hamflow/methods/rattle.hpp"
#include "mutants/examine.hpp"

namespace hamflow {
namespace {

using test::OnCircle;
using test::OnRods;

/// The catalogue's states for the same pendulum.
Region region_on_circle() { return region_of("pendulum", {{"coordinates", "cartesian"}}); }

/// RATTLE whose momentum is left as the last kick makes it: p1 is not along the manifold.
template <class P, class R>
class WithoutVelocityStep : public RattleEquations<P, R> {
  using Base = RattleEquations<P, R>;

 public:
  using typename Base::Point;
  using typename Base::Unknowns;
  using typename Base::V;
  using typename Base::Variables;
  static constexpr std::size_t n = P::dimension;
  WithoutVelocityStep(const typename Base::Setup& setup, const P& problem, const R& h, const V& q0, const V& p0,
                      Effort& effort)
      : Base(setup, problem, h, q0, p0, effort), problem_(problem), h_(h) {}

  Increment<R, n> taken(Variables&, const Point& at) const {
    V f = zeros_like(at.position);
    force(problem_, at.position, f);
    Increment<R, n> z{at.moved, at.impulse};
    for (std::size_t i = 0; i < n; ++i) z.p[i] += h_ / 2 * f[i];
    return z;
  }
  Increment<R, n> taken(Variables& lambda, const Point&, const Variables& correction) const {
    for (std::size_t k = 0; k < lambda.size(); ++k) lambda[k] += correction[k];
    Point end;
    end.linearised = false;
    this->evaluate(lambda, end);
    return taken(lambda, end);
  }
  Unknowns unknowns(const Variables& lambda, const Increment<R, n>& taken) const {
    Unknowns all(2 * (n + lambda.size()));
    for (std::size_t i = 0; i < n; ++i) {
      all[i] = taken.q[i];
      all[n + i] = taken.p[i];
    }
    for (std::size_t k = 0; k < lambda.size(); ++k) all[2 * n + k] = lambda[k];
    return all;
  }
  template <class S>
  Vector<S, dynamic> residual(const Vector<S, n>& q0, const Vector<S, n>& p0, const Vector<S, dynamic>& u) const {
    Vector<S, dynamic> r = Base::residual(q0, p0, u);
    const std::size_t count = u.size() / 2 - n;
    for (std::size_t k = 0; k < count; ++k) r[2 * n + count + k] = u[2 * n + count + k];  // mu = 0
    return r;
  }

 private:
  const P& problem_;
  R h_;
};

template <class P, Arithmetic A>
class MutantStep : public ImplicitMethod<P, A, WithoutVelocityStep<P, typename A::Real>> {
 public:
  using ImplicitMethod<P, A, WithoutVelocityStep<P, typename A::Real>>::ImplicitMethod;
  MethodInfo info() const { return describe(RattleOptions{}); }
};
struct MutantRattle {
  static constexpr bool implicit = true;
  static constexpr bool bijective = false;
  template <class P>
  static constexpr bool accepts = Rattle::accepts<P>;
  template <class P, class A>
  using Stepper = MutantStep<P, A>;
  template <class P, class A>
  Stepper<P, A> bind(const P& problem) const {
    return Stepper<P, A>(problem, NewtonOptions());
  }
};

template <class Recipe>
StepMapOf<OnCircle, Recipe> on_circle(const Recipe& recipe) {
  return StepMapOf<OnCircle, Recipe>([]<class R>() { return OnCircle<R>(); }, recipe);
}
/// What a run of the recipe leaves of g and of g' M^-1 p.
template <class Recipe>
std::pair<double, double> residuals_of(const Recipe& recipe) {
  const OnCircle<double> problem;
  auto run = simulate<false>(problem, recipe, Vector<double, 2>{0.8, -0.6}, Vector<double, 2>{0.3, 0.4}, 0.1);
  double position = 0;
  double velocity = 0;
  for (int k = 0; k < 100; ++k) {
    EXPECT_EQ(run.advance(1), Outcome::done);
    const auto q = run.state().positions();
    position = std::max(position, std::abs(constraints(problem, q)[0]));
    velocity = std::max(velocity, std::abs(2 * dot(q, run.state().momenta())));
  }
  return {position, velocity};
}

TEST(ConstraintMutant, WithoutTheVelocityStep) {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  // The sound one first.
  EXPECT_LE(residuals_of(Rattle{}).first, 16 * epsilon);
  EXPECT_LE(residuals_of(Rattle{}).second, 16 * epsilon);
  const auto [position, velocity] = residuals_of(MutantRattle{});
  EXPECT_LE(position, 16 * epsilon);  // the position's multipliers are there
  EXPECT_GT(velocity, 1e-3);

  const auto order = [](const StepMap& map) { return measure_order(map, region_on_circle()).slope; };
  EXPECT_NEAR(order(on_circle(Rattle{})), 2, 0.15);
  EXPECT_NEAR(order(on_circle(MutantRattle{})), 1, 0.15);
  // Nor is it symmetric. It does stay symplectic: what is missing in p1 is a multiple of g', which the form on the
  // manifold does not see.
  const auto way_back = [](const StepMap& map) {
    const State<double> start = random_state(region_on_circle(), 0);
    State<double> z = start;
    EXPECT_TRUE(map.advance(z, 0.1, 1));
    EXPECT_TRUE(map.advance(z, -0.1, 1));
    double most = 0;
    for (std::size_t i = 0; i < z.size(); ++i) most = std::max(most, std::abs(z[i] - start[i]));
    return most;
  };
  EXPECT_LE(way_back(on_circle(Rattle{})), 16 * epsilon);
  EXPECT_GT(way_back(on_circle(MutantRattle{})), 1e-3);
}

TEST(Constraints, SymplecticAlongTheManifoldOnly) {
  const auto map = on_circle(Rattle{});
  const State<double> z{0.8, -0.6, 0.3, 0.4};
  const auto m = map.jacobian(z, 0.1);
  // Of all of space the map loses dimensions: its derivative is singular, M^T J M is not J.
  double across = 0;
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = 0; b < 4; ++b) {
      double value = a == b + 2 ? 1 : b == a + 2 ? -1 : 0;
      for (std::size_t i = 0; i < 2; ++i) value += m[i][a] * m[2 + i][b] - m[2 + i][a] * m[i][b];
      across = std::max(across, std::abs(value));
    }
  }
  EXPECT_GT(across, 0.1);
  const auto directions = map.directions(z);
  ASSERT_EQ(directions.size(), 2u);
  double along = 0;
  const auto product = [&](const State<double>& x, const State<double>& y) {
    return x[0] * y[2] + x[1] * y[3] - x[2] * y[0] - x[3] * y[1];
  };
  State<double> moved[2];
  for (int k = 0; k < 2; ++k) {
    for (std::size_t i = 0; i < 4; ++i) {
      moved[k].push_back(0);
      for (std::size_t j = 0; j < 4; ++j) moved[k][i] += m[i][j] * directions[static_cast<std::size_t>(k)][j];
    }
  }
  along = std::abs(product(moved[0], moved[1]) - product(directions[0], directions[1]));
  EXPECT_LE(along, 64 * std::numeric_limits<double>::epsilon());
}

}  // namespace
}  // namespace hamflow
