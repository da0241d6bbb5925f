#include "study.hpp"

#include <algorithm>

#include "hamflow/core/error.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/scenario/scenario.hpp"

namespace hamflow::reproduction {

namespace {

constexpr std::int64_t worth_a_checkpoint = 5000000;  // so many steps take some seconds

class Sampler final : public Observer {
 public:
  Sampler(Trajectory& trajectory, std::int64_t every, std::int64_t last)
      : trajectory_(trajectory), every_(every), last_(last) {}
  std::int64_t next_due(std::int64_t step) const override {
    return std::min((step + every_ - 1) / every_ * every_, std::max(step, last_));
  }
  Verdict observe(const Frame& frame) override {
    trajectory_.step.push_back(frame.step);
    trajectory_.t.push_back(frame.time);
    trajectory_.q.push_back(frame.q);
    trajectory_.p.push_back(frame.p);
    trajectory_.energy.push_back(frame.energy);
    trajectory_.invariants.push_back(frame.invariants);
    trajectory_.iterations.push_back(frame.diagnostics.iterations);
    trajectory_.condition_tangent.push_back(frame.diagnostics.condition_tangent);
    trajectory_.determinant_tangent.push_back(frame.diagnostics.determinant_tangent);
    trajectory_.condition_inverse_mass.push_back(frame.diagnostics.condition_inverse_mass);
    return Verdict::go_on;
  }

  void archive(Writer& ar) override { fields(ar); }
  void archive(Reader& ar) override { fields(ar); }

 private:
  void fields(auto& ar) {
    Trajectory& all = trajectory_;
    ar(all.step, all.t, all.q, all.p, all.energy, all.invariants, all.iterations, all.condition_tangent,
       all.determinant_tangent, all.condition_inverse_mass);
  }

  Trajectory& trajectory_;
  std::int64_t every_;
  std::int64_t last_;
};

std::vector<double> column(const std::vector<std::vector<double>>& rows, std::size_t i) {
  std::vector<double> all;
  all.reserve(rows.size());
  for (const std::vector<double>& row : rows) all.push_back(row.at(i));
  return all;
}

}  // namespace

std::vector<double> Trajectory::coordinate(std::size_t i) const { return column(q, i); }
std::vector<double> Trajectory::momentum(std::size_t i) const { return column(p, i); }

Scenario Study::read(const std::string& name, const std::string& toml, const std::vector<std::string>& sets) const {
  Reading reading = read_scenario_text(toml, info_.id + "/" + name + ".toml", sets);
  if (!reading.scenario) {
    throw Error(joined(
        reading.complaints, [](const Complaint& complaint) { return complaint.text(); }, "; "));
  }
  return *std::move(reading.scenario);
}

ReversalReport Study::reverse(const std::string& name, const std::string& toml, const std::vector<std::string>& sets) {
  const Scenario scenario = read(name, toml, sets);
  has_scenario(name, scenario.text, "reverse");
  ReversalReport report = reverse_scenario(scenario, [this](std::int64_t) { return goes_on(); });
  if (report.status == "interrupted") throw StudyInterrupted{};
  keep_scenario(name, scenario.text, "reverse");
  return report;
}

bool Study::has_scenario(const std::string& name, const std::string& text, const std::string& command) const {
  const auto kept = std::ranges::find(scenarios_, name, &StoredScenario::name);
  if (kept == scenarios_.end()) return false;
  if (kept->text == text && kept->command == command) return true;
  throw Error("two scenarios of " + info_.id + " have the name " + name + ": each is kept by its own");
}

void Study::keep_scenario(std::string name, std::string text, std::string command) {
  if (has_scenario(name, text, command)) return;
  scenarios_.push_back({std::move(name), std::move(text), std::move(command)});
}

Trajectory Study::run(const std::string& name, const std::string& toml, const std::vector<std::string>& sets) {
  Trajectory trajectory = try_run(name, toml, sets);
  if (trajectory.report.status != "done") throw Error("the run " + name + " failed: " + trajectory.report.message);
  return trajectory;
}

Trajectory Study::try_run(const std::string& name, const std::string& toml, const std::vector<std::string>& sets) {
  const Scenario scenario = read(name, toml, sets);
  has_scenario(name, scenario.text, "run");
  Trajectory trajectory;
  Sampler sampler(trajectory, scenario.record_every, scenario.steps);
  RunSettings settings;
  settings.samples = false;  // the Sampler stores them instead
  settings.observers = {&sampler};
  settings.pulse = [this](std::int64_t) { return !go_on_ || go_on_(); };
  if (scenario.steps >= worth_a_checkpoint) {
    settings.folder = folder_ / (name + ".run");
    settings.existing = std::filesystem::exists(settings.folder) ? Existing::resume : Existing::refuse;
  }
  trajectory.report = hamflow::run(scenario, settings);
  // The run finished before its experiment was killed. Its samples were not stored, so it has to run again.
  if (trajectory.report.was_complete) {
    settings.existing = Existing::replace;
    trajectory = {};
    trajectory.report = hamflow::run(scenario, settings);
  }
  if (trajectory.report.status == "interrupted") throw StudyInterrupted{};
  keep_scenario(name, scenario.text);
  return trajectory;
}

void Study::claim(const Statement& statement, const Rule& rule, std::vector<Measured> measured, Grounds grounds,
                  const std::string& decided_by) {
  Claim claim{.id = info_.id + "/" + statement.name,
              .thesis = info_.thesis,
              .page = statement.page.empty() ? info_.page : statement.page,
              .statement = statement.statement,
              .printed = statement.printed,
              .measured = std::move(measured),
              .rule = rule,
              .grounds = grounds,
              .decided_by = decided_by};
  claim.judgement = judge(rule, claim.measured, grounds);
  if (claim.judgement.verdict == ClaimVerdict::undecided && !decided_by.empty()) {
    claim.judgement.reason += "; would decide: " + decided_by;
  }
  claims_.push_back(std::move(claim));
}

void Study::nothing_to_test(const std::string& name, const std::string& why) {
  Claim claim{.id = info_.id + "/" + name,
              .thesis = info_.thesis,
              .page = info_.page,
              .statement = info_.title,
              .rule = {"none"}};
  claim.judgement = {ClaimVerdict::nothing_to_test, why};
  claims_.push_back(std::move(claim));
}

}  // namespace hamflow::reproduction
