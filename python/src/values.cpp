#include "values.hpp"

namespace py = pybind11;

namespace hamflow::python {

namespace {

bool is_a(const py::handle& object, const char* module, const char* name) {
  return py::isinstance(object, py::module_::import(module).attr(name));
}

}  // namespace

Value value_of(const py::handle& object, const std::string& key) {
  if (py::isinstance<py::bool_>(object)) return object.cast<bool>();
  if (py::isinstance<py::int_>(object)) {
    try {
      return object.cast<std::int64_t>();
    } catch (const py::cast_error&) {
      throw Error(key + ": found " + py::repr(object).cast<std::string>() + "; allowed whole numbers up to 2^63");
    }
  }
  if (py::isinstance<py::float_>(object)) return object.cast<double>();
  if (py::isinstance<py::str>(object)) return object.cast<std::string>();
  if (py::isinstance<py::dict>(object)) return table_of(object.cast<py::dict>(), key);
  if (py::hasattr(object, "tolist")) return value_of(object.attr("tolist")(), key);  // of NumPy: arrays and scalars
  if (py::isinstance<py::list>(object) || py::isinstance<py::tuple>(object)) {
    Value::List list;
    for (const py::handle& entry : object)
      list.push_back(value_of(entry, key + "[" + std::to_string(list.size()) + "]"));
    return list;
  }
  if (is_a(object, "decimal", "Decimal") || is_a(object, "fractions", "Fraction") || is_a(object, "os", "PathLike")) {
    return py::str(object).cast<std::string>();
  }
  if (py::hasattr(object, "__float__")) return py::float_(py::reinterpret_borrow<py::object>(object)).cast<double>();
  throw Error(key + ": found " + py::repr(py::type::of(object)).cast<std::string>() +
              "; allowed numbers, texts, True and False, lists and dicts of them");
}

Value::Table table_of(const py::dict& dict, const std::string& path) {
  Value::Table table;
  for (const auto& [key, value] : dict) {
    if (!py::isinstance<py::str>(key)) {
      throw Error((path.empty() ? "the scenario" : path) + ": found the key " + py::repr(key).cast<std::string>() +
                  "; allowed texts");
    }
    const auto name = key.cast<std::string>();
    table.emplace_back(name, value_of(value, path.empty() ? name : path + "." + name));
  }
  return table;
}

Existing existing_named(const std::string& name, bool can_resume) {
  if (name == "error") return Existing::refuse;
  if (name == "replace") return Existing::replace;
  if (name == "resume" && can_resume) return Existing::resume;
  throw Error("existing: found \"" + name + "\"; allowed \"error\", \"replace\"" + (can_resume ? ", \"resume\"" : ""));
}

}  // namespace hamflow::python
