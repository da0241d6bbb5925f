#include "report.hpp"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "other_libraries.hpp"

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

Json json_of(const Compared& c) {
  return {{"method", c.comparison.method},
          {"contender", c.comparison.contender},
          {"against", {{"method", c.comparison.peer_method}, {"contender", c.comparison.peer}}},
          {"dt", std::stod(c.h_text)},
          {"per", c.comparison.per_force ? "force" : "step"},
          {"ratio", json_of(c.ratio)},
          {"goal", c.comparison.goal},
          {"met", c.met()}};
}

Json json_of(const EqualErrorComparison& race) {
  Json racers = Json::array();
  for (const Placed& r : race.placed) {
    racers.push_back({{"contender", r.name},
                      {"steps", r.steps},
                      {"error", r.error},
                      {"us", json_of(r.us)},
                      {"us_per_step", r.us.median / static_cast<double>(r.steps)},
                      {"forces_per_step", r.forces_per_step},
                      {"ratio_to_first", json_of(r.ratio)}});
  }
  return {{"course", race.course}, {"target", race.target}, {"contenders", racers}};
}

std::string text_of(const Compared& c) {
  return fmt::format("  {:36} / {:28} dt = {:5} per {:6} {:.3f} [{:.3f}, {:.3f}], goal {:.2f} {}\n",
                     c.comparison.method + " " + c.comparison.contender,
                     c.comparison.peer_method + " " + c.comparison.peer, c.h_text,
                     c.comparison.per_force ? "force" : "step", c.ratio.median, c.ratio.low, c.ratio.high,
                     c.comparison.goal, c.met() ? "met" : "MISSED");
}

std::string text_of(const EqualErrorComparison& race) {
  std::string out = fmt::format("\n{} with an error of the position of at most {:.0e}\n", race.course, race.target);
  out += fmt::format("  {:24} {:>9} {:>9} {:>11} {:>30}   {}\n", "", "steps", "error", "forces/step", "us", "ratio");
  for (const Placed& r : race.placed) {
    out += fmt::format("  {:24} {:9} {:9.1e} {:11.1f} {:12.2f} [{:.2f}, {:.2f}]   {:.2f} [{:.2f}, {:.2f}]\n", r.name,
                       r.steps, r.error, r.forces_per_step, r.us.median, r.us.low, r.us.high, r.ratio.median,
                       r.ratio.low, r.ratio.high);
  }
  return out;
}

}  // namespace

std::string as_json(const Measured& measured, const std::vector<EqualErrorComparison>& races, const Plan& plan) {
  Json document{{"benchmark", "hamflow"},
                {"machine", {{"cpu", cpu_model()}, {"threads", std::thread::hardware_concurrency()}}},
                {"compiler", compiler},
                {"build", HAMFLOW_BENCH_BUILD},
                {"flags", HAMFLOW_BENCH_FLAGS},
                {"peers", {odeint_version(), gsl_version(), arkode_version()}},
                {"rounds", plan.rounds},
                {"block_ms", plan.block_nanoseconds / 1e6},
                {"results", Json::array()},
                {"compared", Json::array()},
                {"equal_error", Json::array()}};
  for (const Table& table : measured.tables) {
    for (const Result& r : table.results) document["results"].push_back(json_of(table, r));
  }
  for (const Compared& c : measured.compared) document["compared"].push_back(json_of(c));
  for (const EqualErrorComparison& race : races) document["equal_error"].push_back(json_of(race));
  return document.dump(2);
}

std::string as_text(const Measured& measured, const std::vector<EqualErrorComparison>& races, const Plan& plan) {
  std::string out = fmt::format("{}, {}, {} ({})\n", cpu_model(), compiler, HAMFLOW_BENCH_BUILD, HAMFLOW_BENCH_FLAGS);
  out += fmt::format("{}; {}; {}
", odeint_version(), gsl_version(), arkode_version());
  out += fmt::format("{} interleaved rounds; median [quartiles]\n", plan.rounds);
  for (const Table& table : measured.tables) {
    out += fmt::format("\n{}, dt = {}, {} steps a round\n", table.method, table.h_text, table.steps);
    out += fmt::format("  {:17} {:>24} {:>9}   {}\n", "", "ns/step", "ns/force", "ratio");
    if (table.limit.median > 0) out += fmt::format("  {:17} {:7.2f}\n", "limit of the chain", table.limit.median);
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
  if (!measured.compared.empty()) out += "\nAcross methods\n";
  for (const Compared& c : measured.compared) out += text_of(c);
  for (const EqualErrorComparison& race : races) out += text_of(race);
  return out;
}

}  // namespace bench
