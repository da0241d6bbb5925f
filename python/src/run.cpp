// Whole runs, as the command carries them out.
#include "hamflow/workflow/run.hpp"

#include <pybind11/functional.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "bindings.hpp"
#include "hamflow/scenario/rejection.hpp"
#include "hamflow/workflow/figures_of_run.hpp"
#include "hamflow/workflow/open_run.hpp"
#include "hamflow/workflow/reverse.hpp"
#include "signals.hpp"
#include "values.hpp"

namespace py = pybind11;

namespace hamflow::python {

namespace {

/// The tables of a run by name, each with its own memory.
py::dict tables_of(RunTables tables) {
  py::dict all;
  const auto add = [](py::dict& to, const std::string& name, Table&& table) {
    to[py::str(name)] = py::cast(std::make_shared<Table>(std::move(table)));
  };
  add(all, "samples", std::move(tables.samples));
  if (!tables.section.empty()) add(all, "section", std::move(tables.section));
  if (!tables.bounces.empty()) add(all, "bounces", std::move(tables.bounces));
  py::dict events;
  for (Table& event : tables.events) {
    const std::string name = event.name();
    add(events, name, std::move(event));
  }
  all["events"] = events;
  return all;
}

py::dict run_in_python(const Scenario& scenario, const std::filesystem::path& folder, const std::string& existing,
                       const std::function<void(std::int64_t)>& progress) {
  RunSettings settings;
  settings.folder = folder;
  settings.existing = existing_named(existing);
  std::vector<std::string> notes;
  settings.note = [&](const std::string& note) { notes.push_back(note); };
  Interrupts interrupts(progress);
  settings.pulse = [&](std::int64_t step) { return interrupts.go_on(step); };
  RunReport report;
  {
    const py::gil_scoped_release unlocked;
    report = run(scenario, settings);
  }
  py::dict found;
  found["tables"] = tables_of(std::move(report.tables));
  found["json"] = report.json;
  found["text"] = report.text;
  found["status"] = report.status;
  found["message"] = report.message;
  found["hint"] = report.hint;
  found["file_trouble"] = report.file_trouble;
  found["warnings"] = report.warnings;
  found["notes"] = notes;
  found["interrupted"] = interrupts.was_interrupted();
  return found;
}

}  // namespace

void bind_run(py::module_& m) {
  m.def("run", &run_in_python, py::arg("scenario"), py::arg("folder"), py::arg("existing"), py::arg("progress"));
  m.def("open_run", [](const std::filesystem::path& run) {
    OpenedRun opened = [&] {
      const py::gil_scoped_release unlocked;
      return open_run(run);
    }();
    py::dict found;
    found["tables"] = tables_of(std::move(opened.tables));
    found["json"] = opened.summary;
    found["scenario"] = std::make_shared<Scenario>(std::move(opened.scenario));
    return found;
  });
  m.def("reverse", [](const Scenario& scenario) {
    Interrupts interrupts;
    ReversalReport report;
    {
      const py::gil_scoped_release unlocked;
      report = reverse_scenario(scenario, [&](std::int64_t step) { return interrupts.go_on(step); });
    }
    interrupts.rethrow();
    return py::make_tuple(report.json, report.text, report.message);
  });
  m.def("draw", [](const std::filesystem::path& run, const std::string& kind, const std::filesystem::path& file) {
    const py::gil_scoped_release unlocked;
    draw_figure(run, kind, file);
  });
}

}  // namespace hamflow::python
