// [Sonnleitner2010], table of page 81: digits that are lost there and back, over evaluations of pair forces; and the
// remedies of pages 80 and 81.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "../experiment.hpp"
#include "../gas_listing.hpp"
#include "../gas_runs.hpp"
#include "../next_sample.hpp"
#include "../sign_test.hpp"
#include "../t_tube_runs.hpp"

namespace hamflow::reproduction {

namespace gas_digits {

constexpr double infinite = std::numeric_limits<double>::infinity();

struct Row {
  int side;
  std::int64_t steps;
  double evaluations;  // as printed, in 10^6
  int power;           // exact to 10^power, of 10^-18
  double per_digit;    // one decimal digit is lost in so many 10^6 evaluations

  std::string name() const { return fmt::format("{}_{}", side * side, steps); }
  /// The formula that is printed beside it, 3 N^2 2 steps with N particles, in 10^6.
  double formula() const { return 3e-6 * std::pow(side, 4) * 2 * static_cast<double>(steps); }
};
constexpr Row table[] = {{11, 200, 18, -17, 60},   {11, 400, 36, -17, 65},  {11, 800, 70, -16, 60},
                         {11, 1200, 105, -15, 70}, {21, 200, 230, -15, 76}, {21, 400, 466, -13, 93},
                         {21, 800, 933, -8, 85},   {21, 1200, 1400, -3, 94}};

/// The columns of the table against each other.
void claim_columns(Study& study) {
  double off = 0;
  for (const Row& row : table) {
    off = std::max(off, std::abs(row.evaluations / row.formula() - 1));
    const double digits = 18 + row.power;
    const double value = row.evaluations / row.per_digit;
    study.claim(
        {"columns_" + row.name(),
         fmt::format("{} particles, {} steps: {} digit{} lost in {} million evaluations: one in {} million",
                     row.side * row.side, row.steps, digits, digits == 1 ? "" : "s", row.evaluations, row.per_digit),
         fmt::format("10^{} of 10^-18; 1/{}", row.power, row.per_digit)},
        within(digits, 0.5, "column 2 divided by column 4 is the number of digits lost by column 3, to half a digit"),
        {{value, value * 0.5 / row.per_digit, "of the printed numbers; +-: half a unit of column 4"}},
        Grounds::identity, "the digits lost with more places; a power of ten is printed");
  }
  study.claim({"evaluations", "the evaluations of column 2 are 3 N^2 for each of the steps there and back",
               "18, 36, 70, ..., 1400 million"},
              at_most(0.03, "largest relative distance of a printed number from its formula: two digits are printed"),
              {{off, 0, "of eight rows"}});
  study.claim({"digits", "the standard arithmetic has 18 digits", "18", "68, 81"}, as_printed("18"),
              {{digits_of(study, "double"), std::log10(2.0),
                "double: powers of 1/2 that a free motion still adds to 1; +-: one bit"}});
}

/// log10 of the mean error of positions, of several starts: of none at all minus infinity, which has no mean, of a
/// place that is no number 300.
struct Lost {
  std::vector<double> position;
  double momentum = 0;  // the largest mean error
  int outside = 0;      // of these starts, those in which a particle passes the wall

