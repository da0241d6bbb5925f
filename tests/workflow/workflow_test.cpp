// What a program can do with a scenario: run it, stop it, go on with it, watch it; and that nothing is printed.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "hamflow/arithmetic/quad.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/scenario/value.hpp"
#include "hamflow/workflow/compare.hpp"
#include "hamflow/workflow/figures_of_run.hpp"
#include "hamflow/workflow/reverse.hpp"
#include "hamflow/workflow/run.hpp"
#include "hamflow/workflow/session.hpp"
#include "hamflow/workflow/sweep.hpp"
#include "run_file.hpp"
#include "verify/monodromy.hpp"

namespace hamflow {
namespace {

namespace fs = std::filesystem;

constexpr const char* chaos = R"(
[problem]
name = "henon-heiles"
initial = { q = [0, -0.15], p = [0.54, 0.1] }
[method]
name = "stv4"
[run]
dt = 0.1
steps = 3000
lyapunov = true
eigenvalues = true
section = { coordinate = "q1" }
[output]
formats = ["h5", "csv"]
)";

Scenario scenario(const std::vector<std::string>& sets = {}) {
  return accepted(read_scenario_text(chaos, "chaos", sets));
}

constexpr const char* plain = R"(
[problem]
name = "henon-heiles"
initial = { q = [0, -0.15], p = [0.3, 0.1] }
[method]
name = "stv4"
[run]
dt = 0.1
steps = 100
)";

std::string content(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// The summary but for the seconds.
std::string without_seconds(const std::string& json) {
  std::string text = json;
  for (const char* key : {"\"wall_seconds\"", "\"steps_per_second\""}) {
    const auto begin = text.find(key);
    text.erase(begin, text.find('\n', begin) - begin);
  }
  return text;
}

class Workflow : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / ("hamflow_workflow_" + std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
  }
  /// A library does not print.
  void TearDown() override {
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    fs::remove_all(folder_);
  }
  RunSettings in(const std::string& name, Existing existing = Existing::refuse) const {
    RunSettings settings;
    settings.folder = folder_ / name;
    settings.existing = existing;
    return settings;
  }
  fs::path folder_;
};

/// Counts what it sees, and asks to stop after some of it.
class Counter final : public Observer {
 public:
  explicit Counter(std::int64_t most = never) : most_(most) {}
  std::int64_t next_due(std::int64_t step) const override { return std::max(step, seen_to_ + 1); }
  Verdict observe(const Frame& frame) override {
    ++count;
    seen_to_ = frame.step;
    return count == most_ ? Verdict::stop : Verdict::go_on;
  }
  void archive(Writer& ar) override { ar(count, seen_to_); }
  void archive(Reader& ar) override { ar(count, seen_to_); }
  std::int64_t count = 0;

 private:
  std::int64_t most_;
  std::int64_t seen_to_ = -1;
};

class Forgetful final : public Observer {
 public:
  std::int64_t next_due(std::int64_t step) const override { return step; }
  Verdict observe(const Frame&) override {
    ++count;
    return Verdict::go_on;
  }
  std::int64_t count = 0;
};

TEST_F(Workflow, AReportHoldsTheNumbersOfItsSummary) {
  const RunReport report = run(scenario());
  EXPECT_EQ(report.status, "done");
  EXPECT_EQ(report.outcome, Outcome::done);
  EXPECT_EQ(report.final.step, 3000);
  EXPECT_NE(report.json.find("\"lyapunov\""), std::string::npos);
  EXPECT_NE(report.json.find(shortest(report.energy.max_error)), std::string::npos);
  EXPECT_NE(report.text.find("Lyapunov exponents"), std::string::npos);
  EXPECT_TRUE(report.certificate.has_value());
  EXPECT_TRUE(fs::is_empty(folder_));
}

/// The energies of a run, and the sum of q1^2 over its steps.
class Tally final : public Observer {
 public:
  std::int64_t next_due(std::int64_t step) const override { return step; }
  Verdict observe(const Frame& frame) override {
    if (frame.step == 0) first_ = frame.energy;
    most = std::max(most, std::abs(frame.energy - first_));
    if (frame.step > 0) squares += frame.q[0] * frame.q[0];
    return Verdict::go_on;
  }
  double most = 0;  // |H - H0|
  double squares = 0;

