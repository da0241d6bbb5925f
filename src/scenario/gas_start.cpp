#include "gas_start.hpp"

#include <algorithm>
#include <fstream>

#include "hamflow/core/counter_random.hpp"
#include "hamflow/core/number.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/detail/core/option_info.hpp"
#include "hamflow/run/gas.hpp"

namespace hamflow {

namespace {

/// Calls put(i) for each coordinate of each particle, where i is the particle's index along that coordinate, from 0.
template <class Put>
void each_place(std::int64_t n, std::size_t space, const Put& put) {
  std::int64_t all = 1;
  for (std::size_t k = 0; k < space; ++k) all *= n;
  for (std::int64_t particle = 0; particle < all; ++particle) {
    std::int64_t rest = particle;
    for (std::size_t k = 0; k < space; ++k) {
      put(rest % n);
      rest /= n;
    }
  }
}

/// Writes 2e-5 m - 1 as a decimal with five places.
std::string fifty_thousandths(std::uint64_t m) {
  const auto hundred_thousandths = static_cast<std::int64_t>(2 * m) - 100000;
  const std::int64_t size = std::abs(hundred_thousandths);
  std::string digits = std::to_string(size % 100000);
  digits.insert(0, 5 - digits.size(), '0');
  return (hundred_thousandths < 0 ? "-" : "") + std::to_string(size / 100000) + "." + digits;
}

struct Cell {
  std::string text;
  std::size_t column;  // counted from 1
};
std::vector<Cell> cells_of(const std::string& line) {
  std::vector<Cell> cells{{"", 1}};
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == ',') {
      cells.push_back({"", i + 2});
    } else if (c != ' ' && c != '\t' && c != '"' && c != '\r') {
      if (cells.back().text.empty()) cells.back().column = i + 1;
      cells.back().text += c;
    }
  }
  return cells;
}

}  // namespace

GasStart gas_on_lattice(std::int64_t n, std::size_t space, std::uint64_t seed, const std::vector<std::string>& edges) {
  GasStart start;
  const std::string intervals = std::to_string(n - 1);
  const std::string halves = std::to_string(2 * n);
  std::size_t k = 0;
  // Each number is one quotient, so that the positions are exactly symmetric about 0.
  each_place(n, space, [&](std::int64_t i) {
    const std::string place = std::to_string(2 * i - (n - 1));
    start.q.push_back(edges.empty() ? place + "/" + intervals : place + "*(" + edges[k] + ")/" + halves);
    k = (k + 1) % space;
  });
  for (std::size_t i = 0; i < start.q.size(); ++i) {
    const double u = static_cast<double>(counter_bits(seed, i) >> 11) * 0x1p-53;
    start.p.push_back(fifty_thousandths(static_cast<std::uint64_t>(1e5 * u)));
  }
  return start;
}

GasStart gas_in_corner(std::int64_t n, std::size_t space) {
  GasStart start;
  const std::string intervals = std::to_string(n - 1);
  each_place(n, space, [&](std::int64_t i) { start.q.push_back(std::to_string(i) + "/" + intervals); });
  start.p.assign(start.q.size(), "0");
  return start;
}

GasStart gas_from_file(const std::filesystem::path& file, std::size_t space) {
  if (std::filesystem::is_directory(file)) {
    throw Error("found the folder " + file.string() + "; allowed a CSV of particles, or the run.h5 of a run");
  }
  std::ifstream in(file);
  if (!in) throw Error("cannot read the file " + file.string() + "; allowed a CSV of particles");
  std::vector<std::string> names;
  for (const char* const p : {"", "p_"}) {
    for (std::size_t k = 0; k < space; ++k) names.push_back(p + std::string(1, "xyz"[k]));
  }
  const std::string allowed = "; allowed a first row with the names " + joined(names) + " and optionally mass";
  const auto at = [&](std::size_t line, std::size_t column) {
    return " in line " + std::to_string(line) + ", column " + std::to_string(column) + " of " + file.string();
  };
  std::string line;
  if (!std::getline(in, line)) throw Error("found the empty file " + file.string() + allowed);
  if (constexpr std::string_view mark = "\xef\xbb\xbf"; line.starts_with(mark)) line.erase(0, mark.size());
  const std::vector<Cell> head = cells_of(line);
  const auto place_of = [&](const std::string& name) {
    return std::find_if(head.begin(), head.end(), [&](const Cell& cell) { return cell.text == name; });
  };
  for (auto cell = head.begin(); cell != head.end(); ++cell) {
    const std::string found = "found the column '" + cell->text + "'";
    if (place_of(cell->text) != cell) throw Error(found + " twice" + at(1, cell->column) + allowed);
    if (cell->text == "mass" || std::find(names.begin(), names.end(), cell->text) != names.end()) continue;
    std::vector<std::string> known = names;
    known.emplace_back("mass");
    const bool of_space = cell->text == "z" || cell->text == "p_z";
    const std::string place = found + at(1, cell->column);
    if (of_space) throw Error(place + allowed + "; z and p_z need problem." + GasKeys::dimension + " = 3");
    throw Error(place + suggestion(cell->text, known) + allowed);
  }
  std::vector<std::size_t> places;
  for (const std::string& name : names) {
    const auto place = place_of(name);
    if (place == head.end()) throw Error("found no column " + name + " in line 1 of " + file.string() + allowed);
    places.push_back(static_cast<std::size_t>(place - head.begin()));
  }
  const auto mass = place_of("mass");
  GasStart start;
  for (std::size_t row = 2; std::getline(in, line); ++row) {
    const std::vector<Cell> cells = cells_of(line);
    if (cells.size() == 1 && cells[0].text.empty()) continue;
    if (cells.size() != head.size()) {  // points at the first surplus cell, or at the end of the line
      const bool many = cells.size() > head.size();
      throw Error("found " + std::to_string(cells.size()) + " numbers" +
                  at(row, many ? cells[head.size()].column : line.size() + 1) + "; allowed " +
                  std::to_string(head.size()) + ", as many as the first row has names");
    }
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::string wrong = refused_value({.name = head[i].text}, cells[i].text);
      if (wrong.empty()) continue;
      const std::size_t end = std::min(wrong.find("; allowed"), wrong.size());
      throw Error(wrong.substr(0, end) + " for " + head[i].text + at(row, cells[i].column) + wrong.substr(end));
    }
    for (std::size_t i = 0; i < places.size(); ++i) (i < space ? start.q : start.p).push_back(cells[places[i]].text);
    start.lines.push_back(row);
    if (mass == head.end()) continue;
    const Cell& m = cells[static_cast<std::size_t>(mass - head.begin())];
    if (!(number_value(m.text) > 0)) {
      throw Error("found mass " + m.text + at(row, m.column) + "; allowed a positive number");
    }
    start.masses.push_back(m.text);
  }
  if (start.q.empty()) throw Error("found no particle below line 1 of " + file.string() + "; allowed a row for each");
  return start;
}

}  // namespace hamflow
