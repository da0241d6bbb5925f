#include "t_tube_runs.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "hamflow/core/error.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/workflow/sweep.hpp"
#include "json_text.hpp"

namespace hamflow::reproduction {

std::string name_of(const TubeRun& run) {
  return fmt::format("{:+.1f} v=({},{}) {} {} {}", run.eps, run.v1, run.v2, run.rule, run.method, run.dt);
}

std::string tube_scenario(const TubeRun& run) {
  return fmt::format(
      "[problem]\nname = \"t-tube\"\neps = {}\nmasses = [1, 100]\ninitial = {{ q = [0.01, 1.1], v = [{}, {}] "
      "}}\nwall_rule = \"{}\"\n\n[method]\nname = \"{}\"\n\n[run]\ndt = \"{}\"\nsteps = {}\nrecord_every = {}\n",
      run.eps, run.v1, run.v2, run.rule, run.method, run.dt, run.steps,
      run.record_every > 0 ? run.record_every : std::max<std::int64_t>(run.steps, 1));
}

std::vector<TubeMember> ensemble(Study& study, const TubeRun& run, const std::vector<std::string>& varied) {
  SweepRequest request;
  request.text = tube_scenario(run);
  request.name = name_of(run);
  request.varied = varied;
  request.threads = 1;
  ScenarioSweep sweep(request);
  if (!sweep.complaints().empty()) {
    throw Error(joined(
        sweep.complaints(), [](const std::string& complaint) { return complaint; }, "; "));
  }
  const SweepReport report = sweep.run([&](std::int64_t) { return study.goes_on(); });
  if (report.status == "interrupted") throw Stopped{};
  const auto table = read_json(sweep.json_with_rows(report));
  std::vector<TubeMember> members;
  for (const auto& row : table.at("rows")) {
    TubeMember member;
    member.done = row.at("status") == "done";
    if (member.done) {
      member.kinetic1 = row.at("kinetic1_initial");
      member.kinetic2 = row.at("kinetic2_initial");
      member.change1 = row.at("kinetic1_mean").get<double>() - member.kinetic1;
      member.change2 = row.at("kinetic2_mean").get<double>() - member.kinetic2;
      member.energy_error = row.at("energy").at("max_error").get<double>() / row.at("energy").at("scale").get<double>();
      member.q = row.at("final").at("q").get<std::vector<double>>();
      member.p = row.at("final").at("p").get<std::vector<double>>();
    }
    members.push_back(std::move(member));
  }
  return members;
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
