// Tables of a run that is being filled.
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
  std::vector<std::uint64_t> events{};  // in the order of RunDescription::events; missing entries are 0
};

class RunRows {
 public:
  /// @param before rows that a resumed run already has in its files, which are not in memory
  explicit RunRows(const RunDescription& run, const std::optional<RowCounts>& before = {});

  /// Adds a row. @throws Error if a number has more digits than the description says   @param observables one value for
  /// each observable
  void append(const Frame& frame, std::span<const double> observables = {});
  void append(const SectionPoint& point);
  void append(const Bounce& bounce);
  /// @param event its index in the description   @param step the step that contains the event
  void append(std::size_t event, std::int64_t step, const SectionPoint& point);

  /// Numbers of all rows so far, including those that are not in memory.
  RowCounts counts() const;
  std::uint64_t event_rows(std::size_t event) const { return before_.events[event] + tables_.events[event].rows(); }
  std::uint64_t bounce_rows() const { return before_.bounces + tables_.bounces.rows(); }
  /// Whether all rows are in memory.
  bool complete() const { return complete_; }
  /// Removes rows from memory that have been written.
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
