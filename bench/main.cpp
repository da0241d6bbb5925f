// hamflow_bench compares hamflow with hand-written loops and other libraries in one process. See README.md.
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

Task unit_task(double h) {
  constexpr double pericentre = 0.4, apocentre = 1.6;
  const double momentum = std::sqrt(2 * pericentre * apocentre / (pericentre + apocentre));
  return {1, 1, {{pericentre, 0}, {0, momentum / pericentre}}, h, {}};
}

namespace {

/// The goal of these comparisons: hamflow is not slower than another library with the same method.
std::vector<Comparison> comparisons() {
  std::vector<Comparison> all{{"euler-a", "typed", "euler-a", "odeint"},
                              {"verlet", "typed", "verlet", "odeint"},
                              {"sb3a_m4", "typed", "sb3a_m4", "odeint"},
                              {"sb3a", "typed", "sb3a", "odeint"},
                              {"rk4", "typed", "rk4", "odeint"},
                              {"rk4", "typed", "rk4", "gsl"},
                              {"stv4", "typed", "sb3a_m4", "odeint", true},
                              {"stv4", "typed", "verlet", "odeint", true},
                              {"cg(1,1)", "typed", "cg(1,1)", "gsl"},
                              {"cg(1,5)", "typed", "cg(1,1)", "gsl"},
                              {"cg(1,5)", "typed", "cg(1,5)", "hand, two lanes", false, 1.15},
                              {"cg(1,5)", "typed", "cg(1,1)", "arkode", false, 0.2}};
  return all;
}

}  // namespace

}  // namespace bench

int main(int argc, char** argv) try {
  bench::Plan plan;
  bool json = false;
  bool quick = false;
  std::string only;
  CLI::App app("Times hamflow beside hand-written loops; ratios of medians of interleaved rounds.", "hamflow_bench");
  app.add_flag("--json", json, "write JSON instead of a table");
  app.add_flag("--quick", quick, "few and short rounds: a first look, not a measurement");
  app.add_option("--only", only, "only this method, e.g. stv4, or bodies, t-tube, equal-error, ellipse, planets");
  const auto* rounds = app.add_option("--rounds", plan.rounds, "rounds")->check(CLI::Range(1, 10000));
  CLI11_PARSE(app, argc, argv);
  if (quick) {
    plan.block_nanoseconds = 3e6;
    if (rounds->count() == 0) plan.rounds = 5;
  }

  std::vector<bench::Workload> workloads;
  for (const char* h : {"0.1", "0.01"}) {
    const bench::Task task = bench::kepler_task(h);
    for (auto&& some :
         {bench::explicit_workloads(task), bench::order_eight_workloads(task), bench::element_workloads(task)}) {
      for (const bench::Workload& workload : some) {
        if (only.empty() || workload.method == only) workloads.push_back(workload);
      }
    }
  }
  for (const bench::Workload& workload : bench::body_workloads()) {
    if (only.empty() || only == "bodies") workloads.push_back(workload);
  }
  for (const bench::Workload& workload : bench::tube_workloads()) {
    if (only.empty() || only == workload.method) workloads.push_back(workload);
  }
  std::vector<bench::Course> courses;
  if (only.empty() || only == "equal-error" || only == "ellipse") courses.push_back(bench::ellipse());
  if (only.empty() || only == "equal-error" || only == "planets") courses.push_back(bench::outer_planets());
  if (workloads.empty() && courses.empty()) throw std::runtime_error("no workload of the method '" + only + "'");
  const auto measured = bench::measure(workloads, bench::comparisons(), plan);
  std::vector<bench::EqualErrorComparison> races;
  for (const bench::Course& course : courses) {
    for (const bench::EqualErrorComparison& one : bench::race(plan, course)) races.push_back(one);
  }
  fmt::print("{}\n", json ? bench::as_json(measured, races, plan) : bench::as_text(measured, races, plan));
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "hamflow_bench: {}\n", error.what());
  return 1;
}
