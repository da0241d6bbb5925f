// Sums over every step that a simulation adds by itself have the bits of those that an observer of every step adds.
#include "hamflow/detail/run/step_sums.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "../support/walled_request.hpp"
#include "hamflow/formula/problem_texts.hpp"
#include "hamflow/run/observer.hpp"

namespace hamflow::test {
namespace {

/// Adds the values of expressions behind every step, as long as it is shown every step.
class AddsAll : public Observer {
 public:
  explicit AddsAll(const std::vector<NamedExpression>& expressions)
      : expressions_(expressions), sums_(expressions.size()) {}
  std::int64_t next_due(std::int64_t step) const override { return step; }
  Verdict observe(const Frame& frame) override {
    ++shown;
    if (frame.step <= reached) return Verdict::go_on;
    reached = frame.step;
    for (std::size_t i = 0; i < sums_.size() && frame.step > 0; ++i) sums_[i].add(expressions_[i].expression(frame));
    return Verdict::go_on;
  }
  std::vector<std::uint64_t> bits() const {
    std::vector<std::uint64_t> all(2 * sums_.size());
    std::memcpy(all.data(), sums_.data(), sums_.size() * sizeof(StepSum));
    return all;
  }
  std::int64_t shown = 0;
  std::int64_t reached = -1;

 protected:
  const std::vector<NamedExpression>& expressions_;
  std::vector<StepSum> sums_;
};

/// The same, which is content with sums.
class AddsOrIsSpared final : public AddsAll, public SummedSteps {
 public:
  using AddsAll::AddsAll;
  std::span<const NamedExpression> summed() const override { return expressions_; }
  std::span<StepSum> sums() override { return sums_; }
  void reach(const Frame& last) override { reached = last.step; }
};

/// Somebody else, who is shown every so many steps and asks how far the sums are.
class Beside final : public Observer {
 public:
  explicit Beside(const AddsAll& other) : other_(other) {}
  std::int64_t next_due(std::int64_t step) const override { return (step + 36) / 37 * 37; }
  Verdict observe(const Frame& frame) override {
    EXPECT_EQ(other_.reached, frame.step);
    return Verdict::go_on;
  }

