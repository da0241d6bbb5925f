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
                                 .kernel = "exact",
                                 .dimension = 2,
                                 .invariants = {{"angular_momentum", 1}}};

class RunFileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    file_ = std::filesystem::temp_directory_path() / ("hamflow_" + std::to_string(getpid()) + ".h5");
  }
  void TearDown() override { std::filesystem::remove(file_); }
  std::filesystem::path file_;
};

void expect_rows(const RunSamples& run, std::int64_t at_least) {
  ASSERT_GE(static_cast<std::int64_t>(run.t.size()), at_least);
  for (std::size_t k = 0; k < run.t.size(); ++k) {
    const Frame wanted = row(static_cast<std::int64_t>(k));
    ASSERT_EQ(run.t[k], wanted.time);
    ASSERT_EQ(run.energy[k], wanted.energy);
    for (std::size_t i = 0; i < 2; ++i) {
      ASSERT_EQ(run.q[i][k], wanted.q[i]);
      ASSERT_EQ(run.p[i][k], wanted.p[i]);
    }
  }
}

TEST_F(RunFileTest, RoundTrip) {
  {
    RunFile file(file_, description);
    for (std::int64_t k = 0; k < 20000; ++k) file.append(row(k));
  }
  const RunSamples run = read_run_file(file_);
  EXPECT_EQ(run.t.size(), 20000u);
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
    RunFile file(file_, with_range);
    for (std::int64_t k = 0; k < 700; ++k) file.append(ranged(k));
  }
  {
    RunFile file(file_, with_range, 500);  // goes on behind them
    for (std::int64_t k = 500; k < 600; ++k) file.append(ranged(k));
  }
  const RunSamples run = read_run_file(file_);
  expect_rows(run, 600);
  ASSERT_EQ(run.least_difference.size(), 600U);
  ASSERT_EQ(run.largest_difference.size(), 600U);
  for (std::size_t k = 0; k < 600; ++k) {
    EXPECT_EQ(run.least_difference[k], -0.25 * static_cast<double>(k));
    EXPECT_EQ(run.largest_difference[k], 0.5 * static_cast<double>(k));
  }
  { RunFile(file_, description).append(row(0)); }  // as files of older versions are
  EXPECT_EQ(read_run_file(file_).t.size(), 1U);
  EXPECT_TRUE(read_run_file(file_).least_difference.empty());
}

TEST_F(RunFileTest, PointsOfASectionHaveRowsOfTheirOwn) {
  RunDescription with_section = description;
  with_section.section = true;
  {
    RunFile file(file_, with_section);
    for (std::int64_t k = 0; k < 3; ++k) file.append(row(k));
    for (int k = 0; k < 5; ++k) file.append(SectionPoint{0.25 * k, {0.0, 1.0 * k}, {2.0 * k, 3.0 * k}, 0});
    file.flush();
    EXPECT_EQ(read_run_file(file_).section_t.size(), 5U);
    file.append(SectionPoint{1.25, {0, 5}, {10, 15}, 0});
  }
  const RunSamples run = read_run_file(file_);
  expect_rows(run, 3);
  ASSERT_EQ(run.section_t.size(), 6U);
  for (std::size_t k = 0; k < 6; ++k) {
    const auto x = static_cast<double>(k);
    EXPECT_EQ(run.section_t[k], 0.25 * x);
    EXPECT_EQ(run.section_q[1][k], x);
    EXPECT_EQ(run.section_p[0][k], 2 * x);
    EXPECT_EQ(run.section_p[1][k], 3 * x);
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
    RunFile file(file_, in_quad);
    for (std::int64_t k = 0; k < 3000; ++k) file.append(with_digits(k));
    Frame longer = with_digits(0);
    longer.digits.energy = "123456789";
    EXPECT_THROW(file.append(longer), FileError);
  }
  {
    RunFile file(file_, in_quad, 2000);  // goes on behind them
    for (std::int64_t k = 2000; k < 2500; ++k) file.append(with_digits(k));
  }
  const RunDigits digits = read_run_digits(file_);
  ASSERT_EQ(digits.t.size(), 2500U);
  ASSERT_EQ(digits.q.size(), 2U);
  for (std::int64_t k = 0; k < 2500; ++k) {
    const FrameDigits wanted = with_digits(k).digits;
    const auto at = static_cast<std::size_t>(k);
    ASSERT_EQ(digits.t[at], wanted.time);
    ASSERT_EQ(digits.energy[at], wanted.energy);
    for (std::size_t i = 0; i < 2; ++i) {
      ASSERT_EQ(digits.q[i][at], wanted.q[i]);
      ASSERT_EQ(digits.p[i][at], wanted.p[i]);
    }
  }
  in_quad.digits_length = 9;
  EXPECT_THROW(RunFile(file_, in_quad, 1), FileError);
  { RunFile(file_, description).append(row(0)); }
  EXPECT_TRUE(read_run_digits(file_).t.empty());
}

