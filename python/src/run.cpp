// Complete runs, as the command `hamflow run` makes them.
#include "hamflow/workflow/run.hpp"

#include <pybind11/functional.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "bindings.hpp"
#include "hamflow/figures/page.hpp"
#include "hamflow/scenario/rejection.hpp"
#include "hamflow/workflow/convert.hpp"
#include "hamflow/workflow/figures_of_run.hpp"
#include "hamflow/workflow/open_run.hpp"
#include "hamflow/workflow/reverse.hpp"
#include "pages.hpp"
#include "signals.hpp"
#include "tables.hpp"
#include "values.hpp"

namespace py = pybind11;

namespace hamflow::python {

namespace {

/// Returns one table of a run. It keeps all tables of the run alive.
std::shared_ptr<Table> part_of(const std::shared_ptr<RunTables>& tables, Table& part) {
  return std::shared_ptr<Table>(tables, &part);
}
py::object part_or_none(const std::shared_ptr<RunTables>& tables, Table& part) {
  return part.empty() ? py::object(py::none()) : py::cast(part_of(tables, part));
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
  found["tables"] = std::make_shared<RunTables>(std::move(report.tables));
  found["json"] = report.json;
  found["text"] = report.text;
  found["status"] = report.status;
  found["message"] = report.message;
  found["hint"] = report.hint;
  found["file_trouble"] = report.file_error;
  found["warnings"] = report.warnings;
  found["notes"] = notes;
  found["interrupted"] = interrupts.raised();
  return found;
}

}  // namespace

void bind_run(py::module_& m) {
  py::class_<RunTables, std::shared_ptr<RunTables>> tables_class(m, "RunTables");
  tables_class
      .def_property_readonly("samples", [](const std::shared_ptr<RunTables>& t) { return part_of(t, t->samples); })
      .def_property_readonly("section", [](const std::shared_ptr<RunTables>& t) { return part_or_none(t, t->section); })
      .def_property_readonly("bounces", [](const std::shared_ptr<RunTables>& t) { return part_or_none(t, t->bounces); })
      .def_property_readonly("events", [](const std::shared_ptr<RunTables>& t) {
        py::dict events;
        for (Table& event : t->events) events[py::str(event.name())] = part_of(t, event);
        return events;
      });
  tables_class.def(py::pickle(
      [](const RunTables& t) {
        py::list events;
        for (const Table& event : t.events) events.append(state_of(event));
        return py::make_tuple(state_of(t.samples), state_of(t.section), state_of(t.bounces), events);
      },
      [](const py::tuple& state) {
        auto t = std::make_shared<RunTables>();
        t->samples = table_of_state(state[0].cast<py::tuple>());
        t->section = table_of_state(state[1].cast<py::tuple>());
        t->bounces = table_of_state(state[2].cast<py::tuple>());
        for (const py::handle event : state[3]) t->events.push_back(table_of_state(event.cast<py::tuple>()));
        return t;
      }));
  m.def("run", &run_in_python, py::arg("scenario"), py::arg("folder"), py::arg("existing"), py::arg("progress"));
  m.def("open_run", [](const std::filesystem::path& run) {
    OpenedRun opened = [&] {
      const py::gil_scoped_release unlocked;
      return open_run(run);
    }();
    py::dict found;
    found["tables"] = std::make_shared<RunTables>(std::move(opened.tables));
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
  m.def(
      "draw",
      [](const std::filesystem::path& run, const std::string& kind, const std::filesystem::path& file,
         const std::string& x, const std::vector<std::string>& y, const std::vector<double>& at) {
        std::vector<std::string> notes;
        const py::gil_scoped_release unlocked;
        draw_figure(
            {.runs = {run}, .kind = kind, .file = file, .x = x, .y = y, .at = at, .note = [&](const std::string& note) {
               notes.push_back(note);
             }});
        return notes;
      },
      py::arg("run"), py::arg("kind"), py::arg("file"), py::arg("x"), py::arg("y"), py::arg("at"));
  m.def(
      "page",
      [](const Scenario& scenario, const RunTables& tables, const std::string& kind, const std::string& x,
         const std::vector<std::string>& y, const std::vector<double>& at) {
        figures::Page page;
        {
          const py::gil_scoped_release unlocked;
          page = figure_page(scenario, tables, {.kind = kind, .x = x, .y = y, .at = at});
        }
        return dict_of(page);
      },
      py::arg("scenario"), py::arg("tables"), py::arg("kind"), py::arg("x"), py::arg("y"), py::arg("at"));
  m.def("convert_samples", [](const Scenario& scenario, const RunTables& tables, const std::string& to) {
    ConvertedSamples states;
    {
      const py::gil_scoped_release unlocked;
      states = converted_samples(scenario, tables.samples, to);
      for (const char* name : {"energy", "step", "t"}) {
        if (tables.samples.find(name) != nullptr) states.table.add(tables.samples[name]);
      }
    }
    return py::make_tuple(std::make_shared<Table>(std::move(states.table)), states.names.q, states.names.p,
                          states.note);
  });
  m.def("convert_scenario", [](const Scenario& scenario, const std::string& to, const std::vector<std::string>& sets) {
    const py::gil_scoped_release unlocked;
    const ConvertedScenario converted = converted_scenario(scenario, to, sets);
    std::vector<std::string> notes = converted.notes;
    const std::string left_out = left_out_of_converted(scenario, to);
    if (!left_out.empty()) {
      notes.push_back("left out of the converted scenario: " + left_out + " (written in the old coordinates)");
    }
    return std::make_pair(converted.text, notes);
  });
  m.def("convert_states", [](const std::string& from, const std::string& to, const std::vector<std::vector<double>>& q,
                             const std::vector<std::vector<double>>& p) {
    std::vector<std::vector<double>> new_q;
    std::vector<std::vector<double>> new_p;
    if (!q.empty()) {
      StateConverter convert(from, to, q[0].size());
      for (std::size_t k = 0; k < q.size(); ++k) {
        const CanonicalState given{q[k], p[k]};
        CanonicalState state = convert(given);
        convert.require_on_constraints(given);
        new_q.push_back(std::move(state.q));
        new_p.push_back(std::move(state.p));
      }
    }
    return std::make_pair(new_q, new_p);
  });
  m.def("check_coordinates", &check_coordinates);
  m.def("is_run", &is_run);
}

}  // namespace hamflow::python
