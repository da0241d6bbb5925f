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
/// and /digits/varied/KEY, the numbers of /varied as they were given. A name that one member has is a column of all:
/// what a member does not have is NaN, an empty text, or no event.
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

/// How often a member has met each hard wall that any of them has, those of one name together, and each event of the
/// user, and how many steps were halved where a method can do that: the same names for all members.
struct EventCount {
  std::string name;
  std::int64_t count = 0;
};
std::vector<EventCount> events_of(const Sweep& sweep, std::size_t member);

/// What a member's row has under a name; null where it has nothing.
template <class T>
const T* value_of(const Sweep& sweep, const UnitedName& name, std::size_t member, std::vector<T> MemberRow::*list) {
  const std::vector<std::size_t>& places = sweep.names().places(name, member);
  const std::vector<T>& all = sweep.rows()[member].*list;
  return places.empty() || places.front() >= all.size() ? nullptr : &all[places.front()];
}

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