 private:
  double first_ = 0;
};

/// JSON holds all of it but for digits of doubles.
void expect_to_read_back(const RunReport& report) {
  const Summary again = read_summary(report.json);
  EXPECT_EQ(summary_json(again), report.json);
  EXPECT_EQ(summary_text(again), report.text);
}

TEST_F(Workflow, ASummaryHoldsTheNumbersOfAChaoticRun) {
  const Scenario chaotic = scenario({R"(run.events=[{ name = "up", expression = "q2", direction = 1 },
                                                    { name = "late", expression = "t - 120.05", action = "stop" }])",
                                     R"(output.observables={ square = "q1^2" })"});
  const auto simulation = make_simulation(chaotic.request);
  LyapunovObserver lyapunov(chaotic.problem->step_map(chaotic.request, 2), chaotic.dt, chaotic.steps);
  MonodromyObserver derivative(chaotic.problem->step_map(chaotic.request, 2), chaotic.dt, chaotic.steps);
  Tally tally;
  Observer* const observers[] = {&lyapunov, &derivative, &tally};
  ASSERT_EQ(run(*simulation, 1201, observers), Outcome::done);
  Frame end;
  simulation->look(end);
  for (TangentObserver* watch :
       {static_cast<TangentObserver*>(&lyapunov), static_cast<TangentObserver*>(&derivative)}) {
    if (watch->step() < end.step) (void)watch->observe(end);
  }

  const RunReport report = run(chaotic);
  const Summary& s = report.summary;
  EXPECT_EQ(s.status, "done");
  EXPECT_EQ(s.problem, "henon-heiles");
  EXPECT_EQ(s.steps, 1201);
  EXPECT_EQ(s.final.t, end.time);
  EXPECT_EQ(s.final.q, end.q);
  EXPECT_EQ(s.final.p, end.p);
  EXPECT_EQ(s.effort.force, end.effort.force);
  EXPECT_EQ(s.energy.final.value, end.energy);
  EXPECT_NEAR(s.energy.max_error, tally.most, 1e-15);
  EXPECT_EQ(s.energy.max_relative_error.value().value, s.energy.max_error / s.energy.scale.value());
  ASSERT_TRUE(s.lyapunov && s.eigenvalues && s.section && s.stopped_by && s.certificate);
  EXPECT_EQ(s.lyapunov->exponents, lyapunov.spectrum().exponents);
  EXPECT_EQ(s.lyapunov->pair_sums.size(), 2U);
  EXPECT_FALSE(s.lyapunov->stopped_at_step);
  EXPECT_EQ(s.eigenvalues->steps, 1201);
  ASSERT_TRUE(s.eigenvalues->values);
  EXPECT_EQ(*s.eigenvalues->values, symplectic_eigenvalues(derivative.rows()).values);
  EXPECT_EQ(s.section->points, static_cast<std::int64_t>(report.tables.section.rows()));
  EXPECT_GT(s.section->points, 10);
  const std::vector<double> q1 = report.tables.section["q"].part(0);
  EXPECT_EQ(s.section->max_residual, std::abs(*std::ranges::max_element(q1, {}, [](double x) { return std::abs(x); })));
  ASSERT_EQ(s.events.size(), 2U);
  EXPECT_EQ(s.events[0].first, "user:up");
  EXPECT_EQ(s.events[0].second, static_cast<std::int64_t>(report.tables.events.at(0).rows()));
  EXPECT_EQ(s.events[1], std::pair(std::string("user:late"), std::int64_t{1}));
  EXPECT_EQ(s.stopped_by->event, "late");
  EXPECT_NEAR(s.stopped_by->t, 120.05, 1e-13);
  EXPECT_EQ(s.stopped_by->q, report.tables.events.at(1)["q"].row(0));
  ASSERT_EQ(s.observables.size(), 1U);
  EXPECT_EQ(s.observables[0].name, "square");
  EXPECT_EQ(s.observables[0].final, end.q[0] * end.q[0]);
  EXPECT_NEAR(s.observables[0].mean, tally.squares / 1201, 1e-14);
  expect_to_read_back(report);
}

