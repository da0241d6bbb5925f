// Columns over time or over another column; by default coordinates and momenta.
#include <algorithm>

#include "../columns.hpp"
#include "../figure_kind.hpp"
#include "../panels.hpp"
#include "../text.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/detail/core/option_names.hpp"

namespace hamflow::figures {

namespace time {
constexpr std::size_t most_degrees = 100;  // all coordinates and momenta are drawn up to this number
constexpr std::size_t most_named = 24;     // in one panel; with more, colours and dashes repeat

std::string refused(const FigureFacts& facts) {
  if (facts.columns_chosen || facts.degrees_of_freedom <= most_degrees) return "";
  const bool of_bodies = facts.bodies_in_space || facts.particles;
  return for_degrees(facts) + ", where columns have to be chosen: " +
         command_name(std::string("plot --kind time --y ") + (of_bodies ? "x1,y1" : "q1,q2"));
}

std::string obstacle(const FigureData& data) {
  if (data.q.empty()) return "";  // very many particles have no q here, and columns are chosen
  for (const std::vector<double>& q : data.q) {
    if (!finite_points(data.t, q).x.empty()) return "";
  }
  return no_samples("position");
}

std::vector<std::string> wanted(const Figure& figure) {
  if (!figure.options.y.empty()) return figure.options.y;
  std::vector<std::string> names = figure.runs.front().coordinates;
  names.insert(names.end(), figure.runs.front().momenta.begin(), figure.runs.front().momenta.end());
  return names;
}

/// Returns the common part of numbered columns: x for x1 and for x[1].
std::string family(const std::string& typed) {
  const std::string name = without_brackets(typed);
  const std::size_t end = name.find_last_not_of("0123456789");
  return end == std::string::npos ? name : name.substr(0, end + 1);
}

/// Groups columns that share an axis: columns of the same sort and, for bodies, of the same direction of space. With
/// several runs each column has an axis of its own.
std::vector<std::vector<Column>> shared_axes(const Figure& figure) {
  const FigureData& data = figure.runs.front();
  std::vector<std::vector<Column>> groups;
  for (const std::string& name : wanted(figure)) {
    Column column = column_of(data, name);
    const auto fits = [&](const std::vector<Column>& group) {
      if (figure.runs.size() > 1 || column.sort == Sort::other || group.front().sort != column.sort) return false;
      return data.space < 2 || family(group.front().name) == family(name);
    };
    const auto group = std::find_if(groups.begin(), groups.end(), fits);
    if (group == groups.end()) {
      groups.push_back({std::move(column)});
    } else {
      group->push_back(std::move(column));
    }
  }
  return groups;
}

std::string label_of(const std::vector<Column>& group) {
  const std::string first = family(group.front().name);
  const bool numbered =
      std::all_of(group.begin(), group.end(), [&](const Column& column) { return family(column.name) == first; });
  if (group.size() > 3 && numbered) return symbol(first);
  constexpr std::size_t longest = 24;  // characters that fit beside a panel; the legend has all names
  std::string all = joined(group, [](const Column& column) { return column.label; });
  if (printed_length(all) <= longest || group.size() < 3) return all;
  all = group.front().label + ", …, " + group.back().label;
  return printed_length(all) <= longest ? all : group.front().label + ", …";
}

void add(Panel& panel, const std::vector<double>& x, const std::vector<double>& y, bool over_time, Series how) {
  if (over_time) return add_over_time(panel, x, y, std::move(how));
  panel.series.push_back(track_of(finite_points(x, y), std::move(how)));
}

/// Returns whether a column is part of the state. Such columns are smooth, so noise does not change their direction
/// from sample to sample.
bool moves(const Column& column) {
  return column.sort == Sort::position || column.sort == Sort::angle || column.sort == Sort::momentum ||
         column.sort == Sort::angular_momentum;
}

std::string samples_note(const Figure& figure) {
  const std::size_t first = figure.runs.front().t.size();
  const bool alike =
      std::all_of(figure.runs.begin(), figure.runs.end(), [&](const FigureData& run) { return run.t.size() == first; });
  return alike ? joined_note(first) : "lines join samples that are far apart";
}

Page page(const Figure& figure) {
  const std::string x_name = figure.options.x.empty() ? "t" : figure.options.x;
  const bool over_time = x_name == "t";
  std::vector<std::vector<double>> xs;
  Extent range;
  for (const FigureData& run : figure.runs) {
    xs.push_back(column_of(run, x_name).values());
    range.include(xs.back());
  }
  bool sparse = false;
  Page all{figure.runs.front().title, {}};
  for (const std::vector<Column>& group : shared_axes(figure)) {
    Panel panel = panel_over(range, axis_label(figure, column_of(figure.runs.front(), x_name)));
    if (!over_time) panel.x = fit_axis(range, padding, {7, 40});
    Extent values;
    for (std::size_t run = 0; run < figure.runs.size(); ++run) {
      for (std::size_t k = 0; k < group.size(); ++k) {
        const std::vector<double> y = column_of(figure.runs[run], group[k].name).values();
        values.include(y);
        sparse = sparse || (over_time && moves(group[k]) && !figure.runs[run].every_step && is_sparse(y));
        Series how = series_of(figure, run);
        if (group.size() > 1) how = {.name = group.size() > most_named ? "" : group[k].label, .mark = mark_of(k)};
        if (!all.panels.empty() && figure.runs.size() > 1) how.name.clear();
        add(panel, xs[run], y, over_time, std::move(how));
      }
    }
    panel.y = fit_axis(values, padding, {6});
    panel.y_label = in_unit(label_of(group), unit_of(figure, group.front().sort));
    panel.aspect = over_time ? 0.42 : 0.7;
    all.panels.push_back(std::move(panel));
  }
  if (sparse) all.notes.push_back(samples_note(figure));
  return all;
}
}  // namespace time

extern const FigureKind time_figure{"time",
                                    "coordinates and momenta over time, or the columns --y over the column --x",
                                    3,
                                    time::refused,
                                    time::obstacle,
                                    same_coordinates,
                                    column_names,
                                    time::page};

}  // namespace hamflow::figures