 private:
  const AddsAll& other_;
};

std::vector<NamedExpression> expressions_of(const Request& request, const std::vector<std::string>& texts) {
  const auto problem_entry = find_problem(request);
  const ProblemEntry& problem = *problem_entry;
  std::vector<NamedExpression> all;
  for (const std::string& text : texts) {
    all.push_back(
        {text, StateExpression(text, problem, complete(problem.info, request.parameters), request.start.q.size())});
  }
  return all;
}

/// @param spared whether the simulation is expected to add by itself
void expect_same_sums(const Request& request, const std::vector<std::string>& texts, bool spared = true,
                      std::int64_t steps = 3000) {
  const std::vector<NamedExpression> expressions = expressions_of(request, texts);
  AddsAll all(expressions);
  AddsOrIsSpared some(expressions);
  Beside beside(some);
  const auto one = make_simulation(request), other = make_simulation(request);
  for (const std::int64_t to : {std::int64_t{5}, steps / 3, steps}) {  // each attaches and detaches
    Observer* const of_one[] = {&all};
    Observer* const of_other[] = {&some, &beside};
    const Outcome outcome = run(*one, to, of_one);
    ASSERT_EQ(run(*other, to, of_other), outcome);
    EXPECT_EQ(other->bits(), one->bits());
    if (request.watch) {
      EXPECT_EQ(other->energy().max_error, one->energy().max_error);
    }
    EXPECT_EQ(some.bits(), all.bits());
    EXPECT_EQ(some.reached, all.reached);
  }
  EXPECT_EQ(all.shown, all.reached + 3);  // the first of each of three runs again
  if (spared) {
    EXPECT_EQ(some.shown, 3);
  } else {
    EXPECT_EQ(some.shown, all.shown);
  }
}

const std::vector<std::string> of_tube{"p1^2/2", "atan2(q2, q1)", "exp(q1) - q2*p1"};

TEST(StepSums, HaveTheBitsOfAnObserverBehindWalls) {
  for (const WallRule rule : {WallRule::event, WallRule::mirror, WallRule::reject, WallRule::soft}) {
    for (const char* method : {"stv4", "verlet-dkd", "kahan-li8", "rk4"}) {
      for (const char* arithmetic : {"double", "compensated"}) {
        SCOPED_TRACE(wall_rules()[static_cast<std::size_t>(rule)] + ", " + method + ", " + arithmetic);
        Request request = t_tube(method, rule, "0.003");
        request.arithmetic = arithmetic;
        expect_same_sums(request, of_tube);
      }
    }
  }
}

TEST(StepSums, HaveThemWithoutLookingAtTheEnergy) {
  Request request = t_tube("stv4", WallRule::reject, "0.01");
  request.watch = false;
  expect_same_sums(request, of_tube);
}

FormulaTexts swing() {
  FormulaTexts texts;
  texts.coordinates = {"x"};
  texts.hamiltonian = "p_x^2/2 - cos(x)";
  return texts;
}
Request typed(const FormulaTexts& texts, const std::string& method, const std::string& q, const std::string& dt) {
  Request request{.problem = "formula", .variant = formula_choices(texts), .parameters = {}, .start = {}, .method = {}};
  request.start.q = {q};
  request.start.p = {"0.1"};
  request.method = parse_method(method);
  request.dt = dt;
  return request;
}

TEST(StepSums, HaveThemWithoutWalls) {
  expect_same_sums(typed(swing(), "stv4", "3", "0.05"), {"cos(x)", "p_x*x", "log(x - 3)"});  // the last is mostly none
  expect_same_sums(typed(swing(), "rk4", "1", "0.05"), {"x^2"});
}

TEST(StepSums, AreLeftToTheObserverWhereStepsCannotAdd) {
  expect_same_sums(typed(swing(), "stv4", "1", "0.05"), {"x*t"}, false, 500);
  expect_same_sums(typed(swing(), "cg(2)", "1", "0.05"), {"x^2"}, false, 300);
  Request request = typed(swing(), "stv4", "1", "0.05");
  request.arithmetic = "double-double";
  expect_same_sums(request, {"x^2"}, false, 300);
}

/// Of a run that fails the steps before the failure count, and no other.
TEST(StepSums, EndWithTheLastGoodStep) {
  FormulaTexts texts = swing();
  texts.hamiltonian = "p_x^2/2 - x^4/4";  // leaves for good in finite time
  const Request request = typed(texts, "stv4", "1", "0.001");
  const std::vector<NamedExpression> expressions = expressions_of(request, {"x"});
  AddsAll all(expressions);
  AddsOrIsSpared some(expressions);
  Observer* const of_one[] = {&all};
  Observer* const of_other[] = {&some};
  EXPECT_NE(run(*make_simulation(request), 100000, of_one), Outcome::done);
  EXPECT_NE(run(*make_simulation(request), 100000, of_other), Outcome::done);
  EXPECT_EQ(some.bits(), all.bits());
  EXPECT_EQ(some.reached, all.reached);
}

TEST(StepSums, ACopyAddsNothing) {
  const Request request = t_tube("stv4", WallRule::reject, "0.01");
  const std::vector<NamedExpression> expressions = expressions_of(request, {"p1^2/2"});
  const auto simulation = make_simulation(request);
  std::vector<StepSum> sums(1);
  ASSERT_TRUE(simulation->add_to_sums(expressions, sums));
  ASSERT_EQ(simulation->advance(1000), Outcome::done);
  const double before = sums[0].value();
  EXPECT_NE(before, 0);
  ASSERT_EQ(simulation->clone()->advance(1000), Outcome::done);
  EXPECT_EQ(sums[0].value(), before);
  ASSERT_TRUE(simulation->add_to_sums({}, {}));
  ASSERT_EQ(simulation->advance(1000), Outcome::done);
  EXPECT_EQ(sums[0].value(), before);
}

}  // namespace
}  // namespace hamflow::test