TEST_F(Workflow, ASummaryHoldsTheNumbersOfAnOrbit) {
  const std::string text = R"(
[problem]
name = "central-force"
potential = "kepler"
mass = 2
orbit = { kind = "ellipse", r_per = 1, r_aph = 3 }
[method]
name = "cg"
quadrature = 5
[run]
dt = 0.1
steps = 30
)";
  const RunReport report = run(accepted(read_scenario_text(text, "kepler", {})));
  const Summary& s = report.summary;
  ASSERT_TRUE(s.orbit && s.exact && s.newton);
  EXPECT_EQ(s.orbit->conic, "ellipse");
  EXPECT_NEAR(s.orbit->r_min, 1, 1e-15);
  EXPECT_NEAR(s.orbit->r_max, 3, 1e-14);
  EXPECT_FALSE(s.orbit->falls_into_centre);
  EXPECT_EQ(s.exact->differences.at(0).second,
            std::max(std::abs(s.final.q[0] - s.exact->q[0]), std::abs(s.final.q[1] - s.exact->q[1])));
  EXPECT_EQ(s.newton->mean, static_cast<double>(s.effort.linear_solves) / 30);
  const auto momentum = std::ranges::find(s.invariants, "angular_momentum", &InvariantSummary::name);
  ASSERT_NE(momentum, s.invariants.end());
  EXPECT_FALSE(momentum->is_list);
  EXPECT_NEAR(momentum->seen.final.at(0), s.final.q[0] * s.final.p[1] - s.final.q[1] * s.final.p[0], 1e-14);
  expect_to_read_back(report);

  const Scenario longer = accepted(read_scenario_text(text, "kepler", {"run.arithmetic=mp(40)", "run.steps=10"}));
  const auto simulation = make_simulation(longer.request);
  ASSERT_EQ(simulation->advance(10), Outcome::done);
  Frame end;
  simulation->look(end);
  const RunReport in_digits = run(longer);
  const Summary& d = in_digits.summary;
  EXPECT_EQ(d.final.digits.time, end.digits.time);
  EXPECT_EQ(d.final.digits.q, end.digits.q);
  EXPECT_EQ(d.final.q, end.q);
  EXPECT_EQ(d.energy.final.text, end.digits.energy);
  EXPECT_EQ(d.energy.final.value, end.energy);
  EXPECT_GE(d.orbit->apsidal_angle.text.size(), 40U);
  EXPECT_NEAR(d.orbit->apsidal_angle, pi_value<double>(), 1e-15);
  EXPECT_EQ(d.orbit->uncertainty.size(), 5U);
  expect_to_read_back(in_digits);
}

TEST_F(Workflow, ASummaryTellsWhyARunFailed) {
  const RunReport report = run(scenario(
      {"run.lyapunov=false", "run.eigenvalues=false", "run.dt=3", R"(method={ name = "gauss", max_iterations = 3 })"}));
  const Summary& s = report.summary;
  EXPECT_EQ(s.status, "failed");
  ASSERT_TRUE(s.error);
  EXPECT_EQ(s.error->kind, "not_converged");
  EXPECT_EQ(s.error->step, s.steps + 1);
  EXPECT_EQ(s.error->t, s.final.t);
  EXPECT_EQ(s.error->message, report.message);
  EXPECT_EQ(s.error->hint, report.hint);
  EXPECT_FALSE(s.error->hint.empty());
  expect_to_read_back(report);
}

TEST_F(Workflow, ASweepHoldsTheNumbersOfItsMembers) {
  ScenarioSweep sweep({.text = chaos,
                       .name = "chaos",
                       .sets = {"run.steps=500", R"(output.observables={ square = "q1^2" })"},
                       .varied = {"problem.initial.p[1]=0.1,0.12"}});
  const SweepSummary s = sweep.run().summary;
  EXPECT_EQ(s.done, 2U);
  ASSERT_EQ(s.rows.size(), 2U);
  for (const SweepRow& row : s.rows) {
    const double p = std::get<double>(row.varied.at(0).second.content);
    const Summary alone = run(scenario({"run.steps=500", R"(output.observables={ square = "q1^2" })",
                                        "problem.initial.p=[0.54," + shortest(p) + "]"}))
                              .summary;
    ASSERT_TRUE(row.final && row.section && alone.lyapunov && alone.section);
    EXPECT_EQ(row.final->q, alone.final.q);
    EXPECT_EQ(row.energy.max_error, alone.energy.max_error.value);
    EXPECT_EQ(row.section->points, alone.section->points);
    const auto column = std::ranges::find(row.columns, "lyapunov1", &std::pair<std::string, double>::first);
    ASSERT_NE(column, row.columns.end());
    EXPECT_EQ(column->second, alone.lyapunov->exponents[0]);
    EXPECT_EQ(row.observables.at(0).mean, alone.observables.at(0).mean);
  }
}

