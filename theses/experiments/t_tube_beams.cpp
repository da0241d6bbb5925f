// [Sonnleitner2010], figures 3.6 to 3.8: beams of parallel trajectories that fall on the x axis and are reflected
// there. Slope is |dQ2/dt / dQ1/dt|; its angle to the x axis is atan of it. A beam starts at Q2 = 1.1, which it reaches
// again.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "../experiment.hpp"
#include "../t_tube_runs.hpp"
#include "../time_panels.hpp"

namespace hamflow::reproduction {

namespace t_tube_beams {

/// Of each trajectory of a beam: where it starts, and the slope before and after the bounce.
struct Beam {
  std::vector<double> q1;
  std::vector<double> angle;  // after, in radians
  std::vector<double> slope;
  std::vector<double> kinetic1;
  double angle_before = 0;
  double slope_before = 0;
  double kinetic1_before = 0;
};

/// 2 time units: down from 1.1 to the wall at 0.1 and up again.
TubeRun beam_run(double eps, const std::string& v1) {
  TubeRun run{.eps = eps, .v1 = v1, .rule = "event", .dt = "0.01"};
  run.v2 = "-1";
  run.steps = 200;
  return run;
}

Beam beam(Study& study, double eps, const std::string& v1) {
  const TubeRun run = beam_run(eps, v1);
  const int members = study.sized(400, 10000, 10000);
  Beam all;
  const double v = std::stod(v1);
  all.angle_before = std::atan2(1, std::abs(v));
  all.slope_before = 1 / std::abs(v);
  all.kinetic1_before = v * v / 2;
  int number = 0;
  for (const TubeMember& member : ensemble(study, run, {fmt::format("problem.initial.q[0]=-0.99:0.99:{}", members)})) {
    const double start = -0.99 + 1.98 * number++ / (members - 1);
    if (!member.done) continue;
    const double a = std::abs(member.p[0]), b = std::abs(member.p[1] / 100);
    all.q1.push_back(start);
    all.angle.push_back(std::atan2(b, a));
    all.slope.push_back(b / a);
    all.kinetic1.push_back(a * a / 2);
  }
  study.keep_scenario(fmt::format("beam_{:+.1f}_{}", eps, v1), tube_scenario(run));
  return all;
}

double median(std::vector<double> numbers) {
  std::nth_element(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2), numbers.end());
  return numbers[numbers.size() / 2];
}

/// @param sign -1: flatter, 1: steeper
void claim_beam(Study& study, const Beam& all, const std::string& name, const std::string& what, int sign) {
  const Spread angle = spread_of(all.angle), slope = spread_of(all.slope), kinetic = spread_of(all.kinetic1);
  const std::string word = sign < 0 ? "flatter" : "steeper";
  // Where v1 changes its sign within the beam, slopes have no mean: the largest alone is a good part of their sum.
  const double largest = *std::max_element(all.slope.begin(), all.slope.end());
  const bool has_mean = largest < 0.01 * slope.mean * slope.members;
  study.claim(
      {"angle_" + name, what + ": the mean angle of the slope after reflection", word},
      at_least(0, "the mean change of the angle in the stated direction is more than 3 standard errors above 0"),
      {{sign * (angle.mean - all.angle_before), 3 * angle.standard_error(),
        fmt::format("{} trajectories, {:.5f} before and {:.5f} +- {:.5f} after", angle.members, all.angle_before,
                    angle.mean, angle.standard_error())}},
      Grounds::program, "more trajectories: the default size, --full");
  study.claim(
      {"slope_" + name, what + ": the mean slope after reflection", word},
      at_least(0, "the mean change of the slope in the stated direction is more than 3 standard errors above 0"),
      {{sign * (slope.mean - all.slope_before),
        has_mean ? 3 * slope.standard_error() : std::numeric_limits<double>::infinity(),
        fmt::format("{:.4f} before, {:.4f} +- {:.4f} after, median {:.4f}", all.slope_before, slope.mean,
                    slope.standard_error(), median(all.slope))}},
      Grounds::program,
      has_mean ? "more trajectories: the default size, --full"
               : "nothing: v1 changes its sign within the beam, so 1/v1 has no mean for any number of trajectories; "
                 "the claim of the "
                 "angle decides");
  study.claim({"energy_" + name, what + ": the mean kinetic energy of the light body", sign < 0 ? "grows" : "falls"},
              at_least(0, "the mean change in the stated direction is more than 3 standard errors above 0"),
              {{-sign * (kinetic.mean - all.kinetic1_before), 3 * kinetic.standard_error(),
                fmt::format("{:.4f} before, {:.4f} +- {:.4f} after", all.kinetic1_before, kinetic.mean,
                            kinetic.standard_error())}},
              Grounds::program, "more trajectories: the default size, --full");
}

void draw_beam(Study& study, const Beam& all, const std::string& name, const std::string& what) {
  study.keep({"beam_" + name, {{"q1", all.q1}, {"angle_after", all.angle}, {"slope_after", all.slope}}});
  figures::Panel panel =
      phase_plane("{/:Italic Q}_1 of the start", "angle of the slope after", all.q1, all.angle, {}, {});
  study.draw("beam_" + name,
             fmt::format("Angle of the slope after the bounce over the start of a trajectory ({}), {}; before: {:.4f}",
                         name.starts_with("repelled") ? "3.8a" : "3.8b", what, all.angle_before),
             {what, {panel}});
}

void beams(Study& study) {
  for (const char* const v1 : {"0.1", "0.5"}) {
    const Beam all = beam(study, -0.6, v1);
    const std::string name = fmt::format("repelled_{}", v1);
    const std::string what = fmt::format("repelling, steep start v = ({}, -1)", v1);
    claim_beam(study, all, name, what, -1);
    draw_beam(study, all, name, what);
  }
  for (const char* const v1 : {"2", "5", "9"}) {
    const Beam all = beam(study, 0.6, v1);
    const std::string name = fmt::format("attracted_{}", v1);
    const std::string what = fmt::format("attracting, flat start v = ({}, -1)", v1);
    claim_beam(study, all, name, what, 1);
    draw_beam(study, all, name, what);
  }
}

double last_angle(const Trajectory& path) {
  return std::atan2(std::abs(path.p.back()[1] / 100), std::abs(path.p.back()[0]));
}

/// Figure 3.6: a single trajectory from near the middle.
void single(Study& study) {
  const auto one = [&](double eps, const std::string& v1, double q1, const std::string& side, int sign) {
    TubeRun run = beam_run(eps, v1);
    run.record_every = 1;
    const Trajectory path = study.run(side, tube_scenario(run), {fmt::format("problem.initial.q[0]={}", q1)});
    const double before = std::atan2(1, std::stod(v1)), after = last_angle(path);
    run.dt = "0.005", run.steps *= 2;
    const double finer =
        last_angle(study.run(side + "_finer", tube_scenario(run), {fmt::format("problem.initial.q[0]={}", q1)}));
    study.claim(
        {side, fmt::format("{}: the trajectory is {} after its reflection", side, sign < 0 ? "flatter" : "steeper"),
         sign < 0 ? "flatter" : "steeper"},
        at_least(0, "the change of its angle in the stated direction"),
        {{sign * (after - before), 2 * std::abs(after - finer),
          fmt::format("from Q1 = {} with v = ({}, -1): {:.4f} to {:.4f}; +-: twice the difference to half of the step",
                      q1, v1, before, after)}});
    study.draw(side, fmt::format("The trajectory ({}), {}", eps < 0 ? "3.6a" : "3.6b", side),
               {fmt::format("T-tube: {}", side),
                {phase_plane("{/:Italic Q}_1", "{/:Italic Q}_2", path.coordinate(0), path.coordinate(1), {}, {})}});
  };
  one(-0.6, "0.1", -0.05, "repelling", -1);
  one(0.6, "5", -0.95, "attracting", 1);
}

/// The distance within which a share of all that happened in rings around the origin did.
double within_which(double share, const std::vector<double>& in_ring, double width) {
  const double wanted = share * std::accumulate(in_ring.begin(), in_ring.end(), 0.0);
  double sum = 0;
  for (std::size_t ring = 0; ring < in_ring.size(); ++ring) {
    if (sum + in_ring[ring] >= wanted) return width * (static_cast<double>(ring) + (wanted - sum) / in_ring[ring]);
    sum += in_ring[ring];
  }
  return std::nan("");
}

/// By which angle a trajectory turns in each step, and at which distance from the origin. A bounce turns no slope.
struct Turning {
  std::vector<double> at, by;

