// run.h5 under kill -9: every row that was confirmed (flushed) before the kill has to be read back, bit for bit.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "hamflow/core/error.hpp"
#include "run_file.hpp"

namespace hamflow {
namespace {

/// The k-th row, recognisable in every column.
Frame row(std::int64_t k) {
  Frame frame;
  frame.step = k;
  frame.time = 0.1 * static_cast<double>(k);
  frame.q = {1.0 / static_cast<double>(k + 1), -static_cast<double>(k)};
  frame.p = {static_cast<double>(k) * 3.0, 0.5};
  frame.energy = -static_cast<double>(k) / 7;
  frame.invariants = {static_cast<double>(k) + 0.25};
  return frame;
}

const RunDescription description{.scenario = "text",
                                 .version = "0",
                                 .host = "h",
                                 .problem = "p",
                                 .method = "m",
                                 .arithmetic = "double",
                                 .dimension = 2,
                                 .invariants = {{"angular_momentum", 1}}};

/// A run.h5 that is being written.
class Written {
 public:
  /// @param kept rows of the samples of the file that is there; none: a new file
  Written(const std::filesystem::path& file, const RunDescription& run, std::optional<std::uint64_t> kept = {})
      : rows_(run, kept ? std::optional(RowCounts{.samples = *kept}) : std::nullopt), file_(file, run, rows_) {}
  template <class... Row>
  void append(const Row&... row) {
    rows_.append(row...);
    file_.flush_if_many();
  }
  void flush() { file_.flush(); }
  std::uint64_t rows() const { return rows_.counts().samples; }

 private:
  RunRows rows_;
  RunFile file_;
};

class RunFileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    file_ = std::filesystem::temp_directory_path() / ("hamflow_" + std::to_string(getpid()) + ".h5");
  }
  void TearDown() override { std::filesystem::remove(file_); }
  std::filesystem::path file_;
};

std::size_t rows_of(const StoredRun& run) { return run.tables.samples.rows(); }

void expect_rows(const StoredRun& run, std::int64_t at_least) {
  ASSERT_GE(static_cast<std::int64_t>(rows_of(run)), at_least);
  const Table& samples = run.tables.samples;
  const auto q = samples["q"].numbers();
  const auto p = samples["p"].numbers();
  for (std::size_t k = 0; k < rows_of(run); ++k) {
    const Frame wanted = row(static_cast<std::int64_t>(k));
    ASSERT_EQ(samples["t"].numbers()[k], wanted.time);
    ASSERT_EQ(samples["energy"].numbers()[k], wanted.energy);
    for (std::size_t i = 0; i < 2; ++i) {
      ASSERT_EQ(q[2 * k + i], wanted.q[i]);
      ASSERT_EQ(p[2 * k + i], wanted.p[i]);
    }
  }
}

TEST_F(RunFileTest, RoundTrip) {
  {
    Written file(file_, description);
    for (std::int64_t k = 0; k < 20000; ++k) file.append(row(k));
  }
  const StoredRun run = read_run_file(file_);
  EXPECT_EQ(rows_of(run), 20000u);
  expect_rows(run, 20000);
  EXPECT_EQ(run.description.scenario, "text");
  EXPECT_EQ(run.description.method, "m");
}

TEST_F(RunFileTest, RangesOfTheEnergyAreThereWhereTheyAreWritten) {
  RunDescription with_range = description;
  with_range.energy_range = true;
  const auto ranged = [](std::int64_t k) {
    Frame frame = row(k);
    frame.energy_range = {-0.25 * static_cast<double>(k), 0.5 * static_cast<double>(k)};
    return frame;
  };
  {
    Written file(file_, with_range);
    for (std::int64_t k = 0; k < 700; ++k) file.append(ranged(k));
  }
  {
    Written file(file_, with_range, 500);  // goes on behind them
    for (std::int64_t k = 500; k < 600; ++k) file.append(ranged(k));
  }
  const StoredRun run = read_run_file(file_);
  expect_rows(run, 600);
  const auto least = run.tables.samples["energy_error_min"].numbers();
  const auto largest = run.tables.samples["energy_error_max"].numbers();
  ASSERT_EQ(least.size(), 600U);
  ASSERT_EQ(largest.size(), 600U);
  for (std::size_t k = 0; k < 600; ++k) {
    EXPECT_EQ(least[k], -0.25 * static_cast<double>(k));
    EXPECT_EQ(largest[k], 0.5 * static_cast<double>(k));
  }
  { Written(file_, description).append(row(0)); }  // as files of older versions are
  EXPECT_EQ(rows_of(read_run_file(file_)), 1U);
  EXPECT_EQ(read_run_file(file_).tables.samples.find("energy_error_min"), nullptr);
}

