// A map: a number for each pair of values of two keys of a scenario. Each cell is a run of its own; the text is read
// once, and cells run together in lanes if their steps can.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hamflow/scenario/scenario.hpp"
#include "member_reader.hpp"
#include "members.hpp"

namespace hamflow {

class Map {
 public:
  /// @param x, y PATH=a:b:n   @param observable see web/src/engine/protocol.ts
  /// @throws Rejection if no cell can be read; Error if the observable cannot be computed
  Map(const std::string& text, const std::string& x, const std::string& y, std::string observable, std::int64_t steps);
  std::size_t columns() const { return varied_.keys()[1].count(); }
  std::size_t rows() const { return varied_.keys()[0].count(); }
  std::size_t lanes() const { return lanes_; }
  /// Computes the cells first, first + stride, ..., at most `count`, until the time is over.
  void compute(std::size_t first, std::size_t stride, std::size_t count, double milliseconds);
  /// The numbers of these cells.
  const std::vector<double>& numbers() const { return numbers_; }

 private:
  enum class Kind { lyapunov, energy_error, relative_energy_error, bounces, expression };
  /// A cell that is read.
  struct Cell {
    std::size_t place;  // in numbers_
    Scenario scenario;
    Member member;
  };

  std::optional<Cell> read_cell(std::size_t number, std::size_t place);
  std::optional<Cell> made_cell(std::size_t number, std::size_t place) const;
  bool are_makeable();
  bool is_ready_for(const Cell& cell) const;
  void prepare(const Cell& cell);
  void run(std::vector<Cell>& cells);
  void run_together(std::span<const Cell> cells);
  void run_in_lanes(std::span<const Cell> cells);
  void run_alone(const Cell& cell);
  void find_exponents(std::span<const Cell> cells);
  double number(const Cell& cell, const Frame& frame, const Excursion& energy, const std::vector<WallCount>& walls);

  Varied varied_;
  MemberReader reader_;
  std::optional<Scenario> pattern_;  // cells are made of it; nothing: each is read
  std::string observable_;
  Kind kind_ = Kind::expression;
  std::int64_t steps_;
  std::vector<double> numbers_;
  // of the last cells
  std::optional<Request> request_;
  ParameterShape shape_;
  std::unique_ptr<EnsembleBlock> block_;
  std::size_t lanes_ = 0;  // 0: cells run alone
  std::optional<std::pair<Texts, StateExpression>> expression_;
};

/// The keys of a scenario whose values are numbers, each with its value.
std::vector<std::pair<std::string, double>> sweepable_keys(const std::string& text);

}  // namespace hamflow