TEST_F(Workflow, ACertificateThatWasStoppedBehindAnEventIsMadeUpFor) {
  const Scenario short_run = scenario({R"(run.events=[{ expression = "t - 120.05", action = "stop" }])"});
  const RunReport wanted = run(short_run, in("whole"));
  ASSERT_EQ(wanted.status, "done");
  ASSERT_NE(wanted.json.find("\"stopped_by\""), std::string::npos);
  ASSERT_EQ(wanted.final.step, 1201);

  RunSettings settings = in("part");
  settings.pulse = [](std::int64_t step) { return step < 1201; };  // asked at the last step by the certificate alone
  const RunReport stopped = run(short_run, settings);
  ASSERT_EQ(stopped.status, "interrupted");
  ASSERT_TRUE(stopped.certificate->reversal->was_stopped);

  const RunReport found = run(short_run, in("part", Existing::resume));
  EXPECT_FALSE(found.was_complete);
  EXPECT_EQ(without_seconds(found.json), without_seconds(wanted.json));
  EXPECT_EQ(content(folder_ / "part" / "trajectory.csv"), content(folder_ / "whole" / "trajectory.csv"));
  EXPECT_TRUE(run(short_run, in("part", Existing::resume)).was_complete);
}

TEST_F(Workflow, StoppedByAnObserverAndResumed) {
  Counter whole;
  RunSettings settings = in("whole");
  settings.observers = {&whole};
  const RunReport wanted = run(scenario(), settings);
  ASSERT_EQ(wanted.status, "done");
  EXPECT_EQ(whole.count, 3001);

  settings = in("part");
  Counter first(1234);
  settings.observers = {&first};
  EXPECT_EQ(run(scenario(), settings).status, "interrupted");
  settings.existing = Existing::resume;
  Counter second;
  settings.observers = {&second};
  const RunReport found = run(scenario(), settings);
  EXPECT_EQ(second.count, 3001);
  EXPECT_EQ(without_seconds(found.json), without_seconds(wanted.json));
  EXPECT_EQ(content(folder_ / "part" / "trajectory.csv"), content(folder_ / "whole" / "trajectory.csv"));
  EXPECT_EQ(found.final.q, wanted.final.q);
  EXPECT_EQ(found.energy.max_error, wanted.energy.max_error);

  Counter third;
  settings.observers = {&third};
  const RunReport again = run(scenario(), settings);
  EXPECT_TRUE(again.was_complete);
  EXPECT_EQ(again.json, found.json);
  EXPECT_EQ(again.final.q, wanted.final.q);
  EXPECT_EQ(third.count, 3001);
  settings.observers = {};  // the checkpoint has one more
  EXPECT_THROW(run(scenario({"run.steps=4000"}), settings), FileError);
}