  void add(double mean_of_positions, double mean_of_momenta) {
    position.push_back(std::isfinite(mean_of_positions) ? std::log10(mean_of_positions) : 300);
    momentum = mean_of_momenta <= momentum ? momentum : mean_of_momenta;  // one that is no number is the largest
  }
};

/// Starts in which no particle passes the wall; where there are fewer than two of them, those of the listed program,
/// which does not notice.
Lost lost_by(Study& study, GasRun run, int starts) {
  Lost all, own;
  std::vector<std::pair<ListedGas, std::int64_t>> passed;
  for (run.seed = 1; run.seed <= starts; ++run.seed) {
    const Return back = there_and_back(study, run);
    if (back.done) {
      all.add(back.position, back.momentum);
    } else {
      passed.push_back({{run.scale_number(), std::stod(run.dt), back.start.q, back.start.p}, run.steps});
    }
  }
  if (all.position.size() >= 2) return all;
  for (const auto& [gas, steps] : passed) {
    const ListedReturn printed = listed_return(gas, steps, false, [&] { study.breathe(); });
    own.add(printed.position, printed.momentum);
    ++own.outside;
  }
  return own;
}

/// An error of momenta, as a power of ten where it has one.
std::string told_of(double momentum) {
  if (momentum == 0) return "0: every momentum returns";
  if (!std::isfinite(momentum)) return "not finite";
  return fmt::format("at most 10^{:.2f}", std::log10(momentum));
}

constexpr const char* no_step_of_theirs = "0.0001";

/// A row for a step size and a scale: in double, and by the listed program where a particle passes the wall.
struct Measurement {
  double mean = 0;
  double of_next = 0;  // how far one more start may be from the mean
  std::string how;
};

std::optional<Measurement> measured_row(Study& study, const Row& row, const std::string& dt, const std::string& scale) {
  const bool tunnels = dt != no_step_of_theirs;
  // Of two starts both may stay inside by chance.
  const int starts = row.side == 11 ? study.sized(tunnels ? 6 : 2, 6, 32)
                     : tunnels      ? study.sized(0, 2, 8)
                                    : study.sized(0, 4, 16);
  if (starts == 0 || (tunnels && row.steps > study.sized(200, 1200, 1200))) return {};
  const Lost lost = lost_by(study, {.side = row.side, .scale = scale, .dt = dt, .steps = row.steps}, starts);
  const Spread position = spread_of(lost.position);
  // Starts that were left out for what they do are no sample of all, to which the thesis' own belongs.
  const bool is_selected = position.members < starts;
  const std::string who =
      lost.outside > 0
          ? fmt::format("{} with particles outside, by the listing's program, which does not detect them", lost.outside)
      : is_selected ? "the starts in which no particle passes the wall, which are not a sample of all"
                    : "no particle outside in any";
  return Measurement{position.mean, is_selected ? infinite : range_of_next(position.members) * position.deviation,
                     fmt::format("{} of {} starts, {}; mean error of momenta {}", position.members, starts, who,
                                 told_of(lost.momentum))};
}

/// What three steps come to: 0.01 and 0.001, of which one is the thesis' own, and one with which no particle tunnels.
struct RowOfSteps {
  std::vector<std::pair<std::string, std::optional<Measurement>>> of_step;

