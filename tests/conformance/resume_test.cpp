// A run that is saved and restored goes on bit for bit; a look ahead is a partial step of the method and changes
// nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <iostream>
#include <set>

#include "../support/measured_request.hpp"
#include "hamflow/arithmetic/lattice.hpp"
#include "hamflow/detail/core/archive.hpp"
#include "hamflow/detail/run/splitting_named.hpp"
#include "hamflow/methods/splitting.hpp"
#include "hamflow/methods/tableaus/rk4.hpp"
#include "hamflow/problems/pendulum.hpp"
#include "hamflow/run/catalog.hpp"
#include "hamflow/run/observer.hpp"
#include "hamflow/run/simulation_of.hpp"

namespace hamflow {
namespace {

const std::string with_everything = "cg(diagnostics=true,on_divergence=halve)";
const std::string of_any_length = "verlet(step_control=reversible)";
const std::string of_degree = "cg(2,auto,diagnostics=true,on_divergence=halve)";

/// One method of each kind of memory.
bool is_of_each_kind(const std::string& name) {
  static const std::set<std::string> each{"verlet",        "euler-b", "chin4a", "rk4",    "boris", "cg",
                                          with_everything, of_degree, "dop853", "taylor", "tao4",  of_any_length};
  return each.contains(name);
}

/// Every method and arithmetic on every problem, with what cg remembers beyond a plain step.
std::vector<Request> every_request() {
  std::vector<std::string> names{"cg(quadrature=5,tolerance=1e-13)",
                                 with_everything,
                                 of_degree,
                                 "gauss(3,iteration=fixed-point)",
                                 of_any_length,
                                 "stv4-dkd(step_control=reversible,monitor=distance)",
                                 "cg(1,auto,step_control=reversible)",
                                 "tao2(step_control=reversible)"};
  for (const MethodEntry& entry : methods()) {
    // Tables differ in their coefficients, which are no state.
    if (!splitting_named(entry.name) || is_of_each_kind(entry.name)) names.push_back(entry.name);
  }
  std::vector<Request> all;
  for (const ProblemEntry& problem : problems()) {
    Request request = test::measured_request(problem);
    const std::size_t size = request.start.q.size();
    for (const std::string& name : names) {
      request.method = parse_method(name);
      if (!refusal(request.method, problem).empty() || !test::is_bound(request.method, problem)) continue;
      for (const std::string& listed : arithmetics()) {
        const std::string arithmetic = listed == "mp(d)" ? "mp(40)" : listed;
        if (!refusal(request.method, arithmetic).empty()) continue;
        const bool slow = digits_beyond_double(arithmetic) > 0;
        if (slow && (size > 4 || !is_of_each_kind(name))) continue;  // alike
        request.method = test::with_few_sub_steps(parse_method(name), arithmetic);
        request.arithmetic = arithmetic;
        request.watch = true;
        all.push_back(request);
        if (arithmetic == "double") {
          request.watch = false;
          all.push_back(request);
        }
      }
    }
  }
  return all;
}

std::string label(const Request& request) {
  return describe(request.method).name + " on " + request.problem + " in " + request.arithmetic;
}

TEST(Resume, ARestoredSimulationGoesOnBitForBit) {
  std::size_t pairs = 0;
  for (const Request& request : every_request()) {
    SCOPED_TRACE(label(request));
    const bool slow = digits_beyond_double(request.arithmetic) > 0;
    const int before = slow ? 7 : 137;
    const int after = slow ? 9 : 163;
    const auto whole = make_simulation(request);
    ASSERT_EQ(whole->advance(before), Outcome::done);
    const auto saved = whole->save();
    EXPECT_EQ(whole->save(), saved);
    const auto copy = whole->clone();
    ASSERT_EQ(whole->advance(after), Outcome::done);

    const auto resumed = make_simulation(request);
    EXPECT_NE(resumed->save(), saved);
    resumed->restore(saved);
    EXPECT_EQ(resumed->save(), saved);
    EXPECT_EQ(resumed->step(), before);
    ASSERT_EQ(resumed->advance(after), Outcome::done);
    // save() holds state, clock, counters, probe and memory; bits and times are compared for their own sake.
    EXPECT_EQ(resumed->save(), whole->save());
    EXPECT_EQ(resumed->bits(), whole->bits());
    EXPECT_EQ(resumed->energy().max_error, whole->energy().max_error);
    EXPECT_EQ(resumed->energy().initial, whole->energy().initial);
    EXPECT_EQ(resumed->energy_scale(), whole->energy_scale());
    EXPECT_EQ(resumed->effort().force, whole->effort().force);
    EXPECT_EQ(resumed->effort().linear_solves, whole->effort().linear_solves);
    EXPECT_EQ(resumed->effort().solves_max, whole->effort().solves_max);
    ASSERT_EQ(copy->advance(after), Outcome::done);
    EXPECT_EQ(copy->save(), whole->save());
    ++pairs;
  }
  std::cout << pairs << " pairs of method and arithmetic on a problem\n";
}

TEST(Resume, ReversedTimeAndNegatedMomentaAreSaved) {
  Request request = every_request().front();
  const auto whole = make_simulation(request);
  (void)whole->advance(50);
  whole->reverse_time();
  (void)whole->advance(20);
  whole->negate_momenta();
  const auto resumed = make_simulation(request);
  resumed->restore(whole->save());
  Frame a;
  Frame b;
  ASSERT_EQ(whole->advance(40), Outcome::done);
  ASSERT_EQ(resumed->advance(40), Outcome::done);
  whole->look(a);
  resumed->look(b);
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.step, 110);
  EXPECT_EQ(b.step, 110);
  EXPECT_EQ(whole->bits(), resumed->bits());
}

/// The fall of cg into halved steps, with the counter of events.
TEST(Resume, HalvedStepsAreSaved) {
  Request request;
  request.problem = "central-force";
  request.variant = {{"potential", "kepler"}, {"coordinates", "cartesian"}};
  request.start.q = {"1", "0"};
  request.start.p = {"0", "0.3"};
  request.method = parse_method(with_everything);
  request.dt = "0.3";
  const auto whole = make_simulation(request);
  const auto resumed = make_simulation(request);
  for (int i = 0; i < 60; ++i) {
    ASSERT_EQ(whole->advance(1), Outcome::done) << i << whole->failure();
    resumed->restore(whole->save());
    const auto from_here = make_simulation(request);
    from_here->restore(whole->save());
    ASSERT_EQ(resumed->advance(1), Outcome::done);
    const auto ahead = whole->clone();
    ASSERT_EQ(ahead->advance(1), Outcome::done);
    ASSERT_EQ(resumed->save(), ahead->save());
  }
  EXPECT_GT(whole->effort().halved, 0) << "the test has to meet halved steps";
  const StepDiagnostics a = whole->diagnostics();
  resumed->restore(whole->save());
  const StepDiagnostics b = resumed->diagnostics();
  EXPECT_EQ(a.of_condition_tangent.most, b.of_condition_tangent.most);
  EXPECT_EQ(a.of_condition_tangent.step_of_most, b.of_condition_tangent.step_of_most);
}

TEST(Resume, WhatDoesNotFitIsRefusedAndChangesNothing) {
  Request request;
  request.problem = "pendulum";
  request.start.q = {"1"};
  request.start.p = {"0.5"};
  const auto stv4 = make_simulation(request);
  (void)stv4->advance(10);
  const auto saved = stv4->save();
  const auto expect_refused = [&](Request other) {
    const auto simulation = make_simulation(other);
    const auto before = simulation->save();
    EXPECT_THROW(simulation->restore(saved), Error);
    EXPECT_EQ(simulation->save(), before);
  };
  Request other = request;
  other.method = parse_method("verlet");
  expect_refused(other);
  other = request;
  other.arithmetic = "compensated";
  expect_refused(other);
  other = request;
  other.dt = "0.2";
  expect_refused(other);
  other = request;
  other.problem = "duffing";
  expect_refused(other);
  const auto simulation = make_simulation(request);
  const auto before = simulation->save();
  for (std::size_t size = 0; size < saved.size(); ++size) {
    EXPECT_THROW(simulation->restore(std::span(saved).first(size)), Error) << size;
    EXPECT_EQ(simulation->save(), before);
  }
  auto longer = saved;
  longer.push_back(std::byte{0});
  EXPECT_THROW(simulation->restore(longer), Error);
  EXPECT_EQ(simulation->save(), before);
}

TEST(Resume, LongDoubleIsSavedWithoutItsPadding) {
  using Hand = RungeKuttaBy<tableaus::rk4>;
  const Pendulum<long double> pendulum;
  const auto make = [&] { return simulate<true, Pendulum<long double>, Hand>(pendulum, {}, {1.0L}, {0.5L}, 0.1L); };
  auto a = make();
  auto b = make();
  (void)a.advance(100);
  for (int i = 0; i < 100; ++i) (void)b.advance(1);
  EXPECT_EQ(a.save(), b.save());
  auto c = make();
  c.restore(a.save());
  (void)a.advance(10);
  (void)c.advance(10);
  EXPECT_EQ(a.save(), c.save());
}

TEST(LookAhead, ChangesNothing) {
  for (const Request& request : every_request()) {
    SCOPED_TRACE(label(request));
    const auto observed = make_simulation(request);
    ASSERT_EQ(observed->advance(20), Outcome::done);
    const auto before = observed->save();
    const double h = evaluate_number<double>(request.dt);
    Frame ahead;
    ASSERT_EQ(observed->look_ahead(shortest(20.25 * h), ahead), Outcome::done);
    EXPECT_EQ(observed->save(), before);
    EXPECT_EQ(ahead.step, 20);
    EXPECT_NEAR(ahead.time, 20.25 * h, 40 * h * 0x1p-52);  // the text is rounded to double
    Frame now;
    observed->look(now);
    EXPECT_NE(ahead.q, now.q);
    EXPECT_EQ(ahead.effort.force, now.effort.force);
    EXPECT_EQ(ahead.effort.linear_solves, now.effort.linear_solves);
    // A step's own time gives that step's state; of steps of varying size it is no multiple of dt.
    if (observed->method().varies_steps) continue;
    ASSERT_EQ(observed->look_ahead("20*(" + request.dt + ")", ahead), Outcome::done);
    EXPECT_EQ(ahead.q, now.q);
    EXPECT_EQ(ahead.p, now.p);
    EXPECT_EQ(ahead.time, now.time);
  }
}

TEST(LookAhead, IsOneStepOfTheMethodWithAShorterStepLength) {
  for (const Request& request : every_request()) {
    SCOPED_TRACE(label(request));
    for (const char* theta : {"1/3", "0.9"}) {
      const std::string time = "(" + request.dt + ")*" + theta;
      const auto simulation = make_simulation(request);
      Frame ahead;
      ASSERT_EQ(simulation->look_ahead(time, ahead), Outcome::done);
      Request shorter = request;
      shorter.dt = time;
      const auto fresh = make_simulation(shorter);
      ASSERT_EQ(fresh->advance(1), Outcome::done);
      Frame step;
      fresh->look(step);
      EXPECT_EQ(ahead.q, step.q);
      EXPECT_EQ(ahead.p, step.p);
      EXPECT_EQ(ahead.energy, step.energy);
      EXPECT_EQ(ahead.time, step.time);
      EXPECT_EQ(ahead.invariants, step.invariants);
    }
  }
}

/// The sample at t_n + theta h has the order of the method, from the state of the run and not from its start.
TEST(LookAhead, LiesOnTheOrbit) {
  Request request;
  request.problem = "pendulum";
  request.start.q = {"1"};
  request.start.p = {"0.5"};
  request.method = parse_method("stv4");
  request.dt = "0.1";
  Request fine = request;
  fine.dt = "0.0001";
  const auto coarse = make_simulation(request);
  const auto reference = make_simulation(fine);
  ASSERT_EQ(coarse->advance(73), Outcome::done);
  ASSERT_EQ(reference->advance(73437), Outcome::done);
  Frame wanted;
  Frame ahead;
  reference->look(wanted);
  ASSERT_EQ(coarse->look_ahead("7.3437", ahead), Outcome::done);
  Frame at_step;
  coarse->look(at_step);
  reference->restore(make_simulation(fine)->save());
  ASSERT_EQ(reference->advance(73000), Outcome::done);
  Frame wanted_at_step;
  reference->look(wanted_at_step);
  // The partial step adds less than a whole one to the global error of 73; three times it, for the phase of the orbit.
  const double error_at_step = std::hypot(at_step.q[0] - wanted_at_step.q[0], at_step.p[0] - wanted_at_step.p[0]);
  EXPECT_LT(std::hypot(ahead.q[0] - wanted.q[0], ahead.p[0] - wanted.p[0]), 3 * error_at_step);
  EXPECT_GT(error_at_step, 1e-9);  // else rounding, not the method, would be compared
}

class AtTimes final : public Observer {
 public:
  std::int64_t next_due(std::int64_t step) const override { return step <= 3 ? 3 : never; }
  std::span<const std::string> times(std::int64_t) const override { return wanted; }
  Verdict observe(const Frame& frame) override {
    seen.push_back(frame.time);
    return Verdict::go_on;
  }
  std::vector<std::string> wanted{"0.3", "0.31", "0.1*3.9"};
  std::vector<double> seen;
};

TEST(LookAhead, ServesObserversAndDoesNotChangeABit) {
  Request request;
  request.problem = "pendulum";
  request.start.q = {"1"};
  request.start.p = {"0.5"};
  const auto observed = make_simulation(request);
  const auto alone = make_simulation(request);
  AtTimes times;
  Observer* const observers[] = {&times};
  ASSERT_EQ(run(*observed, 100, observers), Outcome::done);
  ASSERT_EQ(alone->advance(100), Outcome::done);
  EXPECT_EQ(observed->save(), alone->save());
  EXPECT_EQ(times.seen, (std::vector<double>{3 * 0.1, 0.31, 0.1 * 3.9}));
}

struct Everything {
  double x = 0.1;
  long double y = 1.0L / 3;
  bool flag = true;
  Outcome outcome = Outcome::stopped;
  std::string text = "a text";
  std::vector<std::vector<int>> lists{{1, 2}, {}, {3}};
  std::array<float, 2> pair{1, 2};
  short row[3] = {1, -2, 3};
  std::optional<double> set = 4.0;
  std::optional<double> unset;
  Vector<double, 2> fixed{5, 6};
  Vector<double, dynamic> free{7, 8, 9};
  Matrix<double, dynamic> matrix = Matrix<double, dynamic>(2);
  NoProbe nothing;