/// Samples about half a period apart show a modulation that is not there; the range of the steps between them does not.
TEST_F(Workflow, RangesOfTheEnergyErrorDoNotBeatWithTheOrbit) {
  constexpr const char* orbit = R"(
[problem]
name = "central-force"
potential = "kepler"
orbit = { kind = "ellipse", r_per = 0.5, r_aph = 1.5 }
[method]
name = "verlet"
[run]
dt = "2*pi/1000"
steps = 5_050_505
)";
  const Scenario whole = accepted(read_scenario_text(orbit, "orbit", {}));
  ASSERT_GT(whole.record_every, 500);
  ASSERT_EQ(run(whole, in("whole")).status, "done");
  const Table samples = read_run_file(folder_ / "whole" / "run.h5").tables.samples;
  const auto energy = samples["energy"].numbers();
  const auto least_difference = samples["energy_error_min"].numbers();
  const auto largest_difference = samples["energy_error_max"].numbers();
  ASSERT_EQ(least_difference.size(), samples.rows());
  ASSERT_EQ(largest_difference.size(), samples.rows());
  const auto heights = [](std::size_t rows, const auto& low_at, const auto& high_at) {
    constexpr std::size_t together = 20;
    std::vector<double> all;
    for (std::size_t k = 1; k + together < rows; k += together) {
      double low = low_at(k), high = high_at(k);
      for (std::size_t i = k; i < k + together; ++i) low = std::min(low, low_at(i)), high = std::max(high, high_at(i));
      all.push_back(high - low);
    }
    return std::pair(*std::min_element(all.begin(), all.end()), *std::max_element(all.begin(), all.end()));
  };
  const auto sampled = [&](std::size_t k) { return energy[k]; };
  const auto [least_sampled, largest_sampled] = heights(samples.rows(), sampled, sampled);
  EXPECT_LT(least_sampled, 0.1 * largest_sampled) << "this case shows nothing";
  const auto [least, largest] = heights(
      samples.rows(), [&](std::size_t k) { return least_difference[k]; },
      [&](std::size_t k) { return largest_difference[k]; });
  EXPECT_GT(least, 0.99 * largest);
  for (std::size_t k = 0; k < samples.rows(); ++k) {
    const double difference = energy[k] - energy[0];
    ASSERT_LE(least_difference[k], difference) << k;
    ASSERT_GE(largest_difference[k], difference) << k;
  }

  RunSettings settings = in("part");
  settings.pulse = [](std::int64_t step) { return step < 1'234'567; };
  ASSERT_EQ(run(whole, settings).status, "interrupted");
  ASSERT_EQ(run(whole, in("part", Existing::resume)).status, "done");
  const Table part = read_run_file(folder_ / "part" / "run.h5").tables.samples;
  for (const char* name : {"energy", "energy_error_min", "energy_error_max"}) {
    EXPECT_EQ(part[name].part(0), samples[name].part(0)) << name;
  }
}

/// The columns that both have: a file says what a run in memory says, to the last bit.
void expect_same(const Table& found, const Table& wanted) {
  for (const Column& column : found.columns()) {
    const Column& other = wanted[column.name()];
    ASSERT_EQ(column.rows(), other.rows()) << column.name();
    EXPECT_EQ(column.info().width, other.info().width) << column.name();
    if (column.info().type == ValueType::text) {
      EXPECT_EQ(column.texts(), other.texts()) << column.name();
    } else {
      EXPECT_TRUE(std::ranges::equal(column.bytes(), other.bytes())) << column.name();
    }
  }
}

TEST_F(Workflow, ARunInMemoryHasTheTablesOfItsFile) {
  const std::vector<std::string> with_events{"run.events=[{name=\"up\",expression=\"p1\"}]",
                                             "output.observables={r2=\"q1^2+q2^2\"}"};
  std::vector<std::string> in_digits = with_events;
  in_digits.insert(in_digits.end(), {"run.arithmetic=mp(30)", "run.lyapunov=false", "run.eigenvalues=false",
                                     "run.steps=300", "output.formats=[\"h5\"]"});
  for (const auto& sets : {with_events, in_digits}) {
    const Scenario one = scenario(sets);
    const RunReport report = run(one);
    ASSERT_EQ(run(one, in("file", Existing::replace)).status, "done");
    const StoredRun stored = read_run_file(folder_ / "file" / "run.h5", {.digits = true, .events = true});
    ASSERT_GT(report.tables.samples.rows(), 100U);
    ASSERT_GT(report.tables.section.rows(), 2U);
    ASSERT_EQ(report.tables.events.size(), 1U);
    ASSERT_GT(report.tables.events[0].rows(), 2U);
    expect_same(stored.tables.samples, report.tables.samples);
    expect_same(stored.tables.section, report.tables.section);
    ASSERT_EQ(stored.tables.events.size(), 1U);
    expect_same(stored.tables.events[0], report.tables.events[0]);
    EXPECT_EQ(report.tables.samples["t"].numbers().back(), report.final.time);
    EXPECT_EQ(report.tables.samples["q"].row(report.tables.samples.rows() - 1), report.final.q);
  }
  RunSettings settings;
  settings.samples = false;
  EXPECT_TRUE(run(scenario(), settings).tables.samples.empty());
}

