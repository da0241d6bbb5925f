#include "figure.hpp"

#include <algorithm>

#include "figure_kind.hpp"
#include "hamflow/core/error.hpp"
#include "hamflow/core/number.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/detail/core/option_names.hpp"
#include "particles.hpp"
#include "terminal.hpp"

namespace hamflow {

namespace {
std::string names_for(std::size_t names, std::size_t numbers, const std::string& what) {
  if (names == numbers) return "";
  return "there are " + std::to_string(names) + " names of " + what + " for " + std::to_string(numbers);
}

/// Returns what is wrong if lists that belong together have different lengths.
std::string inconsistency(const FigureData& data) {
  std::string wrong = names_for(data.coordinates.size(), data.q.size(), "coordinates");
  if (wrong.empty()) wrong = names_for(data.momenta.size(), data.p.size(), "momenta");
  if (!wrong.empty()) return wrong;
  const auto differs = [&](const std::vector<double>& x) { return x.size() != data.t.size(); };
  if (std::any_of(data.q.begin(), data.q.end(), differs)) return "q and t have different numbers of samples";
  if (std::any_of(data.p.begin(), data.p.end(), differs)) return "p and t have different numbers of samples";
  if (!data.energy.empty() && differs(data.energy)) return "energy and t have different numbers of samples";
  if (!data.energy_difference.empty() && differs(data.energy_difference)) {
    return "differences of energy and t have different numbers of samples";
  }
  for (const auto* range : {&data.least_difference, &data.largest_difference}) {
    if (!range->empty() && differs(*range)) return "ranges of energy and t have different numbers of samples";
  }
  if (data.curve_x.size() != data.curve_y.size()) return "the exact curve has more numbers on one axis than the other";
  return "";
}

std::string obstacle(const FigureData& data, const figures::FigureKind& kind) {
  const std::string wrong = inconsistency(data);
  if (!wrong.empty()) return wrong;
  if (data.q.empty() && kind.needs_states) {
    return "columns of single particles are not read for " + std::to_string(data.particles.count) + " particles";
  }
  return kind.obstacle(data);
}

/// Explains why this run has no such figure, as a sentence that says what is allowed.
std::string why_not_alone(const FigureData& data, const FigureOptions& options, const std::string& kind) {
  FigureFacts facts = facts_of(data);
  facts.columns_chosen = !options.y.empty();
  const figures::FigureKind* const known = figures::find_kind(kind);
  if (known == nullptr) return unknown_figure(kind);
  std::string why = known->refused(facts);
  if (why.empty()) {
    const std::string reason = obstacle(data, *known);
    if (reason.empty()) return "";
    why = ", but " + reason;
  }
  std::vector<std::string> others = drawable_figures(facts);
  std::erase_if(others, [&](const std::string& name) { return !obstacle(data, *figures::find_kind(name)).empty(); });
  return "found \"" + kind + "\"" + why +
         (others.empty() ? "; no other figure can be drawn from these samples" : "; allowed " + joined(others));
}

/// Lists names. Of many columns it lists the first and the last ones, and their number.
std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t most = 24, shown = 4;
  if (names.size() <= most) return joined(names);
  const auto part = [&](std::size_t from, std::size_t to) {
    return joined(std::vector<std::string>(names.begin() + static_cast<std::ptrdiff_t>(from),
                                           names.begin() + static_cast<std::ptrdiff_t>(to)));
  };
  return part(0, shown) + ", ..., " + part(names.size() - shown, names.size()) + " (" + std::to_string(names.size()) +
         " columns)";
}
/// Returns what is wrong with the chosen columns.
std::string refused_columns(const Figure& figure, const figures::FigureKind& kind) {
  std::vector<std::string> asked = figure.options.y;
  if (!figure.options.x.empty()) asked.insert(asked.begin(), figure.options.x);
  if (asked.empty()) return "";
  for (const FigureData& run : figure.runs) {
    const std::vector<std::string> allowed = kind.columns(run);
    if (allowed.empty()) {
      std::vector<std::string> others = drawable_figures(facts_of(run));
      std::erase_if(others, [&](const std::string& name) { return figures::find_kind(name)->columns(run).empty(); });
      return "found " + option_name("x") + " or " + option_name("y") + " for \"" + std::string(kind.name) +
             "\", which draws no columns; allowed for " + joined(others);
    }
    for (const std::string& name : asked) {
      if (std::find(allowed.begin(), allowed.end(), name) != allowed.end()) continue;
      const std::string of_run = figure.runs.size() > 1 ? " of " + run.label : "";
      return "found column \"" + name + "\"" + of_run + "; allowed " + listed(allowed) + suggestion(name, allowed);
    }
  }
  return "";
}
/// Returns what is wrong with the chosen times.
std::string refused_times(const Figure& figure, const figures::FigureKind& kind) {
  const std::vector<double>& asked = figure.options.at;
  if (asked.empty()) return "";
  if (!kind.takes_times) {
    std::vector<std::string> others;
    for (const figures::FigureKind* other : figures::all_kinds()) {
      if (other->takes_times) others.emplace_back(other->name);
    }
    return "found " + option_name("at") + " for \"" + std::string(kind.name) +
           "\", which draws all samples; allowed for " + joined(others);
  }
  constexpr std::size_t most_times = 12;
  if (asked.size() > most_times) {
    return "found " + std::to_string(asked.size()) + " times; allowed at most " + std::to_string(most_times) +
           " in one figure";
  }
  for (const FigureData& run : figure.runs) {
    for (const double t : asked) {
      const figures::MissingSample other = figures::missing_sample_at(run, t);
      if (other.is_beyond) return "found the time " + shortest(t) + "; allowed times of " + other.samples;
    }
  }
  return "";
}
}  // namespace

