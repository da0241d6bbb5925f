// All experiments, as `hamflow reproduce all --quick` has them: among the commands of the README, which the test of the
// installed command runs. HAMFLOW_QUICK_REPRODUCTION names the folder that it has left; without it they are carried out
// here.
#include "reproduce.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "shared_work.hpp"
#include "study.hpp"

namespace hamflow {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// A number that the rule does not allow, beyond its uncertainty.
Measured violation(const Rule& rule) {
  if (std::isfinite(rule.high)) return {rule.high + std::abs(rule.high) + 1, 0, "violation"};
  return {rule.low - std::abs(rule.low) - 1, 0, "violation"};
}
/// One that it allows.
Measured agreement(const Rule& rule) {
  if (std::isfinite(rule.low) && std::isfinite(rule.high)) return {(rule.low + rule.high) / 2, 0, "agreement"};
  return {std::isfinite(rule.high) ? rule.high - std::abs(rule.high) : rule.low + std::abs(rule.low), 0, "agreement"};
}

void expect_all_computed(const ReproduceReport& report) {
  EXPECT_EQ(report.status, "done");
  for (const ExperimentReport& one : report.experiments) {
    EXPECT_EQ(one.status, "done") << one.info.id << ": " << one.message;
    EXPECT_FALSE(one.claims.empty()) << one.info.id;
  }
}

void expect_rules_notice_violations(const ReproduceReport& report) {
  std::set<std::string> ids;
  for (const ExperimentReport& one : report.experiments) {
    for (const Claim& claim : one.claims) {
      EXPECT_TRUE(ids.insert(claim.id).second) << claim.id << " twice";
      if (claim.judgement.verdict == ClaimVerdict::nothing_to_test) continue;
      ASSERT_TRUE(std::isfinite(claim.rule.low) || std::isfinite(claim.rule.high)) << claim.id;
      EXPECT_EQ(judge(claim.rule, claim.measured, claim.grounds).verdict, claim.judgement.verdict) << claim.id;
      const std::vector<Measured> wrong(std::max<std::size_t>(1, claim.measured.size()), violation(claim.rule));
      const ClaimVerdict fed = judge(claim.rule, wrong, claim.grounds).verdict;
      EXPECT_TRUE(fed == ClaimVerdict::differs || fed == ClaimVerdict::cannot_hold) << claim.id;
      EXPECT_EQ(judge(claim.rule, std::vector{agreement(claim.rule)}, claim.grounds).verdict, ClaimVerdict::holds)
          << claim.id;
    }
  }
}

const Claim& claim_of(const ReproduceReport& report, const std::string& id) {
  for (const ExperimentReport& one : report.experiments) {
    for (const Claim& claim : one.claims) {
      if (claim.id == id) return claim;
    }
  }
  throw Error("no claim " + id);
}

/// Neither a tie, nor a search among two starts, nor the floor of a logarithm is told as more than it is.
void expect_no_more_than_shown(const ReproduceReport& report) {
  EXPECT_EQ(claim_of(report, "C-polar/accuracy").judgement.verdict, ClaimVerdict::undecided);
  for (const std::string scale : {"per-side", "listing"}) {
    // With the listing's factor of the wall kept a higher power helps, whatever the scale.
    for (const std::string name : {"smaller_dt", "exponent_later", "exponent"}) {
      const Claim& none = claim_of(report, "S-C80/" + name + "_" + scale);
      EXPECT_EQ(none.judgement.verdict, ClaimVerdict::undecided) << none.id;
      EXPECT_EQ(none.measured.at(0).value, 0) << none.id;
      EXPECT_GT(none.measured.at(0).uncertainty, 7) << none.id;  // 10 times 78 %
    }
    const Claim& longer = claim_of(report, "S-C80/smallest_dt_" + scale);
    EXPECT_EQ(longer.judgement.verdict, ClaimVerdict::undecided) << longer.id;
    EXPECT_GT(longer.measured.at(0).value, 0) << longer.id;
    // Evidence there is none where nothing moved, or where the step is not the thesis' own.
    EXPECT_EQ(claim_of(report, "S3.2/returns_" + scale).judgement.verdict, ClaimVerdict::undecided) << scale;
    for (const std::string dt : {"0.001", "0.0001"}) {
      const Claim& still = claim_of(report, "S3.3/returns_" + dt + "_" + scale);
      EXPECT_EQ(still.judgement.verdict, ClaimVerdict::undecided) << still.id;
      EXPECT_EQ(still.measured.at(0).value, 0) << still.id;
    }
  }
  for (const std::string steps : {"200", "400", "800"}) {
    const std::string how = claim_of(report, "S-T81/row_121_" + steps + "_0.0001_listing").measured.at(0).how;
    EXPECT_NE(how.find("of momenta 0: every momentum returns"), std::string::npos) << how;
  }
}

void expect_page_alone(const ReproduceReport& report, const fs::path& folder) {
  std::string page = text_of(folder / "index.html");
  // Names of the language of figures, not addresses.
  for (const std::string language : {"http://www.w3.org/2000/svg%22", "http://www.w3.org/1999/xlink%22"}) {
    for (std::size_t at = page.find(language); at != std::string::npos; at = page.find(language, at)) {
      page.erase(at, language.size());
    }
  }
  for (const char* outside : {"http://", "https://", "<script", "@import", "<link"}) {
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  }
  for (const ExperimentReport& one : report.experiments) {
    EXPECT_NE(page.find("id=\"" + one.info.id + "\""), std::string::npos) << one.info.id;
  }
}

/// Figures N.1 to N.last of a thesis.
void expect_figures(const std::set<std::string>& ids, const std::string& chapter, int last) {
  for (int k = 1; k <= last; ++k) EXPECT_TRUE(ids.contains(chapter + "." + std::to_string(k))) << chapter << "." << k;
}

/// 58 figures and 9 tables of Gross, 32 figures, some of them parts of one, and 3 tables of Sonnleitner.
void expect_every_figure_and_table(const ReproduceReport& report, const fs::path& folder) {
  std::set<std::string> ids;
  for (const ExperimentReport& one : report.experiments) ids.insert(one.info.id);
  expect_figures(ids, "G1", 2);
  expect_figures(ids, "G2", 28);
  expect_figures(ids, "G3", 28);
  expect_figures(ids, "T2", 5);
  expect_figures(ids, "T3", 4);
  expect_figures(ids, "S1", 3);
  expect_figures(ids, "S2", 7);
  expect_figures(ids, "S3", 9);
  for (const char* const table : {"S-T64", "S-T81", "S-T99"}) EXPECT_TRUE(ids.contains(table)) << table;
  const std::string page = text_of(folder / "index.html");
  for (const char* const part : {"3.2a", "3.2b", "3.2c", "3.3a", "3.3b", "3.3c", "3.4a", "3.4b", "3.4c", "3.4d", "3.4e",
                                 "3.5a", "3.5b", "3.5c", "3.5d", "3.6a", "3.6b", "3.8a", "3.8b"}) {
    EXPECT_NE(page.find(part), std::string::npos) << part;
  }
}

/// What is done is not done again, and the verdicts stay.
void expect_nothing_to_resume(ReproduceRequest request) {
  const std::string verdicts = text_of(request.folder / "verdicts.json");
  request.existing = Existing::resume;
  request.threads = 1;
  const ReproduceReport second = reproduce(request);
  for (const ExperimentReport& one : second.experiments) EXPECT_TRUE(one.was_done) << one.info.id;
  EXPECT_EQ(text_of(request.folder / "verdicts.json"), verdicts);
}

TEST(Experiments, AllOfThemQuickly) {  // one test: they are carried out once
  const char* const left = std::getenv("HAMFLOW_QUICK_REPRODUCTION");
  const fs::path folder = left != nullptr
                              ? fs::path(left)
                              : fs::temp_directory_path() / ("hamflow_reproduce_" + std::to_string(::getpid()));
  if (left == nullptr) fs::remove_all(folder);
  const ReproduceRequest request{named_experiments({"all"}), WorkExtent::quick, folder,
                                 left != nullptr ? Existing::resume : Existing::refuse, 2};
  const ReproduceReport report = reproduce(request);
  for (const ExperimentReport& one : report.experiments) EXPECT_EQ(one.was_done, left != nullptr) << one.info.id;
  expect_all_computed(report);
  expect_rules_notice_violations(report);
  expect_no_more_than_shown(report);
  expect_page_alone(report, folder);
  expect_every_figure_and_table(report, folder);
  expect_nothing_to_resume(request);
  if (left == nullptr) fs::remove_all(folder);
}

TEST(Study, RefusesASecondScenarioOfAName) {
  reproduction::SharedWork others(1);
  reproduction::Study study({.id = "S-one"}, WorkExtent::quick, {}, fs::temp_directory_path(), others);
  const std::string swing =
      "[problem]\nname = \"pendulum\"\ninitial = { q = [1.0], p = [0.0] }\n[method]\nname = \"verlet\"\n[run]\ndt = "
      "0.1\nsteps = 3\n";
  study.run("swing", swing);
  study.run("swing", swing);  // the same one again
  EXPECT_EQ(study.scenarios().size(), 1U);
  EXPECT_THROW(study.run("swing", swing, {"run.steps=4"}), Error);
  EXPECT_THROW(study.reverse("swing", swing), Error);  // another command's
  EXPECT_THROW(study.keep_scenario("swing", "something else"), Error);
  study.keep_scenario("another", "something else");
  EXPECT_EQ(study.scenarios().size(), 2U);
}

TEST(Experiments, AreNamedByIdOrThesis) {
  EXPECT_EQ(named_experiments({"G2.9", "G2.8", "G2.9"}), (std::vector<std::string>{"G2.8", "G2.9"}));
  EXPECT_THROW(named_experiments({"G2.99"}), Error);
}

}  // namespace
}  // namespace hamflow
