// [Sonnleitner2010], table of page 81: digits that are lost there and back, over evaluations of pair forces; and the
// remedies of pages 80 and 81.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "../chance.hpp"
#include "../experiment.hpp"
#include "../gas_listing.hpp"
#include "../gas_runs.hpp"
#include "../next_sample.hpp"
#include "../t_tube_runs.hpp"

namespace hamflow::reproduction {

namespace gas_digits {

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
    const double value = row.evaluations / digits;
    // A power of ten may be a rounded one: numbers that agree as they stand do so for certain, others may yet.
    const double rounded = row.evaluations / (digits - 0.5) - value;
    const bool agrees = std::abs(value - row.per_digit) <= 1;
    study.claim(
        {"columns_" + row.name(),
         fmt::format("{} particles, {} steps: {} digit{} lost in {} million evaluations: one in {} million",
                     row.side * row.side, row.steps, digits, digits == 1 ? "" : "s", row.evaluations, row.per_digit),
         fmt::format("10^{} of 10^-18; 1/{}", row.power, row.per_digit)},
        within(row.per_digit, 1,
               "column 2 over the digits of column 3 against column 4, to one unit, as in three rows of 441"),
        {{value, agrees ? 0 : rounded,
          fmt::format("of the printed numbers; {:.3g} to {:.3g} if the power of ten were a rounded one",
                      row.evaluations / (digits + 0.5), row.evaluations / (digits - 0.5))}},
        Grounds::identity, "the digits lost, which are printed as a power of ten");
  }
  study.claim({"evaluations", "the evaluations of column 2 are 3 N^2 for each of the steps there and back",
               "18, 36, 70, ..., 1400 million"},
              at_most(0.03, "largest relative distance of a printed number from its formula: two digits are printed"),
              {{off, 0, "of eight rows"}});
  study.claim({"digits", "the standard arithmetic has 18 digits", "18", "68, 81"}, as_printed("18"),
              {{53 * std::log10(2.0), 0, "double: 53 bits"}}, Grounds::identity);
}

/// log10 of the mean error of positions, of several starts: of none at all minus infinity, which has no mean, of a
/// place that is no number 300.
struct Lost {
  std::vector<double> position;
  double momentum = 0;  // the largest mean error
  int outside = 0;      // starts in which a particle passes the wall
};

/// Only starts in which no particle passes the wall count; where there are fewer than two of them, those of the listed
/// program, which does not notice.
Lost lost_by(Study& study, GasRun run, int starts) {
  Lost all, own;
  const auto add = [](Lost& to, double position, double momentum) {
    to.position.push_back(std::isfinite(position) ? std::log10(position) : 300);
    to.momentum = momentum <= to.momentum ? to.momentum : momentum;  // one that is no number is the largest
  };
  std::vector<std::pair<ListedGas, std::int64_t>> passed;
  for (run.seed = 1; run.seed <= starts; ++run.seed) {
    const Return back = there_and_back(study, run);
    if (back.done) {
      add(all, back.position, back.momentum);
    } else {
      passed.push_back({{run.scale_number(), std::stod(run.dt), back.start.q, back.start.p}, run.steps});
    }
  }
  if (all.position.size() >= 2) return all;
  for (const auto& [gas, steps] : passed) {
    const ListedReturn printed = listed_return(gas, steps, false, [&] { study.breathe(); });
    add(own, printed.position, printed.momentum);
    ++own.outside;
  }
  return own;
}

/// An error of momenta, as a power of ten where it has one.
std::string told_of(double momentum) {
  if (momentum == 0) return "0: every one returns";
  if (!std::isfinite(momentum)) return "none is a number";
  return fmt::format("at most 10^{:.2f}", std::log10(momentum));
}

