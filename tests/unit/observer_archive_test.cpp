// What observers have seen goes through bytes and back: a run that is cut in two, at an end of its own, is to the last
// bit the run that was not.
#include <gtest/gtest.h>

#include "hamflow/run/catalog.hpp"
#include "hamflow/run/section.hpp"
#include "hamflow/verify/certificate.hpp"
#include "verify/monodromy.hpp"

namespace hamflow {
namespace {

constexpr std::int64_t whole_run = 3000;

Request chaos() {
  Request request;
  request.problem = "henon-heiles";
  request.start.q = {"0", "-0.15"};
  request.start.p = {"0.54", "0.1"};
  request.dt = "0.1";
  return request;
}

std::shared_ptr<const StepMap> map_of(const Request& request) {
  const auto problem_entry = find_problem(request);
  const ProblemEntry& problem = *problem_entry;
  Request full = request;
  full.parameters = complete(problem.info, request.parameters);
  return problem.step_map(full, 2);
}

/// Everything that watches a run, as a scenario requests it.
struct Watches {
  explicit Watches(const Simulation& simulation, std::int64_t last_step)
      : section(simulation, {.coordinate = 0, .direction = 0}, [this](const SectionPoint& p) { points.push_back(p); }),
        exponents(map_of(chaos()), 0.1, last_step),
        first_exponent(map_of(chaos()), 0.1, last_step, 1),
        derivative(map_of(chaos()), 0.1, last_step) {}
  std::vector<Observer*> all() { return {&blocks, &section, &exponents, &first_exponent, &derivative}; }
  std::vector<std::vector<std::byte>> archives() {
    std::vector<std::vector<std::byte>> bytes;
    for (Observer* observer : all()) {
      Writer ar;
      observer->archive(ar);
      bytes.push_back(ar.take());
    }
    return bytes;
  }

  std::vector<SectionPoint> points;
  EnergyBlocks blocks;
  SectionFinder section;
  LyapunovObserver exponents, first_exponent;
  MonodromyObserver derivative;
};

void go_to(Simulation& simulation, Watches& watches, std::int64_t step) {
  const std::vector<Observer*> observers = watches.all();
  ASSERT_EQ(run(simulation, step, observers), Outcome::done);
}

void expect_equal_points(const std::vector<SectionPoint>& a, const std::vector<SectionPoint>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].time, b[i].time);
    EXPECT_EQ(a[i].q, b[i].q);
    EXPECT_EQ(a[i].p, b[i].p);
  }
}

TEST(ObserverArchive, ARunThatIsCutIsTheWholeRunToTheLastBit) {
  const auto whole = make_simulation(chaos());
  Watches watched(*whole, whole_run);
  go_to(*whole, watched, whole_run);
  ASSERT_GT(watched.points.size(), 50U);
  for (const std::int64_t cut : {0, 1, 2, 63, 64, 65, 999, 1000, 2113}) {
    SCOPED_TRACE(cut);
    const auto first = make_simulation(chaos());
    Watches before(*first, cut);  // the tangent vectors are carried to this end, too, which the whole run does not have
    go_to(*first, before, cut);

    const auto second = make_simulation(chaos());
    second->restore(first->save());
    Watches after(*second, whole_run);
    const auto saved = before.archives();
    const std::vector<Observer*> observers = after.all();
    for (std::size_t i = 0; i < observers.size(); ++i) {
      Reader ar(saved[i]);
      observers[i]->archive(ar);
      ar.finish();
    }
    EXPECT_EQ(after.archives(), saved);
    after.points = before.points;
    go_to(*second, after, whole_run);
    EXPECT_EQ(after.archives(), watched.archives());
    EXPECT_EQ(after.exponents.spectrum().exponents, watched.exponents.spectrum().exponents);
    EXPECT_EQ(after.exponents.spectrum().pair_sums, watched.exponents.spectrum().pair_sums);
    EXPECT_EQ(after.first_exponent.spectrum().exponents, watched.first_exponent.spectrum().exponents);
    EXPECT_EQ(after.derivative.rows(), watched.derivative.rows());
    expect_equal_points(after.points, watched.points);
  }
}

TEST(ObserverArchive, BytesOfAnotherObserverAreRefused) {
  const auto simulation = make_simulation(chaos());
  Watches watches(*simulation, 100);
  go_to(*simulation, watches, 100);
  const auto saved = watches.archives();
  Reader four(saved[2]);
  EXPECT_THROW(watches.first_exponent.archive(four), Error);
  Reader one(saved[3]);
  EXPECT_THROW(watches.exponents.archive(one), Error);
  for (std::size_t i = 0; i < saved.size(); ++i) {
    SCOPED_TRACE(i);
    Reader short_of_a_byte(std::span(saved[i]).first(saved[i].size() - 1));
    Watches fresh(*simulation, 100);
    EXPECT_THROW(fresh.all()[i]->archive(short_of_a_byte), Error);
  }
}

class Forgetful final : public Observer {
 public:
  std::int64_t next_due(std::int64_t step) const override { return step; }
  Verdict observe(const Frame&) override { return Verdict::go_on; }
};

TEST(ObserverArchive, AnObserverWithoutArchiveIsRefused) {
  Forgetful observer;
  Writer to;
  EXPECT_THROW(observer.archive(to), Error);
  Reader from(to.bytes());
  EXPECT_THROW(observer.archive(from), Error);
}

}  // namespace
}  // namespace hamflow
