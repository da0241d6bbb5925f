// members.bin, the checkpoint of a sweep: a header that identifies the sweep, then a record for each finished member,
// appended when it finishes. After a kill, a full disk or damage the last records may be lost; their members are run
// again.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "sweep.hpp"
#include "whole_file.hpp"

namespace hamflow {

/// The header: the settings that must be the same for a sweep to be resumed.
struct SweepHead {
  std::string version;            // of hamflow
  std::vector<std::string> keys;  // settings of the scenario that the members have in common
  std::vector<std::string> values;
  std::vector<std::string> varied;  // PATH=VALUES as they were typed
  bool in_step = false;
  std::uint64_t functions = 0;  // hash of elementary functions of this machine, on which bits can depend
  // The request, from which the sweep can be set up again.
  std::string text;
  std::string name;
  std::vector<std::string> sets;

  template <class Archive>
  void archive(Archive& ar) {
    ar(version, keys, values, varied, in_step, functions, text, name, sets);
  }
};

/// A finished member.
struct FinishedMember {
  std::int64_t steps = 0;  // that it was to take; it took fewer where it failed or an event ended it
  double seconds = 0;      // of the sweep until then, all its parts together
  MemberRow row;

  template <class Archive>
  void archive(Archive& ar) {
    ar(steps, seconds, row);
  }
};

struct SweepPast {
  SweepHead head;
  std::map<std::uint64_t, FinishedMember> members;
  std::uint64_t dropped_bytes = 0;  // at the end, half written or damaged
};

/// @throws FileError if it cannot be read, or its header is damaged or has another format
SweepPast read_journal(const std::filesystem::path& file);
/// @param name of the file, in messages   @throws FileError as read_journal does
SweepPast journal_in(std::span<const std::byte> bytes, const std::string& name);
/// The content of a journal.
std::vector<std::byte> journal_bytes(const SweepPast& past);

/// Appends records. After append() returns, the operating system has the record.
class SweepJournal {
 public:
  /// A file of its own in the place of what was there, with what is known of members.   @throws FileError
  SweepJournal(const std::filesystem::path& file, const SweepPast& past);
  ~SweepJournal();
  SweepJournal(const SweepJournal&) = delete;
  SweepJournal& operator=(const SweepJournal&) = delete;
  /// @throws FileError if it cannot be written, e.g. because the disk is full
  void append(std::uint64_t member, const FinishedMember& finished);
  /// Forces the records to the disk, so that they survive a crash of the machine.   @throws FileError
  void force() const { force_to_disk(file_); }

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

}  // namespace hamflow
