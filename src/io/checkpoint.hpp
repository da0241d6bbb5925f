// checkpoint.bin: the state from which a run can be resumed, bit for bit. A new checkpoint is written to another file,
// forced to the disk, and renamed. So there is a complete checkpoint at any time, the old one or the new one, also
// after a crash. It records how many rows of run.h5 and bytes of trajectory.csv belong to it; anything after them is
// dropped when the run is resumed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "hamflow/detail/core/archive.hpp"

namespace hamflow {

/// State of one observer of the run.
struct ObserverRecord {
  std::string name;
  std::vector<std::byte> bytes;  // written by Observer::archive()

  template <class Archive>
  void archive(Archive& ar) {
    ar(name, bytes);
  }
};

struct Checkpoint {
  std::string identity;           // identity of the run, which run.h5 also contains
  std::string version;            // version of hamflow
  std::vector<std::string> keys;  // settings of the scenario
  std::vector<std::string> values;
  std::int64_t steps = 0;  // steps of the whole run
  std::int64_t step = 0;   // steps taken so far
  std::int64_t record_every = 0;
  std::uint64_t rows = 0;                 // rows of run.h5
  std::uint64_t section_rows = 0;         // rows of its section
  std::uint64_t wall_rows = 0;            // rows of its bounces
  std::vector<std::uint64_t> event_rows;  // rows for each event of the user
  std::uint64_t csv_bytes = 0;            // bytes of trajectory.csv
  std::uint64_t csv_hash = 0;             // hash of these bytes
  std::uint64_t summary_hash = 0;         // hash of summary.json; 0 if there is none yet
  double wall_seconds = 0;
  std::vector<std::byte> simulation;      // written by Simulation::save(); empty if no step was saved yet
  std::vector<ObserverRecord> observers;  // observers of the run's measurements

  template <class Archive>
  void archive(Archive& ar) {
    ar(identity, version, keys, values, steps, step, record_every, rows, section_rows, wall_rows, event_rows, csv_bytes,
       csv_hash, summary_hash, wall_seconds, simulation, observers);
  }
};

/// @throws FileError; the old checkpoint is kept in this case
void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint);
/// @throws FileError if it cannot be read, is damaged, or has another format
Checkpoint read_checkpoint(const std::filesystem::path& file);

}  // namespace hamflow
