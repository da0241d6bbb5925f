// Tangent vectors through bounces: against divided differences of the steps, where the derivative is known in closed
// form, and against a mutant that leaves the saltation matrix out.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "../support/walled_request.hpp"
#include "hamflow/detail/verify/lyapunov.hpp"
#include "hamflow/formula/problem_texts.hpp"
#include "hamflow/numerics/elimination.hpp"
#include "hamflow/verify/measure.hpp"
#include "verify/monodromy.hpp"

namespace hamflow::test {
namespace {

using Rows = std::vector<std::vector<double>>;
constexpr double epsilon = std::numeric_limits<double>::epsilon();

std::unique_ptr<StepMap> map_of(const Request& request) {
  const auto problem_entry = find_problem(request);
  const ProblemEntry& problem = *problem_entry;
  Request full = request;
  full.parameters = complete(problem.info, request.parameters);
  return problem.step_map(full, problem.dimension);
}

Request formula_request(std::vector<std::string> coordinates, const std::string& hamiltonian) {
  FormulaTexts texts;
  texts.coordinates = std::move(coordinates);
  texts.hamiltonian = hamiltonian;
  return {.problem = "formula", .variant = formula_choices(texts), .parameters = {}, .start = {}, .method = {}};
}

Request with_method(Request request, const char* method) {
  request.method = parse_method(method);
  return request;
}

/// (Psi^steps(z + d e_j) - Psi^steps(z - d e_j))/(2 d) in quad: its error is some d^2 Psi'''/6 = 2^-70, its rounding
/// 2^-112/d = 2^-77, both of the size of the terms.
Rows differences(const StepMap& map, const State<double>& z, double h, std::int64_t steps) {
  const Quad d(0x1p-35);
  Rows rows(z.size(), std::vector<double>(z.size()));
  for (std::size_t j = 0; j < z.size(); ++j) {
    State<Quad> plus(z.begin(), z.end());
    State<Quad> minus = plus;
    plus[j] += d;
    minus[j] -= d;
    EXPECT_TRUE(map.advance(plus, Quad(h), steps) && map.advance(minus, Quad(h), steps));
    for (std::size_t i = 0; i < z.size(); ++i) rows[i][j] = static_cast<double>((plus[i] - minus[i]) / (Quad(2) * d));
  }
  return rows;
}

double norm(const Rows& rows) {
  double largest = 0;
  for (const auto& row : rows) {
    double sum = 0;
    for (const double x : row) sum += std::abs(x);
    largest = std::max(largest, sum);
  }
  return largest;
}

/// The largest difference of two matrices in units of rounding.
double apart(const Rows& a, const Rows& b) {
  double largest = a.size() == b.size() ? 0 : std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    for (std::size_t j = 0; j < a.size(); ++j) largest = std::max(largest, std::abs(a[i][j] - b[i][j]));
  }
  return largest / (epsilon * norm(b));
}

/// A step crosses the wall of q1 here, whatever the rule.
const State<double> at_the_wall{0.95, 1.1, 6, 100};

class TangentsAtWalls : public ::testing::TestWithParam<MethodAtWalls> {};

/// Rounding of the bounce's time by 2 epsilon h, and the second derivatives of the flight, are the terms beyond those
/// of the steps.
TEST_P(TangentsAtWalls, AreTheDerivative) {
  const auto [method, rule] = GetParam();
  const auto map = map_of(t_tube(method, rule, "0.01"));
  // Through a soft wall no step may go: slowly towards it, and back.
  const State<double> start = rule == WallRule::soft ? State<double>{0.8, 1.1, 0.5, 10} : at_the_wall;
  State<double> z = start;
  for (const double h : {0.02, -0.02}) {  // backwards from the state that was thrown back
    EXPECT_LE(apart(map->jacobian(z, h), differences(*map, z, h, 1)), 16) << h;
    ASSERT_TRUE(map->advance(z, h, 1));
  }
  // Some bounces later the two differ by what each step makes of the roundings before it.
  EXPECT_LE(apart(derivative_of_steps(*map, start, 0.02, 60), differences(*map, start, 0.02, 60)), 64);
}
INSTANTIATE_TEST_SUITE_P(
    Walls, TangentsAtWalls,
    ::testing::Values(MethodAtWalls{"verlet", WallRule::event}, MethodAtWalls{"stv4", WallRule::event},
                      MethodAtWalls{"rkn8-s19", WallRule::event}, MethodAtWalls{"cg(2,auto)", WallRule::event},
                      MethodAtWalls{"cg(1,3)", WallRule::event}, MethodAtWalls{"gauss(2)", WallRule::event},
                      MethodAtWalls{"rk4", WallRule::event}, MethodAtWalls{"stv4", WallRule::mirror},
                      MethodAtWalls{"chin4a", WallRule::mirror}, MethodAtWalls{"stv4", WallRule::reject},
                      MethodAtWalls{"cg(1,3)", WallRule::reject}, MethodAtWalls{"stv4", WallRule::soft}),
    [](const auto& each) { return name_of(each.param); });

/// Where M^-1 is full and depends on q, and where T is not quadratic, the momentum behind a bounce depends on the whole
/// state.
TEST(Walls, TangentsOfAnyReflection) {
  Request pendulum{.problem = "double-pendulum",
                   .variant = {{"model", "nonlinear"}, {"angles", "absolute"}},
                   .parameters = {},
                   .start = {},
                   .method = {}};
  const Request bent = formula_request({"x", "y"}, "exp(p_x) - p_x + p_x*p_y/5 + p_y^2/2 + x*y/3");
  for (const WallRule rule : {WallRule::event, WallRule::reject}) {
    for (const char* method : {"cg(1,auto)", "rk4", "gauss(3)"}) {
      SCOPED_TRACE(method + (" " + wall_rules()[static_cast<std::size_t>(rule)]));
      const auto full = map_of(with_method(behind_walls(pendulum, {{"q1", 0, "", "0.6"}}, rule), method));
      const State<double> z{0.58, 0.8, 4, 1};
      EXPECT_LE(apart(full->jacobian(z, 0.05), differences(*full, z, 0.05, 1)), 16);
      const auto other = map_of(with_method(behind_walls(bent, {{"x", 0, "", "0.5"}}, rule), method));
      const State<double> w{0.49, 0.1, 1, 0.3};
      EXPECT_LE(apart(other->jacobian(w, 0.02), differences(*other, w, 0.02, 1)), 16);
    }
  }
}

/// What a tolerance leaves of Newton's residual is no part of the derivative by the length of a flight.
TEST(Walls, ToleranceAndTangents) {
  const auto exact = map_of(t_tube("cg(1,3)", WallRule::event, "0.01"));
  for (const char* method : {"cg(1,3,tolerance=1e-8)", "cg(1,3,criterion=seed,tolerance=1e-10)"}) {
    const auto map = map_of(t_tube(method, WallRule::event, "0.01"));
    EXPECT_LE(apart(map->jacobian(at_the_wall, 0.02), exact->jacobian(at_the_wall, 0.02)), 1e-8 / epsilon) << method;
  }
}

/// A free particle between walls: unfolded, it goes straight on, dPsi^n = (-1)^bounces (1, t; 0, 1). Exponents of such
/// a billiard are 0.
TEST(Walls, TangentsOfABilliard) {
  for (const WallRule rule : {WallRule::event, WallRule::mirror}) {
    const auto map = map_of(with_method(
        behind_walls(formula_request({"x", "y"}, "(p_x^2 + p_y^2)/2"), {{"x", 0, "-1", "1"}, {"y", 1, "0", "1"}}, rule),
        "verlet"));
    constexpr double h = 0.25;
    constexpr std::int64_t steps = 1000;
    const State<double> start{0.1, 0.3, 0.7, 0.454};
    const Rows rows = derivative_of_steps(*map, start, h, steps);
    const double t = h * steps;
    // q stands at 175.1 and 113.8 then, behind 88 and 113 walls.
    const Rows expected{{1, 0, t, 0}, {0, -1, 0, -t}, {0, 0, 1, 0}, {0, 0, 0, -1}};
    // Each of 201 bounces rounds the derivative once.
    EXPECT_LE(apart(rows, expected), 201);
    const LyapunovSpectrum spectrum = lyapunov_spectrum(*map, start, h, steps);
    for (const double exponent : spectrum.exponents) EXPECT_LE(std::abs(exponent), 2 * std::log(t) / t);
  }
}

/// What a bounce would be without the derivative of its time.
class WithoutSaltation final : public StepMap {
 public:
  WithoutSaltation(std::unique_ptr<StepMap> walled, std::unique_ptr<StepMap> free, Request request)
      : walled_(std::move(walled)), free_(std::move(free)), request_(std::move(request)) {}
  std::size_t dimension() const override { return walled_->dimension(); }
  MethodInfo claims() const override { return walled_->claims(); }
  bool advance(State<double>& z, double h, std::int64_t steps) const override { return walled_->advance(z, h, steps); }
  bool advance(State<long double>& z, long double h, std::int64_t steps) const override {
    return walled_->advance(z, h, steps);
  }
  bool advance(State<Quad>& z, const Quad& h, std::int64_t steps) const override {
    return walled_->advance(z, h, steps);
  }
  std::vector<std::vector<double>> jacobian(const State<double>& z, double h) const override {
    Request request = request_;
    for (std::size_t i = 0; i < 4; ++i) (i < 2 ? request.start.q : request.start.p).push_back(shortest(z[i]));
    request.dt = shortest(h);
    const auto run = make_simulation(request);
    Bounce met;
    run->on_bounce([&](const Bounce& bounce) { met = bounce; });
    (void)run->advance(1);
    std::vector<State<double>> columns(4, State<double>(4));
    for (std::size_t k = 0; k < 4; ++k) columns[k][k] = 1;
    State<double> there = z;
    (void)free_->advance_with_tangents(there, columns, met.time, 1);
    for (auto& column : columns) column[2 + met.coordinate] = -column[2 + met.coordinate];
    there = {met.q[0], met.q[1], met.p[0], met.p[1]};
    (void)free_->advance_with_tangents(there, columns, h - met.time, 1);
    Rows rows(4, std::vector<double>(4));
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t k = 0; k < 4; ++k) rows[i][k] = columns[k][i];
    }
    return rows;
  }
  std::vector<double> energies(const State<double>& z, double h, int blocks, std::int64_t steps) const override {
    return walled_->energies(z, h, blocks, steps);
  }
  double energy_scale(const State<double>& z) const override { return walled_->energy_scale(z); }
  Effort cost(const State<double>& z, double h, std::int64_t steps) const override {
    return walled_->cost(z, h, steps);
  }
  State<long double> flow(const State<long double>& z, long double t) const override { return walled_->flow(z, t); }
  bool advance_with_tangents(State<double>&, std::vector<State<double>>&, double, std::int64_t) const override {
    return false;
  }

 private:
  std::unique_ptr<StepMap> walled_, free_;
  Request request_;
};