/// A row for a step length and a scale: in double, and by the listed program where a particle passes the wall.
void claim_row(Study& study, const Row& row, const std::string& dt, const std::string& scale) {
  const bool tunnels = dt != "0.0001";
  const int starts = row.side == 11 ? study.sized(2, 6, 32) : tunnels ? study.sized(0, 2, 8) : study.sized(0, 4, 16);
  const bool is_short = tunnels ? row.steps <= study.sized(200, 1200, 1200) : true;
  std::vector<Measured> measured;
  if (starts > 0 && is_short) {
    const GasRun run{.side = row.side, .scale = scale, .dt = dt, .steps = row.steps};
    const Lost lost = lost_by(study, run, starts);
    const Spread position = spread_of(lost.position);
    const std::string who = lost.outside == 0 ? "none with a particle outside"
                                              : fmt::format(
                                                    "{} with particles outside, by the listing's program, "
                                                    "which does not notice",
                                                    lost.outside);
    Measured one{
        position.mean, range_of_next(position.members) * position.deviation,
        fmt::format("{} of {} starts, {}; of momenta {}", position.members, starts, who, told_of(lost.momentum))};
    // With a step that the thesis did not take a row may come out as printed; where it does not nothing follows.
    if (!tunnels && std::abs(one.value - row.power) > 0.5) one.uncertainty = std::numeric_limits<double>::infinity();
    measured.push_back(std::move(one));
  }
  study.claim({fmt::format("row_{}_{}_{}", row.name(), dt, scale),
               fmt::format("{} particles, {} steps there and back, dt = {}, scale {}: power of ten of the mean error "
                           "of positions",
                           row.side * row.side, row.steps, dt, scale),
               fmt::format("10^{}", row.power)},
              within(row.power, 0.5,
                     "a power of ten is printed; the thesis' start is one of many: where another one may lie, 95 %"),
              measured, Grounds::program,
              measured.empty() ? "runs of the listed program: the default size"
              : tunnels ? "the thesis' own start, which is not printed; more starts do not, where one differs from the "
                          "next by powers of ten"
                        : "the thesis' own start with its own step, 0.01 or 0.001; with this one no particle passes "
                          "the wall");
}

