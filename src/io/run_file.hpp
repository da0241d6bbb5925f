// run.h5: the samples of a run. Written in single-writer-multiple-readers mode and flushed several times a second, so
// that it can be read while it grows, and after a crash at any moment, up to the last flush. docs/files.md lists what
// is in it. A run that goes on copies the rows that stay into a fresh file, which then takes the place of the old one:
// only a reader can open what a crash leaves. Open a file that was not closed with H5F_ACC_RDONLY | H5F_ACC_SWMR_READ.
#pragma once

#include <chrono>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "h5md.hpp"
#include "hamflow/run/section.hpp"

namespace hamflow {

/// An invariant as a dataset.
struct InvariantColumn {
  std::string name;
  std::size_t size = 1;  // numbers a row
  std::string meaning{};
  std::string unit{};
};

/// Of the columns; empty where nothing is declared.
struct ColumnUnits {
  std::string t{};
  std::string q{};
  std::string p{};
  std::string energy{};
};

/// What stands in the file beside the samples.
struct RunDescription {
  std::string scenario;
  std::string version;
  std::string host;
  std::string problem;
  std::string method;
  std::string arithmetic;
  std::string kernel;
  std::size_t dimension = 0;
  std::vector<InvariantColumn> invariants;
  std::vector<InvariantColumn> observables{};  // expressions of the user, whose text is the meaning
  bool diagnostics = false;                    // of implicit steps
  bool energy_range = false;                   // of the steps between samples
  bool section = false;                        // points of one are written
  bool walls = false;                          // bounces are
  std::vector<std::string> events{};           // those of the user, by name
  std::size_t samples = 0;                     // expected, so that a short run leaves a small file; 0: unknown
  std::string created;                         // empty: now
  double dt = 0;
  std::string dt_text{};                   // as it was given
  std::vector<std::string> coordinates{};  // a name for each number of q; none: they are not written
  std::vector<std::string> momenta{};
  std::vector<double> masses{};  // of the bodies; none: not written
  H5mdParticles particles{};     // of a gas: positions and momenta as H5MD wants them, instead of /q and /p
  ColumnUnits units{};
  std::size_t digits_length = 0;  // characters of a number beyond double; 0: numbers are doubles
  std::string identity{};         // of the run, the attribute `run`; empty: none, nothing can go on in the file
};

/// Writes one row per sample.
class RunFile {
 public:
  /// @throws FileError
  RunFile(const std::filesystem::path& file, const RunDescription& description);
  /// Goes on after the first `rows` rows, `section_rows` points of the section and `wall_rows` bounces of a file that
  /// is there, however it was left. @throws FileError; the file is then as it was
  RunFile(const std::filesystem::path& file, const RunDescription& description, std::uint64_t rows,
          std::uint64_t section_rows = 0, std::uint64_t wall_rows = 0, std::span<const std::uint64_t> event_rows = {});
  ~RunFile();
  /// @param observables a value for each
  void append(const Frame& frame, std::span<const double> observables = {});
  void append(const SectionPoint& point);
  void append(const Bounce& bounce);
  /// @param event its number in the description   @param step with which it is behind
  void append(std::size_t event, std::int64_t step, const SectionPoint& point);
  /// Appended so far, written or not.
  std::uint64_t rows() const;
  std::uint64_t section_rows() const;
  std::uint64_t wall_rows() const;
  const std::vector<std::uint64_t>& event_rows() const;
  /// Writes and flushes what has gathered. @throws FileError, e.g. when the disk is full
  void flush();
  /// Flushes if some time has passed since the last flush: bounds what a crash can lose.
  void flush_if_due();

 private:
  struct Impl;
  static std::unique_ptr<Impl> create(const std::filesystem::path& file, const RunDescription& description);
  std::unique_ptr<Impl> impl_;
};

/// Everything of a run.h5, whole or cut short by a crash (then up to the last complete row).
struct RunSamples {
  RunDescription description;
  std::vector<double> t;
  std::vector<std::vector<double>> q;  // q[i][k]: coordinate i at sample k
  std::vector<std::vector<double>> p;
  std::vector<double> energy;
  std::vector<double> least_difference;  // of H - H0 since the sample before; empty unless the run has them
  std::vector<double> largest_difference;
  std::vector<std::pair<std::string, std::vector<double>>> observables;  // by name
  std::vector<std::pair<std::string, std::vector<double>>>
      invariants;  // NAME, or NAME_1, NAME_2, ... of several numbers
  std::vector<std::pair<std::string, std::vector<double>>> diagnostics;  // empty unless the run was asked for them
  std::vector<double> section_t;                                         // of the points of a section
  std::vector<std::vector<double>> section_q;
  std::vector<std::vector<double>> section_p;
  std::vector<double> wall_t;  // of the bounces that were recorded
  std::vector<std::vector<double>> wall_q;
  std::vector<std::string> left_out;  // sentences: what stands among the samples and is no column of them
};

/// @param most_coordinates above them q and p stay empty, and description.dimension says how many there are
/// @throws FileError naming the file and what is wrong with it
RunSamples read_run_file(const std::filesystem::path& file,
                         std::size_t most_coordinates = std::numeric_limits<std::size_t>::max());

/// q at one sample.   @throws FileError
std::vector<double> read_run_positions(const std::filesystem::path& file, std::size_t sample);

/// The samples of a run beyond double with all their digits: decimal texts that read back to the last bit
/// (evaluate_number in the arithmetic of the run; run/digits.hpp).
struct RunDigits {
  std::vector<std::string> t;
  std::vector<std::vector<std::string>> q;  // q[i][k]: coordinate i at sample k
  std::vector<std::vector<std::string>> p;
  std::vector<std::string> energy;
};

/// The samples of read_run_file; of a run that goes on or was cut short perhaps some more or fewer. All empty where the
/// run was in double.
/// @throws FileError naming the file and what is wrong with it
RunDigits read_run_digits(const std::filesystem::path& file);

}  // namespace hamflow
