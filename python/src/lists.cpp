// Lists and descriptions of methods, problems and figures.
#include <pybind11/stl.h>

#include "bindings.hpp"
#include "hamflow/formula/tex.hpp"
#include "hamflow/run/catalog.hpp"
#include "hamflow/workflow/catalogue_text.hpp"
#include "hamflow/workflow/cite.hpp"

namespace py = pybind11;

namespace hamflow::python {

void bind_lists(py::module_& m) {
  m.def("methods", [] {
    py::list all;
    for (const MethodEntry& entry : methods()) {
      const MethodInfo info = describe(parse_method(entry.name));
      py::dict one;
      one["name"] = entry.name;
      one["summary"] = info.summary;
      one["order"] = info.order;
      one["explicit"] = info.explicit_step;
      one["symplectic"] = info.symplectic;
      one["symmetric"] = info.symmetric;
      one["reversible"] = info.reversible;
      one["energy_conserving"] = std::string(name(info.energy_conserving));
      one["reference"] = info.reference;
      all.append(one);
    }
    return all;
  });
  m.def("problems", [] {
    py::list all;
    std::vector<std::string> seen;
    const auto add = [&](const ProblemInfo& info) {
      if (std::find(seen.begin(), seen.end(), info.name) != seen.end()) return;
      seen.push_back(info.name);
      py::dict one;
      one["name"] = info.name;
      one["formula"] = info.formula;
      one["coordinates"] = info.coordinates;
      std::vector<std::string> parameters;
      for (const ParameterInfo& parameter : info.parameters) parameters.push_back(parameter.name);
      one["parameters"] = parameters;
      one["reference"] = info.reference;
      all.append(one);
    };
    for (const ProblemEntry& entry : problems()) add(entry.info);
    add(formula_example().info);
    return all;
  });
  m.def("show", [](const std::string& name) {
    const auto found = catalogue_text(name);
    if (!found) throw Error(not_in_catalogue(name));
    return py::make_tuple(found->text, found->formulas);
  });
  m.def("show_scenario", [](const Scenario& scenario) {
    const CatalogueText found = description_of(scenario);
    return py::make_tuple(found.text, found.formulas);
  });
  m.def("cite", [](const std::string& name) {
    const std::string found = bibtex_of(name);
    if (found.empty()) throw Error(not_in_catalogue(name));
    return found;
  });
  m.def("cite_scenario", [](const Scenario& scenario) { return bibtex_of(scenario); });
  m.def("tex", &tex_of);
}

}  // namespace hamflow::python
