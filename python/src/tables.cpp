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

py::tuple state_of(const Table& table) {
  py::list columns;
  for (const Column& column : table.columns()) {
    const ColumnInfo& info = column.info();
    const auto bytes = column.bytes();
    const std::size_t text_size = info.type == ValueType::text ? column.bytes_of_row() / info.width : 0;
    columns.append(py::make_tuple(info.name, static_cast<int>(info.type), info.width, info.scalar, info.parts,
                                  info.meaning, info.unit, text_size,
                                  py::bytes(reinterpret_cast<const char*>(bytes.data()), bytes.size())));
  }
  return py::make_tuple(table.name(), columns);
}

Table table_of_state(const py::tuple& state) {
  Table table;
  table.rename(state[0].cast<std::string>());
  for (const py::handle each : state[1]) {
    const auto fields = each.cast<py::tuple>();
    Column& column = table.add(ColumnInfo{.name = fields[0].cast<std::string>(),
                                          .type = static_cast<ValueType>(fields[1].cast<int>()),
                                          .width = fields[2].cast<std::size_t>(),
                                          .scalar = fields[3].cast<bool>(),
                                          .parts = fields[4].cast<std::vector<std::string>>(),
                                          .meaning = fields[5].cast<std::string>(),
                                          .unit = fields[6].cast<std::string>(),
                                          .text_size = fields[7].cast<std::size_t>()});
    const auto bytes = fields[8].cast<std::string_view>();
    column.add_bytes(std::as_bytes(std::span(bytes.data(), bytes.size())));
  }
  return table;
}

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
      .def_property_readonly("name", &Table::name)
      .def(
          py::pickle(&state_of, [](const py::tuple& state) { return std::make_shared<Table>(table_of_state(state)); }));
}

}  // namespace hamflow::python
