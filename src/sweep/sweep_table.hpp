// The rows of a sweep as columns, and the files they go to: sweep.h5, sweep.csv, section.csv.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "hamflow/core/table.hpp"
#include "sweep.hpp"

namespace hamflow {

/// A row for each member, in the order in which columns are written: varied/KEY, member/status, member/steps, final/t,
/// q, p, energy/..., invariants/NAME/..., events/..., stopped_by/..., observables/NAME; in arithmetic beyond double
/// also digits/final/t, q, p and digits/energy/initial, final, the same numbers as decimal texts that read back
/// exactly, and digits/varied/KEY, the numbers of varied as they were given. A name that one member has is a column of
/// all: what a member does not have is NaN, an empty text, or no event.
Table members_of(const Sweep& sweep);

/// A row for each point of the sections of all members: section/member (its number), t, q, p. No column where no
/// section is asked for.
Table sections_of(const Sweep& sweep);

/// Both, as they are at one moment.
struct SweepTables {
  Table members;
  Table section;
};
inline SweepTables tables_of(const Sweep& sweep) { return {members_of(sweep), sections_of(sweep)}; }

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
void write_sweep_h5(const std::filesystem::path& file, const Sweep& sweep, const SweepTables& tables,
                    const SweepDescription& description);
/// What the i-th part of a column is called in CSV: "final/q1", and without their table "problem.k" and "member".
std::string csv_name(const Column& column, std::size_t i);
/// sweep.csv, and section.csv where a section is asked for. @throws FileError
void write_sweep_csv(const std::filesystem::path& folder, const SweepTables& tables);

}  // namespace hamflow
