#include "tables.hpp"

#include <pybind11/stl.h>

#include <memory>

#include "bindings.hpp"

namespace py = pybind11;

namespace hamflow::python {

namespace {

template <class T>
py::array view(const Column& column, std::span<const T> values, const py::handle& owner) {
  const auto rows = static_cast<py::ssize_t>(column.rows());
  const auto width = static_cast<py::ssize_t>(column.info().width);
  const auto size = static_cast<py::ssize_t>(sizeof(T));
  py::array array = column.info().scalar
                        ? py::array(py::dtype::of<T>(), {rows}, {size}, values.data(), owner)
                        : py::array(py::dtype::of<T>(), {rows, width}, {width * size, size}, values.data(), owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

}  // namespace

py::object array_of(const Column& column, const py::handle& owner) {
  switch (column.info().type) {
    case ValueType::number:
      return view(column, column.numbers(), owner);
    case ValueType::integer:
      return view(column, column.integers(), owner);
    case ValueType::text:
      break;
  }
  py::list rows;
  for (std::size_t k = 0; k < column.rows(); ++k) {
    if (column.info().scalar) {
      rows.append(py::str(std::string(column.text(k))));
    } else {
      rows.append(py::cast(column.row_of_texts(k)));
    }
  }
  return std::move(rows);
}

py::array_t<double> array_of(const std::vector<double>& numbers) {
  return py::array_t<double>(static_cast<py::ssize_t>(numbers.size()), numbers.data());
}

void bind_tables(py::module_& m) {
  py::class_<Table, std::shared_ptr<Table>>(m, "Table")
      .def("__len__", &Table::rows)
      .def("__contains__", [](const Table& table, const std::string& name) { return table.find(name) != nullptr; })
      .def("__getitem__", [](const py::object& self,
                             const std::string& name) { return array_of(self.cast<const Table&>()[name], self); })
      .def_property_readonly("columns",
                             [](const Table& table) {
                               std::vector<std::string> names;
                               for (const Column& column : table.columns()) names.push_back(column.name());
                               return names;
                             })
      .def("about",
           [](const Table& table, const std::string& name) {
             const ColumnInfo& info = table[name].info();
             py::dict about;
             about["meaning"] = info.meaning;
             about["unit"] = info.unit;
             about["parts"] = info.parts;
             return about;
           })
      .def_property_readonly("name", &Table::name);
}

}  // namespace hamflow::python
