// The path in the plane of the two coordinates, with the exact one where it is known; the paths of bodies in space.
#include "../curves.hpp"
#include "../figure_kind.hpp"
#include "../panels.hpp"
#include "../text.hpp"

namespace hamflow::figures {

namespace orbit {
std::string refused(const FigureFacts& facts) {
  const bool drawn = facts.degrees_of_freedom == 0 || facts.degrees_of_freedom == 2 || facts.bodies_in_space;
  return drawn ? "" : for_degrees(facts) + ", where an orbit needs 2, or bodies in space";
}

std::string obstacle(const FigureData& data) {
  const Curve track = data.space >= 2 ? finite_points(data.q[0], data.q[1]) : orbit_track(data);
  return track.x.empty() ? no_samples("position") : "";
}

/// The paths of several bodies, seen along the third axis where there is one.
Page bodies_page(const FigureData& data) {
  Extent x;
  Extent y;
  std::vector<Curve> tracks;
  for (std::size_t i = 0; i + 1 < data.q.size(); i += data.space) {
    tracks.push_back(finite_points(data.q[i], data.q[i + 1]));
    x.include(tracks.back().x);
    y.include(tracks.back().y);
  }
  Panel panel;
  fit_equal_axes(panel, x, y);
  panel.x_label = symbol("x");
  panel.y_label = symbol("y");
  for (const Curve& track : tracks) panel.series.push_back(samples(track));
  return {data.title, {panel}};
}

Page page(const FigureData& data) {
  if (data.space >= 2) return bodies_page(data);
  const Curve track = orbit_track(data);
  const bool exact = !data.curve_x.empty();
  Extent x;
  Extent y;
  x.include(track.x);
  y.include(track.y);
  Panel panel;
  if (exact) {
    x.include(data.curve_x);
    y.include(data.curve_y);
    x.include(0);
    y.include(0);
  }
  fit_equal_axes(panel, x, y);
  const bool polar = is_polar(data);
  panel.x_label = polar ? symbol("x") : symbol(data.coordinates[0]);
  panel.y_label = polar ? symbol("y") : symbol(data.coordinates[1]);
  if (exact) {
    panel.series.push_back({Ink::exact, "exact", {data.curve_x, data.curve_y}});
    panel.series.push_back({Ink::dots, "numeric", dots_on_line(track, panel)});
    panel.series.push_back({Ink::centre, "", {{0}, {0}}});
  } else {
    panel.series.push_back(samples(track));
  }
  return {data.title, {panel}};
}
}  // namespace orbit

extern const FigureKind orbit_figure{"orbit",
                                     "the path in the plane of 2 degrees of freedom, or the paths of bodies in space",
                                     1,
                                     orbit::refused,
                                     orbit::obstacle,
                                     orbit::page};

}  // namespace hamflow::figures