  /// How far a number with the step that the thesis did not take may be from that with its own: as far as from either,
  /// as they are measured here; infinite where neither was.
  double between_steps() const {
    double farthest = -infinite;
    for (std::size_t i = 0; i + 1 < of_step.size(); ++i) {
      if (of_step[i].second && of_step.back().second)
        farthest = std::max(farthest, std::abs(of_step[i].second->mean - of_step.back().second->mean));
    }
    return std::abs(farthest);
  }
};

RowOfSteps claim_rows(Study& study, const Row& row, const std::string& scale) {
  RowOfSteps all;
  for (const char* const dt : {"0.01", "0.001", no_step_of_theirs}) {
    all.of_step.emplace_back(dt, measured_row(study, row, dt, scale));
  }
  for (const auto& [dt, found] : all.of_step) {
    const bool tunnels = dt != no_step_of_theirs;
    const double of_step = tunnels ? 0 : all.between_steps();
    std::vector<Measured> measured;
    if (found) {
      measured.push_back({found->mean, found->of_next + of_step,
                          found->how + (tunnels ? "" : fmt::format("; +- {:.3g} for the step size", of_step))});
    }
    study.claim({fmt::format("row_{}_{}_{}", row.name(), dt, scale),
                 fmt::format("{} particles, {} steps there and back, dt = {}, scale {}: power of ten of the mean error "
                             "of positions",
                             row.side * row.side, row.steps, dt, scale),
                 fmt::format("10^{}", row.power)},
                within(row.power, 0.5,
                       "a power of ten is printed; the uncertainty is the range in which another start lies with 95 %"),
                measured, Grounds::program,
                measured.empty() || !std::isfinite(of_step) ? "runs of the listed program: the default size"
                : tunnels
                    ? "the thesis' own start, which is not printed; more starts cannot decide, because they differ by "
                      "powers of ten"
                    : "the thesis' own start with its own step, 0.01 or 0.001; with this one no particle passes the "
                      "wall");
  }
  return all;
}

/// "1/94 digit in 10^6 evaluations": of the mean errors after 200 and after 1200 steps.
void claim_rate(Study& study, int side, double printed, const std::string& scale, const RowOfSteps& first_row,
                const RowOfSteps& last_row) {
  const double evaluations = 3e-6 * std::pow(side, 4) * 2 * 1000;
  std::vector<double> rates;
  const int starts = side == 11 ? study.sized(4, 16, 64) : study.sized(0, 4, 16);
  for (int seed = 1; seed <= starts; ++seed) {
    GasRun run{.side = side, .scale = scale, .steps = 200, .seed = seed};
    const Return first = there_and_back(study, run);
    run.steps = 1200;
    const Return last = there_and_back(study, run);
    if (!first.done || !last.done) continue;
    rates.push_back(std::log10(last.position / first.position) / evaluations);
  }
  const Spread rate = spread_of(rates);
  double of_step = -infinite;  // how far the rates of the thesis' own steps are from this one
  for (std::size_t i = 0; i + 1 < first_row.of_step.size(); ++i) {
    const auto &first = first_row.of_step[i].second, &last = last_row.of_step[i].second;
    if (first && last) {
      of_step = std::max(of_step, std::abs((last->mean - first->mean) / evaluations - rate.mean));
    }
  }
  of_step = std::abs(of_step);  // infinite where neither was measured
  std::vector<Measured> measured;
  if (rate.members > 1) {
    // Starts that were selected are no sample.
    measured.push_back({rate.mean, rate.members < starts ? infinite : 2 * rate.deviation + of_step,
                        fmt::format("{} of {} starts; +- {:.2g} for the step size", rate.members, starts, of_step)});
  }
  study.claim({fmt::format("rate_{}_{}", side * side, scale),
               fmt::format("{} particles: a digit is lost in {:g} million evaluations, dt = 0.0001, scale {}",
                           side * side, printed, scale),
               fmt::format("1/{:g}", printed)},
              within(1 / printed, 0.15 / printed, "digits in 10^6 evaluations; printed 1/60 to 1/70 and 1/76 to 1/94"),
              measured, Grounds::program,
              !std::isfinite(of_step) ? "runs with the thesis' own steps: the default size"
                                      : "the thesis' own step, 0.01 or 0.001, without a particle that passes the wall");
}

/// The table in hamflow's numbers, for each arithmetic, where no particle tunnels.
void compare_arithmetics(Study& study) {
  figures::Page page{study.info().title, {}};
  const char* const colours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7"};
  for (const int side : {11, 21}) {
    int number = 0;
    figures::Extent across, up;
    up.include(0);
    figures::Panel panel;
    for (const char* const arithmetic : {"double", "compensated", "double-double", "lattice"}) {
      const std::string name = arithmetic;
      const int shape = side == 11 ? 7 : 5;
      const std::int64_t most = side == 11                ? (name == "double-double" ? study.sized(0, 1200, 1200)
                                                             : name == "lattice"     ? study.sized(400, 1200, 1200)
                                                                                     : 1200)
                                : name == "double-double" ? study.sized(0, 0, 1200)
                                : name == "lattice"       ? study.sized(0, 1200, 1200)
                                                          : study.sized(200, 1200, 1200);
      std::vector<double> evaluations, digits, positions, momenta;
      bool every_bit = true;
      for (const std::int64_t steps : {200, 400, 800, 1200}) {
        if (steps > most) continue;
        const Return back = there_and_back(study, {.side = side, .steps = steps, .arithmetic = name});
        evaluations.push_back(back.pair_evaluations / 1e6),
            digits.push_back(back.done ? back.digits_lost : std::nan(""));
        positions.push_back(back.position), momenta.push_back(back.momentum);
        every_bit = every_bit && back.bit_exact;
      }
      const std::string& colour = colours[number++];
      if (name == "lattice") {
        std::vector<Measured> measured;
        if (!evaluations.empty()) measured.push_back({every_bit ? 0.0 : 1.0, 0, fmt::format("up to {} steps", most)});
        study.claim({fmt::format("lattice_{}", side * side),
                     fmt::format("{} particles: the return is exact except for rounding, so on the lattice it is exact",
                                 side * side),
                     "exact return"},
                    none_of("runs that do not return every bit"), measured, Grounds::program, "the default size");
      }
      if (evaluations.empty()) continue;
      study.keep({fmt::format("lost_{}_{}", side * side, name),
                  {{"pair_evaluations_in_millions", evaluations},
                   {"digits_lost", digits},
                   {"position_error", positions},
                   {"momentum_error", momenta}}});
      across.include_positive(evaluations);
      up.include(digits);
      panel.series.push_back({figures::Ink::marked,
                              name,
                              figures::finite_points(evaluations, digits),
                              {.colour = colour, .shape = shape}});
    }
    panel.x = figures::log_axis(across);
    panel.y = figures::fit_axis(up, figures::padding, {6});
    panel.x_label = "pair forces, in millions";
    panel.y_label = fmt::format("digits lost, {} particles", side * side);
    panel.aspect = 0.7;
    page.panels.push_back(std::move(panel));
  }
  study.draw("figure",
             "Digits lost there and back over the number of pair forces, dt = 0.0001, scale per-side. Negative: digits "
             "carried below the last one returned, too",
             std::move(page));
}

void digits(Study& study) {
  claim_columns(study);
  for (const char* const scale : {"per-side", "listing"}) {
    std::vector<RowOfSteps> rows;
    for (const Row& row : table) rows.push_back(claim_rows(study, row, scale));
    claim_rate(study, 11, 65, scale, rows.at(0), rows.at(3));
    claim_rate(study, 21, 93, scale, rows.at(4), rows.at(7));
  }
  compare_arithmetics(study);
  study.note(
      "The printed evaluations are 3 N^2 for each step, as in the listing. hamflow computes each pair force once, half "
      "as many, and the table of hamflow counts these.");
}

constexpr double until = 0.6;

/// How far a start comes before a particle is outside, as a time.
struct Inside {
  double time = 0;
  std::vector<double> q, p;  // at the start

