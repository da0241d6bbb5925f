#include "report.hpp"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

namespace bench {

namespace {

using Json = nlohmann::ordered_json;

std::string cpu_model() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

constexpr const char* compiler =
#ifdef __clang__
    "clang " __clang_version__;
#else
    "gcc " __VERSION__;
#endif

Json json_of(const Spread& s) { return {{"median", s.median}, {"quartiles", {s.low, s.high}}}; }

Json json_of(const Table& table, const Result& r) {
  Json entry{{"method", table.method},
             {"dt", std::stod(table.h_text)},
             {"contender", r.contender},
             {"steps", table.steps},
             {"limit_ns_per_step", table.limit.median},
             {"ns_per_step", json_of(r.ns_per_step)},
             {"ns_per_force", json_of(r.ns_per_force)},
             {"forces_per_step", r.forces_per_step},
             {"end_state_difference", r.difference}};
  if (!r.against.empty()) {
    entry["against"] = r.against;
    entry["ratio"] = json_of(r.ratio);
  }
  if (r.goal > 0) {
    entry["goal"] = r.goal;
    entry["met"] = r.ratio.median <= r.goal;
  }
  return entry;
}

}  // namespace

std::string as_json(const std::vector<Table>& tables, const Plan& plan) {
  Json document{{"benchmark", "hamflow"},
                {"machine", {{"cpu", cpu_model()}, {"threads", std::thread::hardware_concurrency()}}},
                {"compiler", compiler},
                {"build", HAMFLOW_BENCH_BUILD},
                {"flags", HAMFLOW_BENCH_FLAGS},
                {"rounds", plan.rounds},
                {"block_ms", plan.block_nanoseconds / 1e6},
                {"results", Json::array()}};
  for (const Table& table : tables) {
    for (const Result& r : table.results) document["results"].push_back(json_of(table, r));
  }
  return document.dump(2);
}

std::string as_text(const std::vector<Table>& tables, const Plan& plan) {
  std::string out = fmt::format("{}, {}, {} ({})\n{} interleaved rounds; median [quartiles]\n", cpu_model(), compiler,
                                HAMFLOW_BENCH_BUILD, HAMFLOW_BENCH_FLAGS, plan.rounds);
  for (const Table& table : tables) {
    out += fmt::format("\n{}, dt = {}, {} steps a round\n", table.method, table.h_text, table.steps);
    out += fmt::format("  {:17} {:>24} {:>9}   {}\n", "", "ns/step", "ns/force", "ratio");
    out += fmt::format("  {:17} {:8.2f}\n", "limit of the chain", table.limit.median);
    for (const Result& r : table.results) {
      out += fmt::format("  {:17} {:8.2f} [{:6.2f}, {:6.2f}] {:9.2f}", r.contender, r.ns_per_step.median,
                         r.ns_per_step.low, r.ns_per_step.high, r.ns_per_force.median);
      if (!r.against.empty()) {
        out += fmt::format("   {:.3f} [{:.3f}, {:.3f}] x {}", r.ratio.median, r.ratio.low, r.ratio.high, r.against);
      }
      if (r.goal > 0) out += fmt::format(", goal {:.2f} {}", r.goal, r.ratio.median <= r.goal ? "met" : "MISSED");
      if (r.difference > 0) out += fmt::format(", end state {:.1e} apart", r.difference);
      out += "\n";
    }
  }
  return out;
}

}  // namespace bench
