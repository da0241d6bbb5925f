// A sweep in shards: several processes, possibly on several machines, run parts of the members. Each has a folder of
// its own within the folder of the sweep, with a journal members.bin. The journal of the sweep is the union of all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "hamflow/workflow/sweep.hpp"

namespace hamflow {

inline constexpr const char* members_file = "members.bin";

/// The journals of all shards in the folder of a sweep, ordered by count and index.
std::vector<std::filesystem::path> shard_journals(const std::filesystem::path& folder);
/// Names of the shards, "3/64", that have members which are not finished. Of shards with different counts those with
/// the largest are named. Empty if the folder has no shards.
std::vector<std::string> missing_shards(const std::filesystem::path& folder, const std::vector<bool>& is_finished);
/// A hash of elementary functions of the C library at some points. Their last bits differ between versions and
/// processors, and with them the bits of members.
std::uint64_t functions_of_this_machine();

}  // namespace hamflow