TEST_F(RunFileTest, PointsOfASectionHaveRowsOfTheirOwn) {
  RunDescription with_section = description;
  with_section.section = true;
  {
    Written file(file_, with_section);
    for (std::int64_t k = 0; k < 3; ++k) file.append(row(k));
    for (int k = 0; k < 5; ++k) file.append(SectionPoint{0.25 * k, {0.0, 1.0 * k}, {2.0 * k, 3.0 * k}, 0});
    file.flush();
    EXPECT_EQ(read_run_file(file_).tables.section.rows(), 5U);
    file.append(SectionPoint{1.25, {0, 5}, {10, 15}, 0});
  }
  const StoredRun run = read_run_file(file_);
  expect_rows(run, 3);
  const Table& section = run.tables.section;
  ASSERT_EQ(section.rows(), 6U);
  for (std::size_t k = 0; k < 6; ++k) {
    const auto x = static_cast<double>(k);
    EXPECT_EQ(section["t"].numbers()[k], 0.25 * x);
    EXPECT_EQ(section["q"].row(k)[1], x);
    EXPECT_EQ(section["p"].row(k), (std::vector<double>{2 * x, 3 * x}));
  }
}

TEST_F(RunFileTest, DigitsHaveRowsOfTheirOwnWidth) {
  RunDescription in_quad = description;
  in_quad.digits_length = 8;
  const auto with_digits = [](std::int64_t k) {
    Frame frame = row(k);
    const std::string text = std::to_string(k);
    frame.digits = {.time = "0." + text, .q = {text, "-" + text}, .p = {"1e-" + text, ""}, .energy = "12345678"};
    return frame;
  };
  {
    Written file(file_, in_quad);
    for (std::int64_t k = 0; k < 3000; ++k) file.append(with_digits(k));
    Frame longer = with_digits(0);
    longer.digits.energy = "123456789";
    EXPECT_THROW(file.append(longer), Error);
  }
  {
    Written file(file_, in_quad, 2000);  // goes on behind them
    for (std::int64_t k = 2000; k < 2500; ++k) file.append(with_digits(k));
  }
  const Table samples = read_run_file(file_, {.digits = true}).tables.samples;
  ASSERT_EQ(samples.rows(), 2500U);
  for (std::int64_t k = 0; k < 2500; ++k) {
    const FrameDigits wanted = with_digits(k).digits;
    const auto at = static_cast<std::size_t>(k);
    ASSERT_EQ(samples["digits/t"].text(at), wanted.time);
    ASSERT_EQ(samples["digits/energy"].text(at), wanted.energy);
    ASSERT_EQ(samples["digits/q"].row_of_texts(at), wanted.q);
    ASSERT_EQ(samples["digits/p"].row_of_texts(at), wanted.p);
  }
  in_quad.digits_length = 9;
  EXPECT_THROW(Written(file_, in_quad, 1), FileError);
  { Written(file_, description).append(row(0)); }
  EXPECT_EQ(read_run_file(file_, {.digits = true}).tables.samples.find("digits/t"), nullptr);
}

