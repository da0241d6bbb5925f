#include "bindings.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/detail/core/option_names.hpp"

namespace {

/// Returns the Python argument that corresponds to an option of the command, for messages.
std::string argument_named(std::string_view option) {
  if (option == "resume") return "existing=\"resume\"";
  if (option == "force") return "existing=\"replace\"";
  if (option == "vary") return "varied";
  if (option == "set") return "Scenario.set";
  if (option == "figure") return "plot()";
  if (option == "METHOD") return "methods";
  return std::string(option);
}

std::string set_in_python(const std::string& key, const std::string& value) {
  return "Scenario.set(\"" + key + "\", " + value + ")";
}

/// Returns the Python call that corresponds to a command, for messages: methods() for "list methods", show("NAME") for
/// "show NAME", Run.plot("KIND", y=["A", "B"]) for "plot --kind KIND --y A,B".
std::string function_named(std::string_view words) {
  const std::string_view drawn = "plot --kind ";
  const std::string_view columns = " --y ";
  if (const std::size_t end = words.find(columns); words.starts_with(drawn) && end != std::string_view::npos) {
    const std::vector<std::string> names = hamflow::split_list(std::string(words.substr(end + columns.size())));
    return "Run.plot(\"" + std::string(words.substr(drawn.size(), end - drawn.size())) + "\", y=[" +
           hamflow::joined(names, [](const std::string& name) { return "\"" + name + "\""; }) + "])";
  }
  if (words.starts_with("sweep")) return "Sweep.plot";
  const std::string_view shown = "show ";
  if (words.starts_with(shown)) return "hamflow.show(\"" + std::string(words.substr(shown.size())) + "\")";
  return words.find("problems") != std::string_view::npos ? "hamflow.problems()" : "hamflow.methods()";
}

}  // namespace

PYBIND11_MODULE(_core, m) {
  m.doc() = "The compiled half of hamflow; import hamflow instead.";
  m.attr("version") = HAMFLOW_VERSION;
  hamflow::use_option_names({argument_named, set_in_python, function_named});
  hamflow::python::bind_errors(m);
  hamflow::python::bind_tables(m);
  hamflow::python::bind_lists(m);
  hamflow::python::bind_problem(m);
  hamflow::python::bind_scenario(m);
  hamflow::python::bind_run(m);
  hamflow::python::bind_compare(m);
  hamflow::python::bind_verify(m);
  hamflow::python::bind_simulation(m);
  hamflow::python::bind_sweep(m);
  hamflow::python::bind_certify(m);
  hamflow::python::bind_orbits(m);
}
