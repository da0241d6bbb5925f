// checkpoint.bin: where a run can go on, bit for bit. Written beside its predecessor, forced to the disk, then renamed
// onto it: whenever a crash comes, one whole checkpoint is there, the old one or the new one. It names the rows of
// run.h5 and the bytes of trajectory.csv that belong to it; what stands behind them is dropped when the run goes on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "hamflow/detail/core/archive.hpp"

namespace hamflow {

/// What one observer of the run has seen.
struct ObserverRecord {
  std::string name;
  std::vector<std::byte> bytes;  // Observer::archive()

  template <class Archive>
  void archive(Archive& ar) {
    ar(name, bytes);
  }
};

struct Checkpoint {
  std::string identity;           // of the run: the same in its run.h5
  std::string version;            // of hamflow
  std::vector<std::string> keys;  // the scenario's settings
  std::vector<std::string> values;
  std::int64_t steps = 0;  // to be taken
  std::int64_t step = 0;   // taken
  std::int64_t record_every = 0;
  std::uint64_t rows = 0;                 // of run.h5
  std::uint64_t section_rows = 0;         // of its section
  std::uint64_t wall_rows = 0;            // of its bounces
  std::vector<std::uint64_t> event_rows;  // of each event of the user
  std::uint64_t csv_bytes = 0;            // of trajectory.csv
  std::uint64_t csv_hash = 0;             // of these bytes
  std::uint64_t summary_hash = 0;         // of summary.json; 0 while there is none
  double wall_seconds = 0;
  std::vector<std::byte> simulation;      // Simulation::save(); empty where no step was saved yet
  std::vector<ObserverRecord> observers;  // of what is measured on the way

  template <class Archive>
  void archive(Archive& ar) {
    ar(identity, version, keys, values, steps, step, record_every, rows, section_rows, wall_rows, event_rows, csv_bytes,
       csv_hash, summary_hash, wall_seconds, simulation, observers);
  }
};

/// @throws FileError; the checkpoint that was there is then still there
void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint);
/// @throws FileError when it cannot be read, is damaged or of another format
Checkpoint read_checkpoint(const std::filesystem::path& file);

}  // namespace hamflow
