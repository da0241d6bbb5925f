// hamflow_bench: hamflow beside hand-written loops, in one process. See README.md.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>

#include "report.hpp"

namespace bench {

Task kepler_task(const std::string& h_text) {
  constexpr double mass = 2, k = 1, pericentre = 1, apocentre = 3;
  const double momentum = std::sqrt(2 * k * mass * pericentre * apocentre / (pericentre + apocentre));
  return {mass, k, {{pericentre, 0}, {0, momentum / pericentre}}, std::stod(h_text), h_text};
}

}  // namespace bench

int main(int argc, char** argv) try {
  bench::Plan plan;
  bool json = false;
  bool quick = false;
  std::string only;
  CLI::App app("Times hamflow beside hand-written loops; ratios of medians of interleaved rounds.", "hamflow_bench");
  app.add_flag("--json", json, "write JSON instead of a table");
  app.add_flag("--quick", quick, "few and short rounds: a first look, not a measurement");
  app.add_option("--only", only, "only this method, e.g. stv4");
  const auto* rounds = app.add_option("--rounds", plan.rounds, "rounds")->check(CLI::Range(1, 10000));
  CLI11_PARSE(app, argc, argv);
  if (quick) {
    plan.block_nanoseconds = 3e6;
    if (rounds->count() == 0) plan.rounds = 5;
  }

  std::vector<bench::Workload> workloads;
  for (const char* h : {"0.1", "0.01"}) {
    const bench::Task task = bench::kepler_task(h);
    for (auto&& some : {bench::explicit_workloads(task), bench::element_workloads(task)}) {
      for (const bench::Workload& workload : some) {
        if (only.empty() || workload.method == only) workloads.push_back(workload);
      }
    }
  }
  if (workloads.empty()) throw std::runtime_error("no workload of the method '" + only + "'");
  const auto tables = bench::measure(workloads, plan);
  fmt::print("{}\n", json ? bench::as_json(tables, plan) : bench::as_text(tables, plan));
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "hamflow_bench: {}\n", error.what());
  return 1;
}
