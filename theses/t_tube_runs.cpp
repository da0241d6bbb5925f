#include "t_tube_runs.hpp"

#include <fmt/format.h>

#include <cmath>

#include "hamflow/core/error.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/workflow/sweep.hpp"
#include "scenarios.hpp"

namespace hamflow::reproduction {

std::string name_of(const TubeRun& run) {
  return fmt::format("{:+.1f} v=({},{}) {} {} {}", run.eps, run.v1, run.v2, run.rule, run.method, run.dt);
}

std::string tube_scenario_from(const TubeRun& run, const std::string& start) {
  std::vector<std::string> sets =
      in_steps(run.dt, run.steps, run.record_every > 0 ? run.record_every : std::max<std::int64_t>(run.steps, 1));
  for (const std::string& one : {fmt::format("problem.eps={}", run.eps), fmt::format("problem.initial={{ {} }}", start),
                                 "problem.wall_rule=" + run.rule, "method.name=" + run.method}) {
    sets.push_back(one);
  }
  return scenario_of("t_tube", sets);
}

namespace {

std::vector<TubeMember> members_of(Study& study, SweepRequest request) {
  request.threads = 1;
  ScenarioSweep sweep(request);
  if (!sweep.complaints().empty()) {
    throw Error(joined(
        sweep.complaints(), [](const Complaint& complaint) { return complaint.text(); }, "; "));
  }
  const SweepReport report = sweep.run([&](std::int64_t) { return study.goes_on(); });
  if (report.status == "interrupted") throw StudyInterrupted{};
  const Table table = sweep.members();
  std::vector<TubeMember> members(table.rows());
  for (std::size_t k = 0; k < members.size(); ++k) {
    TubeMember& member = members[k];
    const auto number = [&](const char* column) { return table[column].numbers()[k]; };
    member.done = table["member/status"].text(k) == "done";
    if (!member.done) continue;
    member.kinetic1 = number("observables/kinetic1_initial");
    member.kinetic2 = number("observables/kinetic2_initial");
    member.change1 = number("observables/kinetic1_mean") - member.kinetic1;
    member.change2 = number("observables/kinetic2_mean") - member.kinetic2;
    member.energy_error = number("energy/max_error") / number("energy/scale");
    member.q = table["final/q"].row(k);
    member.p = table["final/p"].row(k);
  }
  return members;
}

}  // namespace

std::string tube_scenario(const TubeRun& run) {
  return tube_scenario_from(run, fmt::format("q = [0.01, 1.1], v = [{}, {}]", run.v1, run.v2));
}

std::vector<TubeMember> ensemble(Study& study, const TubeRun& run, const std::vector<std::string>& varied) {
  return members_of(study, {.text = tube_scenario(run), .name = name_of(run), .varied = varied});
}

std::vector<TubeMember> continued(Study& study, const TubeRun& run, const std::vector<TubeMember>& members) {
  std::string starts[4];
  for (const TubeMember& member : members) {
    if (!member.done) continue;
    const double numbers[] = {member.q[0], member.q[1], member.p[0], member.p[1]};
    for (std::size_t k = 0; k < 4; ++k) starts[k] += fmt::format("{}{:.17g}", starts[k].empty() ? "" : ",", numbers[k]);
  }
  std::vector<TubeMember> all(members.size());
  if (starts[0].empty()) return all;
  const char* const keys[] = {"q[0]", "q[1]", "p[0]", "p[1]"};
  SweepRequest request{
      .text = tube_scenario_from(run, "q = [0.01, 1.1], p = [0, 0]"), .name = name_of(run), .zip = true};
  for (std::size_t k = 0; k < 4; ++k)
    request.varied.push_back(fmt::format("problem.initial.{}={}", keys[k], starts[k]));
  const std::vector<TubeMember> further = members_of(study, request);
  std::size_t next = 0;
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (members[i].done) all[i] = further.at(next++);
  }
  return all;
}

double Spread::standard_error() const { return members > 0 ? deviation / std::sqrt(members) : std::nan(""); }

Spread spread_of(const std::vector<double>& numbers) {
  Spread spread;
  double sum = 0, squares = 0;
  for (const double x : numbers) sum += x;
  spread.members = static_cast<int>(numbers.size());
  spread.mean = sum / spread.members;
  for (const double x : numbers) squares += (x - spread.mean) * (x - spread.mean);
  spread.deviation = spread.members > 1 ? std::sqrt(squares / (spread.members - 1)) : std::nan("");
  return spread;
}

}  // namespace hamflow::reproduction