TEST(Walls, ASaltationMatrixThatIsLeftOutIsCaught) {
  const Request request = t_tube("stv4", WallRule::event, "0.01");
  Request bare = request;
  bare.start.q.clear();
  bare.start.p.clear();
  Request free = request;
  free.walls.reset();
  const WithoutSaltation mutant(map_of(request), map_of(free), bare);
  const Rows exact = differences(mutant, at_the_wall, 0.02, 1);
  EXPECT_LE(apart(map_of(request)->jacobian(at_the_wall, 0.02), exact), 16);
  EXPECT_GE(apart(mutant.jacobian(at_the_wall, 0.02), exact), 0x1p40);
}

double determinant(const Rows& rows) {
  std::vector<double> m;
  for (const auto& row : rows) m.insert(m.end(), row.begin(), row.end());
  return detail::eliminate<double>(m.data(), nullptr, rows.size(), 0);
}

/// What a step of length h with a bounce does to volume, at the worst of some states, and how far S Psi S Psi z is off.
std::pair<double, double> volume_and_return(const char* method, WallRule rule, double h) {
  const auto map = map_of(t_tube(method, rule, "0.01"));
  double volume = 0;
  double off = 0;
  for (int k = 0; k < 12; ++k) {
    const double part = (k + 0.5) / 12;  // of the step, behind which it meets the wall
    const State<double> z{1 - (4 + k % 3) * h * part, 0.5 + 0.1 * k, 4.0 + k % 3, k % 2 == 0 ? 60.0 : -80.0};
    volume = std::max(volume, std::abs(std::abs(determinant(differences(*map, z, h, 1))) - 1));
    State<Quad> there(z.begin(), z.end());
    for (int way = 0; way < 2; ++way) {
      EXPECT_TRUE(map->advance(there, Quad(h), 1));
      for (std::size_t i = 2; i < 4; ++i) there[i] = -there[i];
    }
    for (std::size_t i = 0; i < 4; ++i) {
      off = std::max(off, std::abs(static_cast<double>((there[i] - Quad(z[i])) / (Quad(1) + Quad(std::abs(z[i]))))));
    }
  }
  return {volume, off};
}