TEST_F(RunFileTest, ADamagedRowIsAnErrorAndNotAnotherRow) {
  {
    RunFile file(file_, description);
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
  EXPECT_THROW(RunFile(file_, description, 700), FileError);
  RunFile(file_, description, 100);  // what is not damaged is there to go on from
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
  { RunFile(file_, large).append(frame); }
  EXPECT_EQ(read_run_file(file_).q.size(), large.dimension);
}

TEST_F(RunFileTest, ReadableWhileItGrows) {
  RunFile file(file_, description);
  for (std::int64_t k = 0; k < 100; ++k) file.append(row(k));
  file.flush();
  expect_rows(read_run_file(file_), 100);
}

TEST_F(RunFileTest, GoesOnAfterTheRowsThatStay) {
  for (const std::uint64_t kept : {0u, 1u, 777u, 20000u}) {  // within a chunk, and over several batches
    {
      RunFile file(file_, description);
      for (std::int64_t k = 0; k < 20000; ++k) file.append(row(k));
    }
    RunFile file(file_, description, kept);
    EXPECT_EQ(file.rows(), kept);
    expect_rows(read_run_file(file_), static_cast<std::int64_t>(kept));
    for (auto k = static_cast<std::int64_t>(kept); k < 21000; ++k) file.append(row(k));
    EXPECT_EQ(file.rows(), 21000u);
    file.flush();
    const RunSamples run = read_run_file(file_);
    EXPECT_EQ(run.t.size(), 21000u);
    expect_rows(run, 21000);
  }
}

TEST_F(RunFileTest, CannotGoOnAfterMoreRowsThanThereAre) {
  { RunFile(file_, description).append(row(0)); }
  EXPECT_THROW(RunFile(file_, description, 2), FileError);
  RunDescription other = description;
  other.dimension = 3;
  EXPECT_THROW(RunFile(file_, other, 1), FileError);
  expect_rows(read_run_file(file_), 1);  // it is as it was
  EXPECT_FALSE(std::filesystem::exists(file_.string() + ".new"));
}

TEST_F(RunFileTest, RowsOfALargeSystemDoNotPileUp) {
  RunDescription large = description;
  large.dimension = 100000;
  RunFile file(file_, large);
  Frame frame = row(0);
  frame.q.assign(large.dimension, 1.0);
  frame.p.assign(large.dimension, 2.0);
  for (int k = 0; k < 40; ++k) file.append(frame);
  // 2^20 numbers wait at most: 5 rows of 200010 numbers.
  EXPECT_EQ(read_run_file(file_).t.size(), 40u);
}

TEST_F(RunFileTest, ConfirmedRowsAreThereToGoOnFromAfterAKill) {
  for (int round = 0; round < 10; ++round) {
    std::filesystem::remove(file_);
    int confirmed[2];
    ASSERT_EQ(pipe(confirmed), 0);
    const pid_t child = fork();
    if (child == 0) {
      close(confirmed[0]);
      RunFile file(file_, description);
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
    RunFile file(file_, description, static_cast<std::uint64_t>(last));
    for (std::int64_t k = last; k < last + 100; ++k) file.append(row(k));
    file.flush();
    expect_rows(read_run_file(file_), last + 100);
    if (HasFatalFailure()) FAIL() << "round " << round;
  }
}

TEST_F(RunFileTest, NotARunFileIsSaid) {
  EXPECT_THROW(read_run_file("no such file"), FileError);
  EXPECT_THROW(RunFile("no such folder/run.h5", description), FileError);
}

TEST_F(RunFileTest, ConfirmedRowsSurviveKill) {
  for (int round = 0; round < 30; ++round) {
    std::filesystem::remove(file_);
    int confirmed[2];
    ASSERT_EQ(pipe(confirmed), 0);
    const pid_t child = fork();
    if (child == 0) {
      close(confirmed[0]);
      RunFile file(file_, description);
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