  template <class Archive>
  void archive(Archive& ar) {
    ar(x, y, flag, outcome, text, lists, pair, row, set, unset, fixed, free, matrix, nothing);
  }
};

TEST(Archive, EveryKindOfFieldComesBack) {
  Everything out;
  out.x = std::nan("");
  out.matrix[1][0] = 10;
  Writer writer;
  writer(out);
  Everything in;
  in.set.reset();
  in.unset = 1;
  in.lists.clear();
  in.flag = false;
  in.outcome = Outcome::done;
  in.text.clear();
  in.y = 0;
  in.row[1] = 0;
  in.fixed[0] = 0;
  in.free = Vector<double, dynamic>(1);
  in.matrix = Matrix<double, dynamic>(1);
  Reader reader(writer.bytes());
  reader(in);
  reader.finish();
  EXPECT_TRUE(std::isnan(in.x));
  EXPECT_EQ(in.y, out.y);
  EXPECT_TRUE(in.flag);
  EXPECT_EQ(in.outcome, out.outcome);
  EXPECT_EQ(in.text, out.text);
  EXPECT_EQ(in.lists, out.lists);
  EXPECT_EQ(in.pair, out.pair);
  EXPECT_EQ(in.row[1], -2);
  EXPECT_EQ(in.set, out.set);
  EXPECT_FALSE(in.unset);
  EXPECT_EQ(in.fixed, out.fixed);
  EXPECT_EQ(in.free, out.free);
  EXPECT_EQ(in.matrix, out.matrix);
  Writer again;
  again(in);
  EXPECT_EQ(again.bytes(), writer.bytes());
  for (std::size_t size = 0; size < writer.bytes().size(); ++size) {
    Reader cut(std::span(writer.bytes()).first(size));
    Everything part;
    EXPECT_THROW(cut(part), Error) << size;
  }
}

TEST(Archive, ALengthThatCannotBeIsRefused) {
  Writer writer;
  writer(~std::uint64_t{0}, 1.0);
  std::vector<double> list;
  std::string text;
  Matrix<double, dynamic> matrix;
  EXPECT_THROW(Reader(writer.bytes())(list), Error);
  EXPECT_THROW(Reader(writer.bytes())(text), Error);
  EXPECT_THROW(Reader(writer.bytes())(matrix), Error);
}

}  // namespace

/// A number type that has to be written as text.
struct Textual {
  double value = 0;
  std::vector<int> makes_it_no_plain_bytes;
};
std::string exact_text(const Textual& x) { return shortest(x.value); }
void from_exact_text(const std::string& text, Textual& x) { x.value = parse_decimal<double>(text); }
template <>
struct ArchivedNumber<Textual> : ArchivedText<Textual> {};

namespace {
TEST(Archive, ANumberTypeMayBeText) {
  const Textual out{0.1, {}};
  Writer writer;
  writer(out);
  Textual in;
  Reader reader(writer.bytes());
  reader(in);
  EXPECT_EQ(in.value, 0.1);
  EXPECT_EQ(writer.bytes().size(), 8u + 3u);
}
}  // namespace
}  // namespace hamflow