  bool passes() const { return time < until - 1e-9; }
};

Inside time_inside(Study& study, const GasRun& asked) {
  GasRun run = asked;
  run.steps = std::llround(until / std::stod(run.dt));
  const Trajectory path = study.try_run(name_of(run), gas_scenario(run));
  return {path.report.status == "done" ? until : path.report.final.time, path.q.at(0), path.p.at(0)};
}

/// "None does" of so many starts.
void claim_none(Study& study, const Study::Statement& statement, const std::string& counted, int number, int of,
                const std::string& how = {}) {
  std::vector<Measured> measured;
  if (of > 0) {
    measured.push_back(
        seen_among(number, of,
                   fmt::format("{} of {}, to t = {}{}{}", number, of, until, how,
                               number > 0 ? ""
                                          : fmt::format("; with 95 % confidence at most {:.2g} % of all starts",
                                                        100 * largest_share_unseen(of)))));
  }
  study.claim(statement, none_of_all(counted), measured, Grounds::program,
              "59 starts without a counter-example: --full");
}

/// Page 80, remedy 1: a smaller step.
void claim_smaller_steps(Study& study, const std::string& scale) {
  const int starts = study.sized(2, 16, 64);
  int sooner = 0, inside = 0;
  Majority longer;
  for (int seed = 1; seed <= starts; ++seed) {
    GasRun run{.scale = scale, .dt = "0.01", .seed = seed};
    const Inside first = time_inside(study, run);
    Inside before = first;
    bool ends_sooner = false;
    for (const char* const dt : {"0.001", "0.0001"}) {
      run.dt = dt;
      Inside after = time_inside(study, run);
      ends_sooner = ends_sooner || after.time < before.time;
      before = std::move(after);
    }
    sooner += ends_sooner ? 1 : 0;
    inside += before.passes() ? 0 : 1;
    // The same passage is seen up to a long step earlier by the long step.
    if (std::abs(before.time - first.time) > 0.01 + 1e-9) longer.count(first.time, before.time);
  }
  claim_none(study,
             {"smaller_dt_" + scale,
              "with a tenth of the step size particles stay inside at least as long, dt = 0.01, 0.001, 0.0001, 121 "
              "particles, scale " +
                  scale,
              "remedy 1", "80"},
             "starts that end sooner with a tenth of the step size", sooner, starts);
  study.claim(
      {"smallest_dt_" + scale,
       "a smaller step size helps: with dt = 0.0001 particles stay inside longer than with 0.01, 121 particles, "
       "scale " +
           scale,
       "remedy 1: \"Zeitschritt-Verkleinerung\", without a number", "80"},
      longer.rule("starts in which they stay longer, by more than a step of 0.01,"),
      {longer.measured(fmt::format("of {} starts; {} stay inside to t = {}", starts, inside, until))}, Grounds::program,
      "more starts");
}

/// Page 80, remedy 2: a higher power of the wall, by the listed program, whose factor S^-4 stays as it is.
void claim_exponents(Study& study, const std::string& scale) {
  // "A suitable power": a start counts against it where none of several is one.
  constexpr int four = 4, others[] = {2, 8};
  const auto starts = static_cast<std::size_t>(study.sized(2, 100, 100));
  struct Found {
    bool counts = false, passes_no_later = false, passes_with_all = false, is_after_collision = false;
  };
  std::vector<Found> found(starts);
  std::vector<Inside> all;
  GasRun run{.scale = scale, .dt = "0.01"};
  for (run.seed = 1; all.size() < starts; ++run.seed) all.push_back(time_inside(study, run));
  study.each(starts, [&](std::size_t k) {
    constexpr double dt = 0.001;
    const auto with = [&](int power) {
      return passage(ListedGas(run.scale_number(), dt, all[k].q, all[k].p, power), std::llround(until / dt),
                     [&] { study.breathe(); });
    };
    const Passage low = with(1);
    if (low.step == 0) return;
    const Passage high = with(four);
    const bool passes = high.step > 0;
    if (passes && high.is_after_collision) {
      found[k].is_after_collision = true;
      return;
    }
    found[k].counts = true;
    found[k].passes_no_later = passes && high.step <= low.step;
    found[k].passes_with_all =
        passes && std::all_of(std::begin(others), std::end(others), [&](int power) { return with(power).step > 0; });
  });
  const auto count = [&](bool Found::*what) {
    return static_cast<int>(std::count_if(found.begin(), found.end(), [&](const Found& one) { return one.*what; }));
  };
  const std::string where =
      ", if one passes with the power 1; factor S^-4 of the listing, dt = 0.001, 121 particles, scale " + scale;
  const std::string how = fmt::format(
      ", by the listing's program; {} starts are not counted, because two particles came so close that the step was "
      "too "
      "long and one flew off",
      count(&Found::is_after_collision));
  claim_none(study,
             {"exponent_later_" + scale, "the power 4 in place of 1 keeps particles inside longer" + where,
              "remedy 2: -p qi/(r^2 - qi.qi)^(p + 1), without a scale", "80"},
             "starts in which a particle passes the wall no later", count(&Found::passes_no_later),
             count(&Found::counts), how);
  claim_none(study,
             {"exponent_" + scale, "with a suitable power of 2, 4, 8 in place of 1 no particle passes the wall" + where,
              "remedy 2: \"mit p >= 1 einer geeigneten Potenz\"", "80"},
             "starts in which a particle passes the wall with every power", count(&Found::passes_with_all),
             count(&Found::counts), how);
}

/// Page 81: compensation gains as many decimal digits as the step has.
struct Gains {
  std::vector<double> digits;  // of each start that keeps inside
  std::vector<double> lost;    // in double
};

Gains gains_of(Study& study, GasRun run, int starts) {
  Gains gains;
  const bool is_corner = run.start == "corner";
  for (int k = 0; k < starts; ++k) {
    if (is_corner) run.scale = fmt::format("{:.2f}", 9.7 + 0.04 * k);  // from rest: starts differ in their scale
    run.seed = k + 1;
    run.arithmetic = "double";
    const Return plain = there_and_back(study, run);
    run.arithmetic = "compensated";
    const Return compensated = there_and_back(study, run);
    if (!plain.done || !compensated.done) continue;
    gains.digits.push_back(std::log10(plain.position / compensated.position));
    gains.lost.push_back(plain.digits_lost);
  }
  return gains;
}

void claim_gain(Study& study, const GasRun& run, int digits) {
  const int starts = run.steps <= study.sized(2000, 20000, 20000) ? study.sized(3, 8, 32) : 0;
  const Gains gains = gains_of(study, run, starts);
  const Spread gain = spread_of(gains.digits);
  std::vector<Measured> measured;
  if (gain.members > 1) {
    const bool is_selected = gain.members < starts;
    measured.push_back(
        {gain.mean, is_selected ? infinite : 3 * gain.standard_error(),
         fmt::format("{} of {} starts, {} steps, {:.2g} digits lost in double{}", gain.members, starts, run.steps,
                     spread_of(gains.lost).mean, is_selected ? "; in the others a particle passes the wall" : "")});
  }
  study.claim(
      {fmt::format("compensation_{}_{}", run.start, run.dt),
       fmt::format("compensated summation gains about as many digits as dt = {} has decimal places: {}; start {}",
                   run.dt, digits, run.start),
       fmt::format("{} digits", digits), "81"},
      within(digits, 1, "digits gained in positions, to one digit"), measured, Grounds::program,
      starts == 0 ? "the default size" : "more starts, if all particles stay inside");
}

void remedies_and_compensation(Study& study) {
  for (const char* const scale : {"per-side", "listing"}) {
    claim_smaller_steps(study, scale);
    claim_exponents(study, scale);
  }
  // From rest in the corner nothing passes with any of these steps. Of the square's starts none does in a time in which
  // few reach the wall.
  claim_gain(study, {.start = "corner", .dt = "0.01", .steps = 180}, 2);
  claim_gain(study, {.start = "corner", .dt = "0.001", .steps = 1800}, 3);
  claim_gain(study, {.start = "corner", .dt = "0.0001", .steps = 18000}, 4);
  claim_gain(study, {.dt = "0.001", .steps = 60}, 3);
  claim_gain(study, {.dt = "0.0001", .steps = 600}, 4);
  const GasRun thin{.dt = "0.001", .exponent = 4, .steps = 1200};
  const Spread beside = spread_of(gains_of(study, thin, study.sized(2, 4, 8)).digits);
  study.note(fmt::format(
      "Compensation corrects the sums q + dt p and p + dt K, but not the forces, which are computed at rounded "
      "positions. If a particle turns round within a few steps, dt K is as large as p and rounds as much as the sum. "
      "After bounces off a thin wall (e = 4 in hamflow, proportional to 1/S^10) the starts of the square gain only "
      "{:.2g} digits with dt = 0.001 ({} steps, {} starts). The gain is therefore measured before most particles "
      "bounce.",
      beside.mean, thin.steps, beside.members));
  study.note(
      "Page 80 writes the wall's force without a scale, page 74 with SkalierFaktor^-4. The powers are judged with this "
      "factor. hamflow's container has the factor 1/S^(2 + 2e), which follows from lengths S q. At S = 60 a higher "
      "power then makes the wall thinner than a step, which the thesis does not mention.");
}

}  // namespace gas_digits

std::vector<Experiment> gas_digits_experiments() {
  using namespace gas_digits;
  return {{{"S-T81", sonnleitner, "81", "gas: digits lost over evaluations of forces"}, digits},
          {{"S-C80", sonnleitner, "80, 81", "gas: remedies of tunnelling and of rounding"}, remedies_and_compensation}};
}

}  // namespace hamflow::reproduction
