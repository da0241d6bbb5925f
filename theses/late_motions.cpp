#include "late_motions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "claim.hpp"

namespace hamflow::reproduction {

Exponents exponents_from(Study& study, const TubeSet& set, const TubeWatch& seen, const std::string& name,
                         std::int64_t steps) {
  std::vector<std::string> sets{"run.lyapunov=1"};
  for (const std::string& one : set.sets) {
    if (!one.starts_with("run.arithmetic=")) sets.push_back(one);
  }
  const auto over = [&](std::int64_t length, const char* which) {
    const Trajectory run = study.try_run(fmt::format("{}_{}", name, which),
                                         scenario_of_start(set, seen.start, length, seen.q, seen.p), sets);
    if (run.report.status != "done") return std::numeric_limits<double>::infinity();
    return run.report.summary.lyapunov.value().exponents.at(0);
  };
  return {over(steps, "shorter"), over(4 * steps, "longer"), static_cast<double>(steps) * std::stod(set.run.dt)};
}

std::int64_t steps_in_true_flow(const Study& study) { return study.sized<std::int64_t>(10000, 50000, 200000); }

namespace {

double median(std::vector<double> numbers) {
  if (numbers.empty()) return std::nan("");
  std::sort(numbers.begin(), numbers.end());
  return numbers[numbers.size() / 2];
}

/// @param moved the shift of Q1
std::string initial_of(const LateMotion& late, double moved) {
  const std::vector<double>&q = late.q, &p = late.p;
  return fmt::format("problem.initial={{ q = [{:.17g}, {:.17g}], p = [{:.17g}, {:.17g}] }}", q[0] + moved, q[1], p[0],
                     p[1]);
}

/// The median distance of two neighbours in the second half of a run, divided by their distance at the start. It grows
/// linearly for regular motions. For chaotic ones it saturates near 1/shift, the size of the domain.
double parting(Study& study, const std::string& name, TubeRun run, const LateMotion& late, double shift) {
  run.eps = late.eps;
  run.steps = study.sized<std::int64_t>(20000, 100000, 1000000);
  run.record_every = run.steps / 200;
  const auto from = [&](double moved, const std::string& which) {
    return study.run(fmt::format("{}_{}_{}", late.name, name, which), tube_scenario(run), {initial_of(late, moved)});
  };
  const Trajectory one = from(0, "one"), other = from(shift, "other");
  std::vector<double> all;
  for (std::size_t k = 101; k < std::min(one.size(), other.size()); ++k) {
    all.push_back(std::hypot(one.q[k][0] - other.q[k][0], one.q[k][1] - other.q[k][1]));
  }
  return median(all) / std::abs(shift);
}

/// As parting() for a shift of 1e-9. The uncertainty is the difference to a shift of 2e-9.
Measured measured_separation(Study& study, const std::string& name, const TubeRun& run, const LateMotion& late,
                             const std::string& how) {
  const double one = parting(study, name, run, late, 1e-9), other = parting(study, name + "_wider", run, late, 2e-9);
  return {one, std::abs(one - other), how};
}

/// Measures how far from a late motion other motions are regular, by their own exponents: with the rule of the listing,
/// and in the true flow, with located bounces.
void tabulate_neighbourhood(Study& study, const LateMotion& late, TextTable& table) {
  std::vector<double> shifts{0};
  if (study.sized(0, 1, 1) > 0) shifts = {0, 1e-4, 1e-3, 1e-2, 0.1};
  for (const char* const rule : {"reject", "event"}) {
    for (const double moved : shifts) {
      TubeWatch beside{.start = {.eps = late.eps}, .q = late.q, .p = late.p};
      beside.q[0] += moved;
      const std::string name = fmt::format("{}_{}_moved_{:g}", late.name, rule, moved);
      const Exponents of = exponents_from(study, {.run = {.rule = rule}}, beside, name, steps_in_true_flow(study));
      table.rows.push_back({late.name, rule, fmt::format("{:g}", moved), fmt::format("{:.2g}", of.shorter),
                            fmt::format("{:.2g}", of.longer), of.regular() ? "yes" : "no"});
    }
  }
}

/// A motion takes up to 910 time units for one round. Exponents mean something only after a few rounds.
constexpr double least_time_for_exponents = 2000;

/// Claims that a late motion is regular with the rule of the listing. It uses a tangent vector of the motion itself.
/// Neighbours at a finite distance could leave the regular set, whose width is unknown.
void claim_regular(Study& study, const LateMotion& late) {
  const auto steps = study.sized<std::int64_t>(20000, 200000, 1000000);
  const double time = 4 * 0.01 * static_cast<double>(steps);
  std::vector<Measured> measured;
  if (time >= least_time_for_exponents) {
    const TubeWatch own{.start = {.eps = late.eps}, .q = late.q, .p = late.p};
    const Exponents of =
        exponents_from(study, {.run = {.rule = "reject"}}, own, std::string(late.name) + "_own", steps);
    const auto units = [](double exponent, double t) { return std::abs(exponent) * t / std::log(t); };
    const double longer = units(of.longer, time), shorter = units(of.shorter, time / 4);
    if (std::isfinite(longer) && std::isfinite(shorter)) {  // a failed run gives no measurement
      measured.push_back({longer, std::abs(longer - shorter),
                          fmt::format("exponents {:.2g} over {:g} and {:.2g} over {:g} time units, reject, dt = 0.01",
                                      of.shorter, time / 4, of.longer, time)});
    }
  }
  study.claim(
      {fmt::format("regular_{}", late.name),
       fmt::format("a late motion of {} is regular, with the rule of the listing", late.name), "regular"},
      at_most(3,
              "largest Lyapunov exponent divided by log T/T: 1 if tangent vectors grow like t; above 30 for a chaotic "
              "motion"),
      measured, Grounds::program,
      fmt::format("{:g} time units, a few rounds: the default size", least_time_for_exponents));
}

}  // namespace

void claim_late_motions(Study& study) {
  const double time = 0.01 * static_cast<double>(steps_in_true_flow(study));
  TextTable table{
      "neighbourhood",
      "Neighbours of a late motion, with Q1 moved: with the rule of the listing, and with located bounces (stv4)",
      {"late motion of", "rule", "moved by", fmt::format("exponent over {:g} time units", time),
       fmt::format("over {:g}", 4 * time), "regular (at most 3 log T/T)"},
      {}};
  TextTable partings{
      "partings",
      "Distance of neighbours of a late motion in the second half of a run, divided by their distance at the start; "
      "rule reject. Neighbours of a chaotic motion end as far apart as the domain allows",
      {"late motion of"},
      {}};
  const std::vector<double> shifts{1e-11, -1e-11, 1e-9, -1e-9, 1e-7, -1e-7, 1e-5, 1e-3};
  for (const double shift : shifts) partings.headings.push_back(fmt::format("moved by {:.0e}", shift));
  for (const LateMotion& late : late_motions(study)) {
    claim_regular(study, late);
    study.claim({fmt::format("true_flow_{}", late.name),
                 fmt::format("a late motion of {} is a regular orbit of the true flow", late.name), "an island"},
                at_most(1e6,
                        "growth of the distance of neighbours that start 1e-9 apart; in a chaotic motion it grows "
                        "3e8 times and more"),
                {measured_separation(study, "element", {.rule = "event", .method = "cg(3)"}, late,
                                     "continued with cg(3) and event, dt = 0.01"),
                 measured_separation(study, "event", {.rule = "event"}, late, "with stv4 and event")},
                Grounds::program, "longer runs, --full");
    std::vector<std::string> row{late.name};
    for (const double shift : shifts) {
      row.push_back(fmt::format("{:.3g}", parting(study, fmt::format("reject_{:.0e}", shift), {}, late, shift)));
    }
    partings.rows.push_back(std::move(row));
    tabulate_neighbourhood(study, late, table);
  }
  study.table(std::move(partings));
  study.table(std::move(table));
}

}  // namespace hamflow::reproduction
