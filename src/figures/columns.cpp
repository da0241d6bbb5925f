#include "columns.hpp"

#include <algorithm>

#include "hamflow/core/error.hpp"
#include "hamflow/core/text.hpp"
#include "panels.hpp"
#include "text.hpp"

namespace hamflow::figures {

std::vector<Column> columns_of(const FigureData& data) {
  const auto values = [](const std::vector<double>& list) { return [&list] { return list; }; };
  std::vector<Column> all{{"t", symbol("t"), Sort::time, values(data.t)}};
  const auto is_angle = [&](std::size_t i) {
    return std::find(data.angles.begin(), data.angles.end(), data.coordinates[i]) != data.angles.end();
  };
  for (std::size_t i = 0; i < data.q.size(); ++i) {
    const Sort sort = is_angle(i) ? Sort::angle : Sort::position;
    all.push_back({data.coordinates[i], symbol(data.coordinates[i]), sort, values(data.q[i])});
  }
  for (std::size_t i = 0; i < data.p.size(); ++i) {
    const Sort sort = is_angle(i) ? Sort::angular_momentum : Sort::momentum;
    all.push_back({data.momenta[i], symbol(data.momenta[i]), sort, values(data.p[i])});
  }
  if (!data.energy.empty()) {
    all.push_back({"energy", energy_name, Sort::energy, values(data.energy)});
    all.push_back({"energy-error", energy_error_label(data), Sort::energy_error,
                   [&data] { return relative_energy_error(data); }});
  }
  for (const auto& [name, list] : data.observables) all.push_back({name, quantity(name), Sort::other, values(list)});
  for (const auto& [name, list] : data.invariants) {
    const bool taken =  // a conserved momentum is already a column
        std::any_of(all.begin(), all.end(), [&name = name](const Column& other) { return other.name == name; });
    if (!taken) all.push_back({name, quantity(name), Sort::other, values(list)});
  }
  for (const auto& [name, list] : data.diagnostics) all.push_back({name, escaped(name), Sort::other, values(list)});
  return all;
}

std::string unit_of(const Figure& figure, Sort sort) {
  const FigureUnits units = units_of(figure);
  return sort == Sort::time       ? units.t
         : sort == Sort::position ? units.q
         : sort == Sort::momentum ? units.p
         : sort == Sort::energy   ? units.energy
                                  : "";
}

std::string axis_label(const Figure& figure, const Column& column) {
  return in_unit(column.label, unit_of(figure, column.sort));
}

std::vector<std::string> column_names(const FigureData& data) {
  std::vector<std::string> names;
  for (const Column& column : columns_of(data)) names.push_back(column.name);
  return names;
}

Column column_of(const FigureData& data, const std::string& name) {
  for (Column& column : columns_of(data)) {
    if (column.name == name) return std::move(column);
  }
  const std::vector<std::string> names = column_names(data);
  throw Error("found \"" + name + "\"; allowed " + joined(names) + suggestion(name, names));
}

}  // namespace hamflow::figures
