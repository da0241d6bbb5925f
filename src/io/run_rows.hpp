// The tables of a run while they are filled.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hamflow/detail/run/run_tables.hpp"
#include "hamflow/run/section.hpp"
#include "run_header.hpp"

namespace hamflow {

/// Numbers of rows of the tables of a run.
struct RowCounts {
  std::uint64_t samples = 0;
  std::uint64_t section = 0;
  std::uint64_t bounces = 0;
  std::vector<std::uint64_t> events{};  // in the order of RunDescription::events; fewer of them: the others have none
};

class RunRows {
 public:
  /// @param before of a run that goes on: rows that it has already, which are not in memory
  explicit RunRows(const RunDescription& run, const std::optional<RowCounts>& before = {});

  // Each adds a row. @throws Error where a number has more digits than the description says
  /// @param observables a value for each
  void append(const Frame& frame, std::span<const double> observables = {});
  void append(const SectionPoint& point);
  void append(const Bounce& bounce);
  /// @param event its number in the description   @param step with which it is behind
  void append(std::size_t event, std::int64_t step, const SectionPoint& point);

  /// All rows so far, those that are not in memory included.
  RowCounts counts() const;
  std::uint64_t event_rows(std::size_t event) const { return before_.events[event] + tables_.events[event].rows(); }
  std::uint64_t bounce_rows() const { return before_.bounces + tables_.bounces.rows(); }
  /// Whether all rows are in memory.
  bool complete() const { return complete_; }
  /// Rows that are written elsewhere leave the memory.
  void drop();

  const RunTables& tables() const { return tables_; }
  RunTables take() { return std::move(tables_); }

 private:
  RunTables tables_;
  RowCounts before_;
  bool complete_;
  std::vector<std::size_t> invariant_sizes_;
  bool diagnostics_;
  bool energy_range_;
  bool digits_;
};

}  // namespace hamflow
