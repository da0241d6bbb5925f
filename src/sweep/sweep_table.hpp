// The rows of a sweep as columns, and the files they go to: sweep.h5, sweep.csv, section.csv.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "sweep.hpp"

namespace hamflow {

/// One column, or several side by side (width > 1), row after row. One of the three holds the values.
struct SweepColumn {
  std::string name;  // a path in sweep.h5, e.g. "final/q"
  std::size_t width = 1;
  bool scalar = true;  // width 1 and no vector that happens to be short
  std::vector<double> numbers{};
  std::vector<std::int64_t> counts{};
  std::vector<std::string> texts{};

  std::size_t rows() const { return std::max({texts.size(), counts.size(), numbers.size()}) / width; }
};

/// Columns in the order in which they are written: /varied/KEY, /member/status, /member/steps, /final/t, q, p,
/// /energy/..., /invariants/NAME/..., /events/..., /stopped_by/..., /observables/NAME; in arithmetic beyond double also
/// /digits/final/t, q, p and /digits/energy/initial, final, the same numbers as decimal texts that read back exactly,
/// and /digits/varied/KEY, the numbers of /varied as they were given. What a member does not have is NaN, or an empty
/// text.
std::vector<SweepColumn> columns_of(const Sweep& sweep);

/// The points of all members' sections, a row a point: /section/member (its number), t, q, p. None where no section is
/// asked for.
std::vector<SweepColumn> section_columns_of(const Sweep& sweep);

/// Both, as they are at one moment.
struct SweepTable {
  std::vector<SweepColumn> members;
  std::vector<SweepColumn> section;
};
inline SweepTable table_of(const Sweep& sweep) { return {columns_of(sweep), section_columns_of(sweep)}; }

/// How often a member has met its hard walls; those of one name together.   @param walls see bounce_names()
struct EventCount {
  std::string name;
  std::int64_t count = 0;
};
std::vector<EventCount> bounces_of(const MemberRow& row, const std::vector<std::string>& walls);

/// What is the same for all rows.
struct SweepDescription {
  std::string version;
  std::string host;
};

/// @throws FileError
void write_sweep_h5(const std::filesystem::path& file, const Sweep& sweep, const SweepTable& table,
                    const SweepDescription& description);
/// What the i-th part of a column is called in CSV: "final/q1", and without their table "problem.k" and "member".
std::string csv_name(const SweepColumn& column, std::size_t i);
/// sweep.csv, and section.csv where a section is asked for. @throws FileError
void write_sweep_csv(const std::filesystem::path& folder, SweepTable table);

}  // namespace hamflow
