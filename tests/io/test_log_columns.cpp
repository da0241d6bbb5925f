// Columns of logs that other programs write.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "hamflow/core/complaint.hpp"
#include "log_columns.hpp"

namespace {

namespace fs = std::filesystem;
using namespace hamflow;
using Numbers = std::vector<double>;

class LogColumnsOf : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
    file_ = fs::temp_directory_path() / ("log_" + std::to_string(getpid()) + name);
  }
  void TearDown() override { fs::remove(file_); }
  LogColumns read(const std::string& text, const std::string& time = "t", const std::string& energy = "E") {
    std::ofstream(file_, std::ios::binary) << text;
    return read_log_columns(file_, time, energy);
  }
  Complaint refused(const std::string& text, const std::string& time = "t", const std::string& energy = "E") {
    try {
      read(text, time, energy);
    } catch (const Rejection& rejection) {
      return rejection.complaints.at(0);
    }
    return {};
  }
  fs::path file_;
};

TEST_F(LogColumnsOf, NamesAreThoseOfTheFirstRowOrOfTheLastComment) {
  for (const std::string text : {"t,E\n1,2\n3,4\n", "t E\n1 2\n3 4", "# x\n# t E\n1\t2\n3\t4\n", "#t;E\n1;2\n3;4\n"}) {
    const LogColumns found = read(text);
    EXPECT_EQ(found.time, (Numbers{1, 3})) << text;
    EXPECT_EQ(found.energy, (Numbers{2, 4})) << text;
    EXPECT_EQ(read(text, "2", "1").time, found.energy) << text;
  }
  EXPECT_EQ(read("t E\n\n1 2\n# 9 9\n3 4\n").lines, (std::vector<std::size_t>{3, 5}));
}

TEST_F(LogColumnsOf, NumbersAreDecimalsAndThoseOfFortran) {
  EXPECT_EQ(read("t E\n+1 -2.5D-1\n2e0 .5\n").energy, (Numbers{-0.25, 0.5}));
  for (const std::string wrong : {"x", "0x1", "nan", "inf", "1e999", "1.2.3"}) {
    EXPECT_EQ(refused("t E\n1 2\n3 " + wrong + "\n").line, 3) << wrong;
    EXPECT_EQ(refused("t E\n1 2\n3 " + wrong + "\n").column, 3) << wrong;
  }
}

TEST_F(LogColumnsOf, OfSeveralTablesOfLammpsTheLastOneIsRead) {
  const std::string first = "Step PE TotEng\n0 1 5\n10 1 6\nLoop time of 1\n";
  const std::string second = "   Step   PE   TotEng\n10 1 7\nWARNING: x\n20 1 8\nLoop time of 1\n";
  const LogColumns both = read("LAMMPS (1 Jan)\n" + first + "run 2\n" + second, "Step", "TotEng");
  EXPECT_EQ(both.tables, 2u);
  EXPECT_EQ(both.time, (Numbers{10, 20}));
  EXPECT_EQ(both.energy, (Numbers{7, 8}));
  EXPECT_EQ(read(first, "Step", "TotEng").tables, 1u) << "known by its Loop time";
  EXPECT_EQ(read("LAMMPS (1 Jan)\n" + first + "Step PE TotEng\n20 1 9\n", "Step", "TotEng").energy, (Numbers{5, 6}));
  EXPECT_EQ(refused("LAMMPS (1 Jan)\n" + first, "Step", "Toteng").key, "--energy");
}

TEST_F(LogColumnsOf, WhatIsNoTableIsRefused) {
  EXPECT_EQ(refused("t E\n1 2\n1 2 3\n").column, 5);
  EXPECT_NE(refused("").message.find("the file is empty"), std::string::npos);
  EXPECT_NE(refused("t E\n1 2\n", "u").message.find("allowed t, E"), std::string::npos);
  EXPECT_NE(refused("1 2\n", "0", "2").message.find("from 1 to 2"), std::string::npos);
  EXPECT_THROW(read_log_columns(file_ / "nothing", "t", "E"), FileError);
}

}  // namespace
