// members.bin, the checkpoint of a sweep. A header identifies the sweep; a record for each finished member follows,
// appended when the member finishes. After a kill, a full disk or damage the last records may be lost; their members
// are run again.
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
struct SweepIdentity {
  std::string version;            // version of hamflow
  std::vector<std::string> keys;  // settings of the scenario that all members share
  std::vector<std::string> values;
  std::vector<std::string> varied;  // PATH=VALUES as the user typed them
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

/// Record of a finished member.
struct FinishedMember {
  std::int64_t steps = 0;  // number of steps requested; fewer were taken if it failed or an event ended it
  double seconds = 0;      // run time of the sweep until then, over all its parts
  MemberRow row;

  template <class Archive>
  void archive(Archive& ar) {
    ar(steps, seconds, row);
  }
};

struct StoredSweep {
  SweepIdentity head;
  std::map<std::uint64_t, FinishedMember> members;
  std::uint64_t dropped_bytes = 0;  // bytes at the end that were incomplete or damaged
};

/// @throws FileError if it cannot be read, or its header is damaged or has another format
StoredSweep read_journal(const std::filesystem::path& file);
/// The same for bytes in memory. @param name name of the file, for messages   @throws FileError like read_journal()
StoredSweep journal_in(std::span<const std::byte> bytes, const std::string& name);
/// Returns the content of a journal.
std::vector<std::byte> journal_bytes(const StoredSweep& past);

/// Appends records. After append() returns, the operating system has the record.
class SweepJournal {
 public:
  /// Replaces the file by a new one that contains `past`.   @throws FileError
  SweepJournal(const std::filesystem::path& file, const StoredSweep& past);
  ~SweepJournal();
  SweepJournal(const SweepJournal&) = delete;
  SweepJournal& operator=(const SweepJournal&) = delete;
  /// @throws FileError if it cannot be written, for example because the disk is full
  void append(std::uint64_t member, const FinishedMember& finished);
  /// Forces the records to the disk, so that they survive a crash of the machine.   @throws FileError
  void force() const { force_to_disk(file_); }

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

}  // namespace hamflow
