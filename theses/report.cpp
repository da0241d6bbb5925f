#include "report.hpp"

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>

#include "store.hpp"

namespace hamflow::reproduction {

namespace {
using Json = nlohmann::ordered_json;

std::map<ClaimVerdict, int> counts_of(const ReproduceReport& report) {
  std::map<ClaimVerdict, int> counts;
  for (const ExperimentReport& experiment : report.experiments) {
    for (const Claim& claim : experiment.claims) ++counts[claim.judgement.verdict];
  }
  return counts;
}
}  // namespace

std::string verdicts_json(const ReproduceReport& report) {
  Json all{{"status", report.status},
           {"claims", Json::array()},
           {"verdicts", Json::object()},
           {"experiments", Json::array()}};
  const auto counts = counts_of(report);
  for (const ClaimVerdict verdict : all_claim_verdicts) {
    const auto found = counts.find(verdict);
    all["verdicts"][std::string(name(verdict))] = found == counts.end() ? 0 : found->second;
  }
  for (const ExperimentReport& experiment : report.experiments) {
    Json one{{"id", experiment.info.id},       {"thesis", experiment.info.thesis},   {"page", experiment.info.page},
             {"title", experiment.info.title}, {"size", name_of(experiment.extent)}, {"status", experiment.status}};
    if (!experiment.message.empty()) one["message"] = experiment.message;
    all["experiments"].push_back(std::move(one));
    for (const Claim& claim : experiment.claims) all["claims"].push_back(json_of(claim));
  }
  return text_of(all);
}

std::string verdicts_text(const ReproduceReport& report) {
  std::string text;
  std::size_t claims = 0;
  for (const ExperimentReport& experiment : report.experiments) {
    claims += experiment.claims.size();
    if (experiment.status == "failed") {
      text += fmt::format("{:<16}{}\n", experiment.info.id, "could not be computed: " + experiment.message);
    }
    for (const Claim& claim : experiment.claims) {
      const ClaimVerdict verdict = claim.judgement.verdict;
      if (verdict == ClaimVerdict::holds || verdict == ClaimVerdict::nothing_to_test) continue;
      text += fmt::format("{:<16}{}\n{:<16}{} ({}, p. {})\n{:<16}{}\n", name(verdict), claim.id, "", claim.statement,
                          claim.thesis, claim.page, "", claim.judgement.reason);
    }
  }
  const auto counts = counts_of(report);
  text += fmt::format("{:<16}{} of {} experiment{}\n", "claims", claims, report.experiments.size(),
                      report.experiments.size() == 1 ? "" : "s");
  for (const ClaimVerdict verdict : all_claim_verdicts) {
    const auto found = counts.find(verdict);
    text += fmt::format("{:<16}{}\n", name(verdict), found == counts.end() ? 0 : found->second);
  }
  return text;
}

}  // namespace hamflow::reproduction
