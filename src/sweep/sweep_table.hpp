// Makes tables from the rows of a sweep, and writes them to sweep.h5, sweep.csv and section.csv.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "hamflow/core/table.hpp"
#include "sweep.hpp"

namespace hamflow {

/// Returns a table with a row for each member. Columns, in the order in which they are written: varied/KEY,
/// member/status, member/steps, final/t, q, p, energy/..., invariants/NAME/..., events/..., stopped_by/...,
/// observables/NAME. In arithmetic beyond double digits/final/t, q, p and digits/energy/initial, final follow, the same
/// numbers as decimal texts that read back exactly, and digits/varied/KEY, the varied numbers as they were given. If
/// one member has a name, all have that column; a member without it has NaN, an empty text, or the count 0.
Table members_of(const Sweep& sweep);

/// Returns a table with a row for each point of the sections of all members: section/member (the member's number), t,
/// q, p. It has no columns if no section is requested.
Table sections_of(const Sweep& sweep);

/// Both tables at the same moment.
struct SweepTables {
  Table members;
  Table section;
};
inline SweepTables tables_of(const Sweep& sweep) { return {members_of(sweep), sections_of(sweep)}; }

/// The number of times that a member met each hard wall that any member has (walls of one name are counted together),
/// the number of times that each event of the user occurred, and the number of halved steps if a method can halve. All
/// members have the same names.
struct EventCount {
  std::string name;
  std::int64_t count = 0;
};
std::vector<EventCount> events_of(const Sweep& sweep, std::size_t member);

/// Returns the entry of a member's row with this name; null if it has none.
template <class T>
const T* value_of(const Sweep& sweep, const MergedName& name, std::size_t member, std::vector<T> MemberRow::*list) {
  const std::vector<std::size_t>& places = sweep.names().places(name, member);
  const std::vector<T>& all = sweep.row(member).*list;
  return places.empty() || places.front() >= all.size() ? nullptr : &all[places.front()];
}

/// Data that all rows share.
struct SweepDescription {
  std::string version;
  std::string host;
};

/// @throws FileError
void write_sweep_h5(const std::filesystem::path& file, const Sweep& sweep, const SweepTables& tables,
                    const SweepDescription& description);
/// Returns the name of component i of a column in CSV: "final/q1"; without the table's name "problem.k" and "member".
std::string csv_name(const Column& column, std::size_t i);
/// Writes sweep.csv, and section.csv if a section is requested. @throws FileError
void write_sweep_csv(const std::filesystem::path& folder, const SweepTables& tables);

}  // namespace hamflow