TEST_F(Workflow, AScenarioFromATreeOfValuesIsThatOfItsText) {
  const double third = 1.0 / 3;
  const Value::Table tree{
      {"problem", Value::Table{{"name", "formula"},
                               {"coordinates", Value::List{Value("q1"), Value("q2")}},
                               {"hamiltonian", "(p1^2+p2^2)/2 + k*(q1^2+q2^2)/2 + q1^2*q2"},
                               {"parameters", Value::Table{{"k", third}}},
                               {"initial", Value::Table{{"q", std::vector<double>{0.1, -0.15}},
                                                        {"p", Value::List{Value(0.3), Value("1/10")}}}}}},
      {"method", Value::Table{{"name", "stv4"}}},
      {"run", Value::Table{{"dt", 0.1}, {"steps", 500}, {"certificate", false}}}};
  const Scenario from_tree = accepted(read_scenario_tree(tree, "tree"));
  EXPECT_EQ(from_tree.text, scenario_text(tree));
  const RunReport found = run(from_tree);
  const RunReport wanted = run(accepted(read_scenario_text(R"(
[problem]
name = "formula"
coordinates = ["q1", "q2"]
hamiltonian = "(p1^2+p2^2)/2 + k*(q1^2+q2^2)/2 + q1^2*q2"
parameters = { k = 0.3333333333333333 }
initial = { q = [0.1, -0.15], p = [0.3, 0.1] }
[method]
name = "stv4"
[run]
dt = 0.1
steps = 500
certificate = false
)",
                                                           "text", {})));
  expect_same(found.tables.samples, wanted.tables.samples);
  EXPECT_FALSE(found.certificate.has_value());

  Value::Table wrong = tree;
  wrong[2].second = Value::Table{{"dt", "no number"}, {"step", 5}};
  const Reading refused = read_scenario_tree(wrong, "tree");
  EXPECT_FALSE(refused.scenario);
  EXPECT_GE(refused.complaints.size(), 2U);
  wrong.push_back({"run", Value::Table{}});
  EXPECT_THROW((void)scenario_text(wrong), Error);
}

TEST_F(Workflow, BouncesInMemoryAreThoseOfTheFile) {
  const Scenario one = accepted(read_scenario_text(
      plain, "plain",
      {"problem.walls=[{coordinate=\"q1\",min=-0.2,max=0.2}]", "run.arithmetic=quad", "run.steps=400"}));
  const RunReport report = run(one);
  ASSERT_EQ(run(one, in("file")).status, "done");
  const StoredRun stored = read_run_file(folder_ / "file" / "run.h5", {.events = true});
  ASSERT_GT(report.tables.bounces.rows(), 5U);
  expect_same(stored.tables.bounces, report.tables.bounces);
  // They lie on the walls in the arithmetic of the run: to more digits than a double has.
  const Column& digits = report.tables.bounces["digits/q"];
  for (std::size_t k = 0; k < digits.rows(); ++k) {
    const Quad q = evaluate_number<Quad>(std::string(digits.text(k, 0)));
    const Quad wall = q < 0 ? -evaluate_number<Quad>("0.2") : evaluate_number<Quad>("0.2");
    EXPECT_LT(std::abs(static_cast<double>(q - wall)), 1e-30) << k;
  }
}

TEST_F(Workflow, WhatAPulseOrAnObserverThrowsReachesTheCaller) {
  struct Mine : std::runtime_error {
    using std::runtime_error::runtime_error;
  };
  struct Thrower final : Observer {
    std::int64_t next_due(std::int64_t step) const override { return std::max<std::int64_t>(step, 500); }
    Verdict observe(const Frame&) override { throw Mine("observer"); }
    void archive(Writer&) override {}
    void archive(Reader&) override {}
  };
  Thrower thrower;
  RunSettings settings;
  settings.observers = {&thrower};
  EXPECT_THROW(run(scenario(), settings), Mine);
  settings = in("thrown");
  settings.pulse = [](std::int64_t) -> bool { throw Mine("pulse"); };
  EXPECT_THROW(run(scenario({"run.steps=3000000"}), settings), Mine);
  EXPECT_EQ(run(scenario(), in("thrown", Existing::replace)).status, "done");  // nobody holds the folder
  ScenarioSweep sweep({.text = chaos, .name = "chaos", .sets = {"run.steps=300000"}, .varied = {"run.dt=0.1,0.12"}});
  EXPECT_THROW((void)sweep.run([](std::int64_t) -> bool { throw Mine("pulse"); }), Mine);
}

