#include "values.hpp"

namespace py = pybind11;

namespace hamflow::python {

namespace {

bool is_a(const py::handle& object, const char* module, const char* name) {
  return py::isinstance(object, py::module_::import(module).attr(name));
}

/// No key needs a deeper value. The limit ends the recursion for a list that contains itself.
constexpr int deepest = 100;

/// @throws Error if the text has a surrogate without its partner, which UTF-8 cannot represent
std::string utf8_of(const py::handle& text, const std::string& key) {
  Py_ssize_t size = 0;
  const char* const bytes = PyUnicode_AsUTF8AndSize(text.ptr(), &size);
  if (bytes != nullptr) return {bytes, static_cast<std::size_t>(size)};
  PyErr_Clear();
  throw Error(key + ": found a text that is not Unicode; allowed texts without single surrogates");
}

Value value_of(const py::handle& object, const std::string& key, int depth);

Value::Table table_of(const py::dict& dict, const std::string& path, int depth) {
  Value::Table table;
  for (const auto& [key, value] : dict) {
    if (!py::isinstance<py::str>(key)) {
      throw Error((path.empty() ? "the scenario" : path) + ": found the key " + py::repr(key).cast<std::string>() +
                  "; allowed texts");
    }
    const std::string name = utf8_of(key, path.empty() ? "the scenario" : path);
    table.emplace_back(name, value_of(value, path.empty() ? name : path + "." + name, depth + 1));
  }
  return table;
}

Value value_of(const py::handle& object, const std::string& key, int depth) {
  if (depth > deepest) {
    throw Error(key.substr(0, key.find_first_of(".[")) + ": found lists or dicts nested too deeply; allowed at most " +
                std::to_string(deepest) + " levels");
  }
  if (py::isinstance<py::bool_>(object)) return object.cast<bool>();
  if (py::isinstance<py::int_>(object)) {
    try {
      return object.cast<std::int64_t>();
    } catch (const py::cast_error&) {
      throw Error(key + ": found " + py::repr(object).cast<std::string>() + "; allowed whole numbers up to 2^63");
    }
  }
  if (py::isinstance<py::float_>(object)) return object.cast<double>();
  if (py::isinstance<py::str>(object)) return utf8_of(object, key);
  if (py::isinstance<py::dict>(object)) return table_of(object.cast<py::dict>(), key, depth);
  if (py::hasattr(object, "tolist")) {  // arrays and scalars of NumPy
    const py::object plain = object.attr("tolist")();
    // tolist() of a longdouble returns a longdouble again: calling it again would not end.
    if (!py::type::of(plain).is(py::type::of(object))) return value_of(plain, key, depth + 1);
  }
  if (py::isinstance<py::list>(object) || py::isinstance<py::tuple>(object)) {
    Value::List list;
    for (const py::handle& entry : object)
      list.push_back(value_of(entry, key + "[" + std::to_string(list.size()) + "]", depth + 1));
    return list;
  }
  if (is_a(object, "decimal", "Decimal") || is_a(object, "fractions", "Fraction") || is_a(object, "os", "PathLike")) {
    return py::str(object).cast<std::string>();
  }
  if (py::hasattr(object, "__float__")) return py::float_(py::reinterpret_borrow<py::object>(object)).cast<double>();
  throw Error(key + ": found " + py::repr(py::type::of(object)).cast<std::string>() +
              "; allowed numbers, texts, True and False, lists and dicts of them");
}

}  // namespace

Value value_of(const py::handle& object, const std::string& key) { return value_of(object, key, 0); }

Value::Table table_of(const py::dict& dict, const std::string& path) { return table_of(dict, path, 0); }

Existing existing_named(const std::string& name, bool can_resume) {
  if (name == "error") return Existing::refuse;
  if (name == "replace") return Existing::replace;
  if (name == "resume" && can_resume) return Existing::resume;
  throw Error("existing: found \"" + name + "\"; allowed \"error\", \"replace\"" + (can_resume ? ", \"resume\"" : ""));
}

}  // namespace hamflow::python