/// "1/94 digit in 10^6 evaluations": of the mean errors after 200 and after 1200 steps.
void claim_rate(Study& study, int side, double printed, const std::string& scale) {
  std::vector<double> rates;
  for (int seed = 1; seed <= (side == 11 ? study.sized(4, 16, 64) : study.sized(0, 4, 16)); ++seed) {
    GasRun run{.side = side, .scale = scale, .steps = 200, .seed = seed};
    const Return first = there_and_back(study, run);
    run.steps = 1200;
    const Return last = there_and_back(study, run);
    if (!first.done || !last.done) continue;
    const double evaluations = 3e-6 * std::pow(side, 4) * 2 * 1000;
    rates.push_back(std::log10(last.position / first.position) / evaluations);
  }
  const Spread rate = spread_of(rates);
  std::vector<Measured> measured;
  const Rule rule =
      within(1 / printed, 0.15 / printed, "digits in 10^6 evaluations; printed 1/60 to 1/70 and 1/76 to 1/94");
  if (rate.members > 1) {
    const bool is_theirs = rate.mean >= rule.low && rate.mean <= rule.high;
    measured.push_back({rate.mean, is_theirs ? 2 * rate.deviation : std::numeric_limits<double>::infinity(),
                        fmt::format("{} starts", rate.members)});
  }
  study.claim({fmt::format("rate_{}_{}", side * side, scale),
               fmt::format("{} particles: a digit is lost in {:g} million evaluations, dt = 0.0001, scale {}",
                           side * side, printed, scale),
               fmt::format("1/{:g}", printed)},
              rule, measured, Grounds::program,
              measured.empty() ? "more starts: the default size"
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
        study.claim(
            {fmt::format("lattice_{}", side * side),
             fmt::format("{} particles: the return is exact but for rounding: on the lattice it is exact", side * side),
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
    panel.x_label = "pair forces computed, in millions";
    panel.y_label = fmt::format("digits lost, {} particles", side * side);
    panel.aspect = 0.7;
    page.panels.push_back(std::move(panel));
  }
  study.draw("figure",
             "Digits lost there and back over pair forces computed, dt = 0.0001, scale per-side; below 0: what is "
             "carried below the last digit came back too",
             std::move(page));
}

void digits(Study& study) {
  claim_columns(study);
  for (const char* const scale : {"per-side", "listing"}) {
    for (const Row& row : table) {
      for (const char* const dt : {"0.01", "0.001", "0.0001"}) claim_row(study, row, dt, scale);
    }
    claim_rate(study, 11, 65, scale);
    claim_rate(study, 21, 93, scale);
  }
  compare_arithmetics(study);
  study.note(
      "Printed evaluations are 3 N^2 for each step, as listed; hamflow computes each force once, half as many, which "
      "its own table counts.");
}

/// The steps to t = 0.6 that a start takes before a particle is outside, as a time.
double time_inside(Study& study, const GasRun& asked) {
  GasRun run = asked;
  const double dt = std::stod(run.dt), end = 0.6;
  run.steps = std::llround(end / dt);
  const Trajectory path = study.try_run(name_of(run), gas_scenario(run));
  return path.report.status == "done" ? end : path.t.empty() ? 0 : path.report.final.time;
}

/// Page 80: a smaller step, or a higher power of the wall.
void remedies(Study& study) {
  const int starts = study.sized(2, 16, 64);
  for (const char* const scale : {"per-side", "listing"}) {
    int sooner = 0, outside = 0, still = 0, not_later = 0, tunnelled = 0;
    for (int seed = 1; seed <= starts; ++seed) {
      GasRun run{.scale = scale, .dt = "0.01", .seed = seed};
      double before = time_inside(study, run);
      bool ends_sooner = false;
      for (const char* const dt : {"0.001", "0.0001"}) {
        run.dt = dt;
        const double after = time_inside(study, run);
        ends_sooner = ends_sooner || after < before;
        before = after;
      }
      sooner += ends_sooner ? 1 : 0;
      outside += before < 0.6 - 1e-9 ? 1 : 0;
      run.dt = "0.001";
      const double low = time_inside(study, run);
      run.exponent = 4;
      const double high = time_inside(study, run);
      if (low < 0.6 - 1e-9) {
        ++tunnelled;
        not_later += high <= low ? 1 : 0;
        still += high < 0.6 - 1e-9 ? 1 : 0;
      }
    }
    const auto claim = [&](const std::string& name, const std::string& statement, const std::string& counted,
                           int number, int of, const std::string& printed) {
      std::vector<Measured> measured;
      if (of > 0) {
        measured.push_back(seen_among(
            number, of,
            fmt::format("{} of {}, to t = 0.6{}", number, of,
                        number > 0 ? ""
                                   : fmt::format("; with 95 % confidence at most {:.2g} % of all; +- for ten more",
                                                 100 * largest_share_unseen(of)))));
      }
      study.claim({fmt::format("{}_{}", name, scale), fmt::format("{}, 121 particles, scale {}", statement, scale),
                   printed, "80"},
                  none_of_all(counted), measured, Grounds::program, "59 starts and none against it: --full has 64");
    };
    claim("smaller_dt", "with a tenth of the step particles stay inside at least as long, dt = 0.01, 0.001, 0.0001",
          "starts in which a tenth of the step ends sooner", sooner, starts, "remedy 1");
    claim("smallest_dt", "with dt = 0.0001 none passes the wall", "starts with a particle outside", outside, starts,
          "remedy 1");
    claim("exponent_later", "the power 4 in place of 1 keeps particles inside longer, dt = 0.001, where one passes",
          "starts in which they pass it no later", not_later, tunnelled, "remedy 2");
    claim("exponent", "with the power 4 in place of 1 none passes the wall, dt = 0.001, where one did",
          "starts with a particle outside", still, tunnelled, "remedy 2");
  }
}

/// Page 81: compensation gains as many decimal digits as the step has.
/// @param T at which what is lost stands above the last digit
void claim_gain(Study& study, GasRun run, double T, int digits) {
  std::vector<double> gains;
  run.steps = std::llround(T / std::stod(run.dt));
  const bool is_corner = run.start == "corner";
  const bool is_affordable = run.steps <= study.sized(2000, 20000, 20000);
  for (int k = 0; is_affordable && k < study.sized(3, 8, 32); ++k) {
    if (is_corner) run.scale = fmt::format("{:.2f}", 9.7 + 0.04 * k);  // from rest: starts differ in their scale
    run.seed = k + 1;
    run.arithmetic = "double";
    const Return plain = there_and_back(study, run);
    run.arithmetic = "compensated";
    const Return compensated = there_and_back(study, run);
    if (plain.done && compensated.done) gains.push_back(std::log10(plain.position / compensated.position));
  }
  const Spread gain = spread_of(gains);
  std::vector<Measured> measured;
  if (gain.members > 1) {
    measured.push_back(
        {gain.mean, 3 * gain.standard_error(), fmt::format("{} starts, {} steps", gain.members, run.steps)});
  }
  study.claim({fmt::format("compensation_{}_{}", run.start, run.dt),
               fmt::format("compensated summation gains about as many digits as dt = {} has: {}; start {}", run.dt,
                           digits, run.start),
               fmt::format("{} digits", digits), "81"},
              within(digits, 1, "digits gained in positions, of the order told: to one digit"), measured,
              Grounds::program, "the default size");
}

void remedies_and_compensation(Study& study) {
  remedies(study);
  // From rest in the corner nothing tunnels with any of these steps; of the square's starts few do with the power 4.
  claim_gain(study, {.start = "corner", .dt = "0.01"}, 1.8, 2);
  claim_gain(study, {.start = "corner", .dt = "0.001"}, 1.8, 3);
  claim_gain(study, {.start = "corner", .dt = "0.0001"}, 1.8, 4);
  claim_gain(study, {.dt = "0.001", .exponent = 4}, 1.2, 3);
  claim_gain(study, {.dt = "0.0001", .exponent = 4}, 1.2, 4);
}

}  // namespace gas_digits

std::vector<Experiment> gas_digits_experiments() {
  using namespace gas_digits;
  return {{{"S-T81", sonnleitner, "81", "gas: digits lost over evaluations of forces"}, digits},
          {{"S-C80", sonnleitner, "80, 81", "gas: remedies of tunnelling and of rounding"}, remedies_and_compensation}};
}

}  // namespace hamflow::reproduction
