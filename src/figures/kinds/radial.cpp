// Pair distribution g(r): the number of pairs at distance r, divided by the number for the same particles spread evenly
// over their volume.
#include <algorithm>
#include <cmath>

#include "../figure_kind.hpp"
#include "../pair_distribution.hpp"
#include "../panels.hpp"
#include "../particles.hpp"
#include "../text.hpp"

namespace hamflow::figures {

namespace radial {
constexpr std::size_t bins = 150;
constexpr std::size_t fewest_free = 16;  // with fewer free particles, those at the border determine the volume
// particles used; pairs of a random part have the same distribution as all pairs
constexpr std::size_t most_taken = 200000;

bool are_finite(const std::vector<double>& q) {
  return std::all_of(q.begin(), q.end(), [](double x) { return std::isfinite(x); });
}

bool is_held(const FigureParticles& of) { return of.radius > 0 || !of.edges.empty(); }

/// Returns the distance of neighbours that are spread evenly.
double neighbours(const FigureData& data, const Region& region) {
  return std::pow(region.volume() / static_cast<double>(data.particles.count), 1.0 / static_cast<double>(region.space));
}

std::string obstacle(const FigureData& data) {
  if (data.t.empty()) return no_samples("position");
  if (data.particles.count < 2) return "a single particle has no pairs";
  const std::vector<double> q = data.particles.positions(data.t.size() - 1);
  if (!are_finite(q)) return "the last sample has positions that are not finite";
  if (!is_held(data.particles) && data.particles.count < fewest_free) {
    return "the " + std::to_string(data.particles.count) + " bodies have no container, and fewer than " +
           std::to_string(fewest_free) + " bodies do not define a volume for g(r)";
  }
  const Region region = region_of(data.particles, q);
  if (!std::isnormal(region.volume())) return "the particles fill no volume";
  return region.shortest() < neighbours(data, region) ? "the particles lie closer to a plane or line than to each other"
                                                      : "";
}

/// Returns a few distances of neighbours, because further away there is little to see and there are many pairs. In a
/// periodic box the range ends where nearest images are no longer unique, elsewhere where the shares of pairs are no
/// longer known.
double range(const FigureData& data, const Region& region) {
  const double most = region.periodic ? region.shortest() / 2 : region.shortest();
  return std::min(most, 5 * neighbours(data, region));
}

/// The same for several samples, because the volume of free particles may grow.
double range(const FigureData& data, const std::vector<std::size_t>& samples) {
  double r_max = range(data, region_of(data.particles, data.particles.positions(samples.back())));
  for (std::size_t k = 0; !is_held(data.particles) && k + 1 < samples.size(); ++k) {
    const std::vector<double> q = data.particles.positions(samples[k]);
    if (!are_finite(q)) continue;
    const Region region = region_of(data.particles, q);
    if (std::isnormal(region.volume())) r_max = std::min(r_max, range(data, region));
  }
  return r_max;
}

std::vector<double> those(const std::vector<std::size_t>& taken, const std::vector<double>& q, std::size_t space) {
  if (taken.size() * space == q.size()) return q;
  std::vector<double> part;
  for (const std::size_t i : taken) {
    for (std::size_t k = 0; k < space; ++k) part.push_back(q[i * space + k]);
  }
  return part;
}

/// Averages over the samples that have finite positions within a volume.
Curve distribution(const FigureData& data, const std::vector<std::size_t>& samples, double r_max) {
  std::vector<double> g(bins, 0);
  int used = 0;
  const std::vector<std::size_t> taken = some_of(data.particles.count, most_taken);
  const auto n = static_cast<double>(taken.size());
  for (const std::size_t sample : samples) {
    const std::vector<double> q = data.particles.positions(sample);
    if (!are_finite(q)) continue;
    const Region region = region_of(data.particles, q);
    if (!std::isnormal(region.volume()) || region.shortest() < r_max) continue;
    ++used;
    const auto found = pair_counts(those(taken, q, region.space), region.space,
                                   region.periodic ? region.edges : std::vector<double>(), r_max, bins);
    double before = 0;
    for (std::size_t k = 0; k < bins; ++k) {
      const double share = region.share_within(r_max * static_cast<double>(k + 1) / bins);
      g[k] += static_cast<double>(found[k]) / (n * (n - 1) / 2 * (share - before));
      before = share;
    }
  }
  Curve curve;
  for (std::size_t k = 0; k < bins; ++k) curve.add(r_max * (static_cast<double>(k) + 0.5) / bins, g[k] / used);
  return curve;
}

/// Returns samples of the second half of a run, as many as can be evaluated in a moment.
std::vector<std::size_t> later_samples(const FigureData& data) {
  constexpr std::size_t most_particles = 2000000;
  const std::size_t first = data.t.size() / 2;
  const std::size_t there = data.t.size() - first;
  const std::size_t taken =
      std::min(there, std::clamp<std::size_t>(most_particles / std::min(data.particles.count, most_taken), 1, 20));
  std::vector<std::size_t> all;
  for (std::size_t k = 1; k <= taken; ++k) all.push_back(first + k * there / taken - 1);
  return all;
}

Page page(const Figure& figure) {
  const FigureData& first = figure.runs.front();
  Panel panel;
  Page all{first.title, {}};
  Extent r;
  Extent g;
  r.include(0);
  g.include(0);
  g.include(1);
  std::vector<Series> curves;
  std::vector<std::string> means;  // a note for each run
  const auto add = [&](Series how, const FigureData& data, const std::vector<std::size_t>& samples) {
    const double r_max = range(data, samples);
    how.ink = Ink::line;
    how.curve = distribution(data, samples, r_max);
    r.include(r_max);
    g.include(how.curve.y);
    curves.push_back(std::move(how));
  };
  const std::vector<double>& at = figure.options.at;
  for (std::size_t run = 0; run < figure.runs.size(); ++run) {
    const FigureData& data = figure.runs[run];
    if (at.empty()) {
      const std::vector<std::size_t> samples = later_samples(data);
      add(series_of(figure, run), data, samples);
      means.push_back(samples.size() == 1
                          ? "of the sample at " + time_text(data.t[samples[0]])
                          : "mean over " + std::to_string(samples.size()) + " of " + std::to_string(data.t.size()) +
                                " samples, from " + time_text(data.t[samples.front()]) + " to " +
                                short_value(data.t[samples.back()]));
      continue;
    }
    for (const std::size_t sample : samples_at(data, at)) {
      Series how = series_of(figure, run);
      how.name += (how.name.empty() ? "" : ", ") + time_text(data.t[sample]);
      how.mark = mark_of(curves.size());
      add(std::move(how), data, {sample});
    }
  }
  const bool alike = std::equal(means.begin() + (means.empty() ? 0 : 1), means.end(), means.begin());
  for (std::size_t run = 0; run < means.size(); ++run) {
    if (alike && run > 0) break;
    all.notes.push_back((alike ? "" : escaped(figure.runs[run].label) + ": ") + means[run]);
  }
  const std::size_t count = first.particles.count;
  if (count > most_taken) {
    all.notes.push_back("pairs among " + std::to_string(most_taken) + " of " + std::to_string(count) + " particles");
  }
  panel.x = fit_axis(r, 0, {7, 40});
  panel.y = fit_axis(g, padding, {7});
  panel.x_label = in_unit("{/:Italic r}", units_of(figure).q);
  panel.y_label = "{/:Italic g}({/:Italic r})";
  panel.series.push_back({Ink::zero, "", {{r.low, r.high}, {1, 1}}});
  panel.series.insert(panel.series.end(), curves.begin(), curves.end());
  all.panels.push_back(std::move(panel));
  return all;
}
}  // namespace radial

extern const FigureKind radial_figure{"radial",
                                      "the pair distribution g(r) of the particles of a gas, averaged over the second "
                                      "half of the run or at the times of --at",
                                      10,
                                      without_particles,
                                      radial::obstacle,
                                      any_runs,
                                      no_columns,
                                      radial::page,
                                      true};

}  // namespace hamflow::figures