TEST_F(Workflow, ASweepHasColumns) {
  const std::string varied = "problem.initial.p[1]";
  ScenarioSweep sweep({.text = plain, .name = "plain", .varied = {varied + "=0.1:0.12:11000"}});
  ASSERT_TRUE(sweep.complaints().empty());
  ASSERT_EQ(sweep.run().status, "done");
  const Table members = sweep.members();
  ASSERT_EQ(members.rows(), 11000U);
  for (const std::size_t k : {0U, 10999U}) {
    const std::string start = shortest(members["varied/" + varied].numbers()[k]);
    const RunReport one = run(accepted(read_scenario_text(plain, "plain", {varied + "=" + start})));
    EXPECT_EQ(members["final/q"].row(k), one.final.q);
    EXPECT_EQ(members["energy/max_error"].numbers()[k], one.energy.max_error);
    EXPECT_EQ(members["member/status"].text(k), "done");
  }
  EXPECT_TRUE(sweep.sections().empty());
}

TEST_F(Workflow, AnObserverWithoutArchiveIsRefusedBeforeAnythingIsWritten) {
  Forgetful observer;
  RunSettings settings = in("refused");
  settings.observers = {&observer};
  EXPECT_THROW(run(scenario(), settings), Error);
  EXPECT_EQ(observer.count, 0);
  EXPECT_FALSE(fs::exists(folder_ / "refused"));
  settings.folder.clear();  // without checkpoints it may watch
  EXPECT_EQ(run(scenario(), settings).status, "done");
  EXPECT_EQ(observer.count, 3001);
}

TEST_F(Workflow, RequestsThatAreWrong) {
  try {
    (void)scenario({"run.dt=0", "method.name=stv5"});
    ADD_FAILURE() << "accepted";
  } catch (const Rejection& rejection) {
    EXPECT_EQ(rejection.complaints.size(), 2U);
    EXPECT_NE(std::string(rejection.what()).find("did you mean"), std::string::npos);
  }
  (void)run(scenario(), in("r"));
  EXPECT_THROW(run(scenario(), in("r")), FileError);
  EXPECT_THROW(run(scenario({"run.dt=0.2"}), in("r", Existing::resume)), Rejection);
  EXPECT_EQ(run(scenario({"run.dt=0.2"}), in("r", Existing::replace)).status, "done");
  EXPECT_THROW(draw_figure(folder_ / "r", "orbits", folder_ / "x.svg"), Error);
  EXPECT_THROW(draw_figure(folder_ / "none", "orbit", folder_ / "x.svg"), FileError);
}

TEST_F(Workflow, ReversalComparisonSweepAndSession) {
  const ReversalReport back =
      reverse_scenario(scenario({"run.lyapunov=false", "run.eigenvalues=false", "run.arithmetic=lattice"}));
  EXPECT_TRUE(back.reversal.bit_exact);
  EXPECT_TRUE(back.summary.bit_exact.value());
  EXPECT_EQ(back.summary.returned->q, back.summary.start.q);
  EXPECT_EQ(back.summary.end_hash, back.summary.start_hash);

  ReversalSettings settings{.folder = folder_ / "there_and_back"};
  settings.pulse = [calls = 0](std::int64_t) mutable { return ++calls < 2; };
  const Scenario long_way = scenario({"run.lyapunov=false", "run.eigenvalues=false", "run.steps=200000"});
  EXPECT_EQ(reverse_scenario(long_way, settings).status, "interrupted");
  settings.pulse = {};
  settings.existing = Existing::resume;
  const ReversalReport whole = reverse_scenario(long_way, settings);
  EXPECT_EQ(whole.json, reverse_scenario(long_way).json);
  EXPECT_EQ(whole.summary.distance->value, whole.reversal.distance.value);
  const ReversalReport there = reverse_scenario(long_way, settings);  // complete: read from the folder
  EXPECT_EQ(reversal_json(there.summary), whole.json);
  EXPECT_EQ(there.text, whole.text);

  ComparisonRequest two{scenario().request, {parse_method("stv4"), parse_method("yoshida6")}, 10, {100, 200}};
  const ComparisonReport compared = compare_methods(two);
  EXPECT_EQ(compared.status, "done");
  EXPECT_EQ(compared.comparison.points.size(), 4U);

  ScenarioSweep sweep({.text = chaos, .name = "chaos", .varied = {"problem.initial.p[1]=0.1,0.12"}});
  ASSERT_TRUE(sweep.complaints().empty());
  EXPECT_TRUE(sweep.notes().empty());
  const SweepReport swept = sweep.run();
  EXPECT_EQ(swept.status, "done");
  EXPECT_NE(sweep.json_with_rows(swept).find("\"lyapunov4\""), std::string::npos);
  EXPECT_NE(sweep.json_with_rows(swept).find("\"eigenvalue4_re\""), std::string::npos);

  Session session(scenario());
  ASSERT_EQ(session.advance(10), Outcome::done);
  session.set_step_size("0.05");
  ASSERT_EQ(session.advance(10), Outcome::done);
  const SampleKeeper samples(1, 2);
  save_session(session, samples, {}, folder_ / "steered", false);
  EXPECT_NE(content(folder_ / "steered" / "summary.json").find("\"changes\""), std::string::npos);
  EXPECT_FALSE(session_summary(session, {}).error);
}