TEST_F(RunFileTest, ADamagedRowIsAnErrorAndNotAnotherRow) {
  {
    Written file(file_, description);
    for (std::int64_t k = 0; k < 700; ++k) file.append(row(k));
  }
  // The bytes of some coordinate: q[1] of row 543.
  std::fstream file(file_, std::ios::in | std::ios::out | std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  const double wanted = row(543).q[1];
  const std::size_t at = bytes.find(std::string(reinterpret_cast<const char*>(&wanted), sizeof wanted));
  ASSERT_NE(at, std::string::npos);
  file.seekp(static_cast<std::streamoff>(at));
  file.put(static_cast<char>(bytes[at] ^ 1));
  file.close();
  EXPECT_THROW(read_run_file(file_), FileError);
  EXPECT_THROW(Written(file_, description, 700), FileError);
  Written(file_, description, 100);  // what is not damaged is there to go on from
}

TEST_F(RunFileTest, NamesOfALargeSystemAreThere) {
  RunDescription large = description;
  large.dimension = 30000;
  for (std::size_t i = 0; i < large.dimension; ++i) {
    large.coordinates.push_back("q" + std::to_string(i + 1));
    large.momenta.push_back("p" + std::to_string(i + 1));
  }
  Frame frame = row(0);
  frame.q.assign(large.dimension, 1.0);
  frame.p.assign(large.dimension, 2.0);
  { Written(file_, large).append(frame); }
  EXPECT_EQ(read_run_file(file_).tables.samples["q"].info().width, large.dimension);
}

TEST_F(RunFileTest, ReadableWhileItGrows) {
  Written file(file_, description);
  for (std::int64_t k = 0; k < 100; ++k) file.append(row(k));
  file.flush();
  expect_rows(read_run_file(file_), 100);
}

TEST_F(RunFileTest, GoesOnAfterTheRowsThatStay) {
  for (const std::uint64_t kept : {0u, 1u, 777u, 20000u}) {  // within a chunk, and over several batches
    {
      Written file(file_, description);
      for (std::int64_t k = 0; k < 20000; ++k) file.append(row(k));
    }
    Written file(file_, description, kept);
    EXPECT_EQ(file.rows(), kept);
    expect_rows(read_run_file(file_), static_cast<std::int64_t>(kept));
    for (auto k = static_cast<std::int64_t>(kept); k < 21000; ++k) file.append(row(k));
    EXPECT_EQ(file.rows(), 21000u);
    file.flush();
    const StoredRun run = read_run_file(file_);
    EXPECT_EQ(rows_of(run), 21000u);
    expect_rows(run, 21000);
  }
}

TEST_F(RunFileTest, CannotGoOnAfterMoreRowsThanThereAre) {
  { Written(file_, description).append(row(0)); }
  EXPECT_THROW(Written(file_, description, 2), FileError);
  RunDescription other = description;
  other.dimension = 3;
  EXPECT_THROW(Written(file_, other, 1), FileError);
  expect_rows(read_run_file(file_), 1);  // it is as it was
  EXPECT_FALSE(std::filesystem::exists(file_.string() + ".new"));
}

TEST_F(RunFileTest, RowsOfALargeSystemDoNotPileUp) {
  RunDescription large = description;
  large.dimension = 100000;
  Written file(file_, large);
  Frame frame = row(0);
  frame.q.assign(large.dimension, 1.0);
  frame.p.assign(large.dimension, 2.0);
  for (int k = 0; k < 40; ++k) file.append(frame);
  // 2^20 numbers wait at most: 5 rows of 200010 numbers.
  EXPECT_EQ(rows_of(read_run_file(file_)), 40u);
}

TEST_F(RunFileTest, ConfirmedRowsAreThereToGoOnFromAfterAKill) {
  for (int round = 0; round < 10; ++round) {
    std::filesystem::remove(file_);
    int confirmed[2];
    ASSERT_EQ(pipe(confirmed), 0);
    const pid_t child = fork();
    if (child == 0) {
      close(confirmed[0]);
      Written file(file_, description);
      for (std::int64_t k = 0;; ++k) {
        file.append(row(k));
        if (k % 37 != 36) continue;
        file.flush();
        const std::int64_t count = k + 1;
        if (write(confirmed[1], &count, sizeof count) != sizeof count) _exit(1);
      }
    }
    close(confirmed[1]);
    std::this_thread::sleep_for(std::chrono::milliseconds(20 + 7 * round));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    std::int64_t last = 0;
    for (std::int64_t count = 0; read(confirmed[0], &count, sizeof count) == sizeof count;) last = count;
    close(confirmed[0]);
    if (last == 0) continue;
    Written file(file_, description, static_cast<std::uint64_t>(last));
    for (std::int64_t k = last; k < last + 100; ++k) file.append(row(k));
    file.flush();
    expect_rows(read_run_file(file_), last + 100);
    if (HasFatalFailure()) FAIL() << "round " << round;
  }
}

TEST_F(RunFileTest, NotARunFileIsSaid) {
  EXPECT_THROW(read_run_file("no such file"), FileError);
  EXPECT_THROW(Written("no such folder/run.h5", description), FileError);
}

TEST_F(RunFileTest, ConfirmedRowsSurviveKill) {
  for (int round = 0; round < 30; ++round) {
    std::filesystem::remove(file_);
    int confirmed[2];
    ASSERT_EQ(pipe(confirmed), 0);
    const pid_t child = fork();
    if (child == 0) {
      close(confirmed[0]);
      Written file(file_, description);
      for (std::int64_t k = 0;; ++k) {
        file.append(row(k));
        if (k % 37 != 36) continue;
        file.flush();
        const std::int64_t count = k + 1;
        if (write(confirmed[1], &count, sizeof count) != sizeof count) _exit(1);
      }
    }
    close(confirmed[1]);
    std::this_thread::sleep_for(std::chrono::milliseconds(20 + 7 * round));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    std::int64_t last = 0;
    for (std::int64_t count = 0; read(confirmed[0], &count, sizeof count) == sizeof count;) last = count;
    close(confirmed[0]);
    if (last == 0) continue;  // killed before the first flush
    expect_rows(read_run_file(file_), last);
    if (HasFatalFailure()) FAIL() << "round " << round;
  }
}

}  // namespace
}  // namespace hamflow
