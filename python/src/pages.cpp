#include "pages.hpp"

#include <pybind11/stl.h>

#include "hamflow/figures/panel_axes.hpp"
#include "tables.hpp"

namespace py = pybind11;

namespace hamflow::python {

namespace {

const char* name_of(figures::Ink ink) {
  switch (ink) {
    case figures::Ink::exact:
    case figures::Ink::line:
    case figures::Ink::path:
    case figures::Ink::zero:
      return "line";
    case figures::Ink::level:
      return "level";
    case figures::Ink::dots:
    case figures::Ink::fine_dots:
      return "dots";
    case figures::Ink::place:
    case figures::Ink::marks:
      return "marks";
    case figures::Ink::centre:
      return "centre";
    case figures::Ink::marked:
      return "marked";
    case figures::Ink::band:
      return "band";
    case figures::Ink::fields:
      return "fields";
    case figures::Ink::bars:
      return "bars";
  }
  return "line";
}

py::dict dict_of(const figures::Axis& axis) {
  py::dict all;
  all["low"] = axis.low;
  all["high"] = axis.high;
  all["exponent"] = axis.exponent;
  all["logarithmic"] = axis.logarithmic;
  all["words"] = axis.words;
  return all;
}

py::dict dict_of(const figures::Mark& mark) {
  py::dict all;
  all["colour"] = mark.colour;
  all["shape"] = mark.shape;
  all["dash"] = mark.dash;
  return all;
}

py::dict dict_of(const figures::Series& series) {
  py::dict all;
  figures::Mark mark = series.mark;
  mark.colour = colour_of(series);
  all["ink"] = name_of(series.ink);
  all["name"] = series.name;
  all["mark"] = dict_of(mark);
  all["x"] = array_of(series.curve.x);
  all["y"] = array_of(series.curve.y);
  all["value"] = array_of(series.value);
  all["opacity"] = series.opacity;
  return all;
}

py::dict dict_of(const figures::Panel& panel) {
  py::dict all;
  all["x"] = dict_of(panel.x);
  all["y"] = dict_of(panel.y);
  all["z"] = dict_of(panel.z);
  all["x_label"] = panel.x_label;
  all["y_label"] = panel.y_label;
  all["z_label"] = panel.z_label;
  all["note"] = panel.note;
  all["aspect"] = panel.aspect;
  all["equal_axes"] = panel.equal_axes;
  py::list series;
  for (const figures::Series& one : panel.series) series.append(dict_of(one));
  all["series"] = series;
  return all;
}

}  // namespace

py::dict dict_of(const figures::Page& page) {
  py::dict all;
  py::list panels;
  for (const figures::Panel& panel : page.panels) panels.append(dict_of(panel));
  py::list legend;
  for (const figures::LegendLine& line : page.legend) {
    legend.append(py::make_tuple(line.heading, line.text, dict_of(line.mark)));
  }
  all["title"] = page.title;
  all["panels"] = panels;
  all["columns"] = page.columns;
  all["legend"] = legend;
  all["notes"] = page.notes;
  return all;
}

}  // namespace hamflow::python