  double between(double low, double high) const {
    double sum = 0;
    for (std::size_t k = 0; k < at.size(); ++k) sum += at[k] > low && at[k] <= high ? by[k] : 0;
    return sum;
  }
};
Turning turning(const Trajectory& path) {
  Turning all;
  double before = 0;
  for (std::size_t k = 0; k < path.size(); ++k) {
    const double angle = std::atan2(std::abs(path.p[k][1] / 100), std::abs(path.p[k][0]));
    all.at.push_back(std::hypot(path.q[k][0], path.q[k][1]));
    all.by.push_back(k == 0 ? 0 : std::abs(angle - before));
    before = angle;
  }
  return all;
}

/// How much of the turning of a trajectory happens within a distance of the origin.
void near_the_origin(Study& study) {
  const int members = study.sized(20, 60, 200);
  constexpr double width = 0.1;  // of a ring around the origin
  constexpr double straight = 0.01;
  std::vector<double> distances;
  for (int ring = 0; ring < 22; ++ring) distances.push_back((ring + 0.5) * width);
  figures::Extent up;
  up.include(0);
  figures::Panel panel = figures::panel_over({0, 2.2}, "distance from the origin");
  for (const double eps : {-0.6, 0.6}) {
    std::vector<double> in_ring(distances.size());  // turning of all trajectories
    const std::string side = eps < 0 ? "repelling" : "attracting";
    std::vector<double> near, all;
    double furthest = 0, furthest_finer = 0, furthest_faster = 0;
    for (int i = 0; i < members; ++i) {
      TubeRun run = beam_run(eps, eps < 0 ? "0.1" : "5");
      run.record_every = 1;
      const std::string start = fmt::format("problem.initial.q[0]={}", -0.97 + 1.94 * i / (members - 1));
      const Turning turned = turning(study.run(fmt::format("{}_{}", side, i), tube_scenario(run), {start}));
      for (std::size_t k = 0; k < turned.by.size(); ++k) {
        if (const auto ring = static_cast<std::size_t>(turned.at[k] / width); ring < in_ring.size()) {
          in_ring[ring] += turned.by[k];
        }
      }
      near.push_back(turned.between(0, 0.5));
      all.push_back(turned.between(0, 3));
      furthest = std::max(furthest, turned.between(1, 3));
      run.dt = "0.005", run.steps *= 2;
      const Trajectory finer = study.run(fmt::format("{}_{}_finer", side, i), tube_scenario(run), {start});
      furthest_finer = std::max(furthest_finer, turning(finer).between(1, 3));
      run.v1 = eps < 0 ? "0.2" : "10", run.v2 = "-2";
      const Trajectory faster = study.run(fmt::format("{}_{}_faster", side, i), tube_scenario(run), {start});
      furthest_faster = std::max(furthest_faster, turning(faster).between(1, 3));
    }
    study.claim(
        {"near_" + side, side + ": slopes change only near the origin", "only there"},
        at_most(std::hypot(1, 2.1) / 2,
                "distance within which nine tenths of the turning angle happen; the text does not say how near: half "
                "the distance of the farthest corner"),
        {{within_which(0.9, in_ring, width), width / 2, fmt::format("{} trajectories", members)}}, Grounds::program,
        "the region that the thesis means");
    study.claim({"straight_" + side, side + ": outside this region trajectories are straight", "straight"},
                at_most(straight, "largest turning angle at distances above 1, in radians, which no eye sees"),
                {{furthest, 2 * std::abs(furthest - furthest_finer),
                  "largest of the beam; +-: twice the difference to half of the step"},
                 {furthest_faster, 2 * std::abs(furthest - furthest_finer),
                  "largest of a beam that is twice as fast: the thesis states no speed"}},
                Grounds::program, "the thesis' own beam, and where its region ends");
    study.keep({"turning_" + side, {{"near", near}, {"all", all}}});
    for (double& turn : in_ring) turn /= width * members;
    study.keep({"over_distance_" + side, {{"distance", distances}, {"turning_per_length", in_ring}}});
    up.include(in_ring);
    panel.series.push_back({figures::Ink::marked,
                            side,
                            figures::finite_points(distances, in_ring),
                            {.colour = eps < 0 ? "#0072b2" : "#d55e00", .shape = eps < 0 ? 7 : 6}});
  }
  panel.y = figures::fit_axis(up, figures::padding, {6});
  panel.y_label = "turning per distance, radians";
  panel.aspect = 0.6;
  study.draw("figure",
             "Change of the angle of the slope over the distance from the origin at which it happens, per unit of "
             "distance: mean of the trajectories",
             {study.info().title, {panel}});
}

}  // namespace t_tube_beams

std::vector<Experiment> t_tube_beams_experiments() {
  using namespace t_tube_beams;
  return {{{"S3.6", sonnleitner, "95, 96", "T-tube: a trajectory repelled and one attracted"}, single},
          {{"S3.7", sonnleitner, "97", "T-tube: where slopes change"}, near_the_origin},
          {{"S3.8", sonnleitner, "98", "T-tube: beams before and after the bounce"}, beams}};
}

}  // namespace hamflow::reproduction