/// Of a gas a sample is positions, momenta and velocities.
/// The simulation of a large run makes room for its reversal: another one takes its place, in the same state.
TEST(LargeRuns, ReportWhatTheirSimulationSaysOfItself) {
  const Scenario gas = accepted(read_scenario_text(R"(
[problem]
name = "gas"
particles_per_side = 230
scale = 115
container = { kind = "periodic", size = [2.01, 2.01] }
cutoff = 2.5
masses = 1e4
[method]
name = "verlet"
[run]
dt = 0.01
steps = 3
)",
                                                   "gas", {}));
  const RunReport report = run(gas);
  const auto simulation = make_simulation(gas.request);
  ASSERT_EQ(simulation->advance(3), Outcome::done);
  Frame frame;
  simulation->look(frame);
  ASSERT_GT(frame.q.size(), 100'000U);
  EXPECT_EQ(report.final.q, frame.q);
  EXPECT_EQ(report.final.p, frame.p);
  EXPECT_EQ(report.final.step, 3);
  EXPECT_EQ(report.final.effort.force, frame.effort.force);
  EXPECT_EQ(report.energy.initial, simulation->energy().initial);
  EXPECT_EQ(report.energy.final, simulation->energy().final);
  EXPECT_EQ(report.energy.max_error, simulation->energy().max_error);
  EXPECT_EQ(report.energy_scale, simulation->energy_scale());
  ASSERT_FALSE(report.invariants.empty());
  for (std::size_t i = 0; i < report.invariants.size(); ++i) {
    EXPECT_EQ(report.invariants[i].initial, simulation->invariants().at(i).initial);
    EXPECT_EQ(report.invariants[i].final, simulation->invariants().at(i).final);
    EXPECT_EQ(report.invariants[i].max_error, simulation->invariants().at(i).max_error);
  }
  ASSERT_TRUE(report.certificate && report.certificate->reversal);
  EXPECT_EQ(report.certificate->reversal->proves, ReversalProof::to_rounding);
}

TEST(Samples, OfManyParticlesAreAsManyAsOneGibibyteHolds) {
  for (const char* steps : {"6000", "1000000", "3000"}) {
    const std::string text = std::string(R"(
[problem]
name = "gas"
particles_per_side = 17
dimension = 3
container = { kind = "none" }
cutoff = 1.2
[method]
name = "verlet"
[run]
dt = 0.001
steps = )") + steps;
    const Scenario gas = accepted(read_scenario_text(text, "gas", {}));
    const double bytes = static_cast<double>(sample_count(gas)) * 3 * 3 * 17 * 17 * 17 * sizeof(double);
    EXPECT_LE(bytes, 0x1p30);
    EXPECT_TRUE(gas.record_every == 1 || 2.1 * bytes > 0x1p30) << steps;  // and no fewer than that asks for
  }
}

}  // namespace
}  // namespace hamflow