std::vector<std::string> notes_on_times(const Figure& figure) {
  std::vector<std::string> notes;
  for (const FigureData& run : figure.runs) {
    for (const double t : figure.options.at) {
      const figures::MissingSample other = figures::missing_sample_at(run, t);
      if (other.samples.empty()) continue;
      notes.push_back((figure.runs.size() > 1 ? run.label + ": " : "") + "no sample is at the time " + shortest(t) +
                      ", only at those of " + other.samples + ", which is drawn");
    }
  }
  return notes;
}

FigureFacts facts_of(const FigureData& data) {
  return {.degrees_of_freedom = std::max(data.q.size(), data.particles.count * data.particles.space),
          .bodies_in_space = data.space >= 2,
          .diagnostics = !data.diagnostics.empty(),
          .section = !data.section_coordinate.empty(),
          .stroboscopic = data.q.size() == 1 && !data.section_coordinate.empty(),
          .particles = data.particles.count > 0,
          .gas = data.particles.gas,
          .energies = !data.energy.empty() || data.t.empty()};
}

std::string why_not(const Figure& figure, const std::string& kind) {
  for (const FigureData& run : figure.runs) {
    const std::string reason = why_not_alone(run, figure.options, kind);
    if (!reason.empty()) return (figure.runs.size() > 1 ? run.label + ": " : "") + reason;
  }
  const figures::FigureKind& known = *figures::find_kind(kind);
  const std::string columns = refused_columns(figure, known);
  if (!columns.empty()) return columns;
  if (const std::string times = refused_times(figure, known); !times.empty()) return times;
  const std::string reason = figure.runs.size() > 1 ? known.apart(figure) : "";
  return reason.empty() ? ""
                        : "found " + std::to_string(figure.runs.size()) + " runs for \"" + kind + "\", but " + reason;
}

figures::Page page_of(const Figure& figure, const std::string& kind) {
  const std::string reason = why_not(figure, kind);
  if (!reason.empty()) throw Error(reason);
  figures::Page page = figures::find_kind(kind)->page(figure).with(figure.options.page);
  page.notes.insert(page.notes.end(), figure.notes.begin(), figure.notes.end());
  return page;
}

void write_figure(const Figure& figure, const std::string& kind, const std::filesystem::path& file) {
  if (const std::string wrong = refused_figure_file(file); !wrong.empty()) throw Error(wrong);
  figures::draw(page_of(figure, kind), file);
}

}  // namespace hamflow