/// A mirror and a rejection keep volume, a located bounce as far as the method is the flow; what is located or mirrored
/// comes back.
TEST(Walls, VolumeAndReturnOfAStep) {
  constexpr double quad_epsilon = 0x1p-112;
  for (const WallRule rule : {WallRule::mirror, WallRule::reject}) {
    EXPECT_LE(volume_and_return("stv4", rule, 0.02).first, 16 * epsilon);
  }
  EXPECT_LE(volume_and_return("stv4", WallRule::mirror, 0.02).second, 64 * quad_epsilon);
  for (const auto& [method, order] : {std::pair{"verlet", 2}, std::pair{"stv4", 4}}) {
    const auto [coarse, off] = volume_and_return(method, WallRule::event, 0.002);
    const auto [fine, off_fine] = volume_and_return(method, WallRule::event, 0.0005);
    EXPECT_LE(std::max(off, off_fine), 64 * quad_epsilon) << method;
    EXPECT_NEAR(std::log2(coarse / fine) / 2, order, 0.5) << method;
  }
}

/// The second region of the T-tube: the reference flow locates its bounces, too.
TEST(Walls, AStepThroughAWallIsWhatIsClaimed) {
  const auto region = region_at_walls("t-tube");
  ASSERT_TRUE(region);
  const PropertyRow row = measure_at_walls(parse_method("stv4"), *region);
  EXPECT_TRUE(row.agrees()) << row.differing();
  EXPECT_EQ(row["order"].claimed, "4");
  EXPECT_EQ(row["symplectic"].measured, "no");
  EXPECT_EQ(row["Jacobian is the step's"].measured, "yes");
  EXPECT_FALSE(region_at_walls("pendulum"));
}

}  // namespace
}  // namespace hamflow::test
