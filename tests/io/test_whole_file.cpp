// A file is whole, or what was there before.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "csv_file.hpp"
#include "hamflow/core/error.hpp"
#include "reverse_file.hpp"
#include "run_file.hpp"
#include "whole_file.hpp"

namespace {

namespace fs = std::filesystem;
using namespace hamflow;

class WholeFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
    folder_ = fs::temp_directory_path() / ("whole_" + std::to_string(getpid()) + name);
    fs::create_directory(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  void put(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }
  std::string text(const std::string& name) {
    std::ifstream in(folder_ / name);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  }
  std::size_t files() {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  fs::path folder_;
};

TEST_F(WholeFiles, TheOldOneStaysUntilTheNewOneIsPutInPlace) {
  put("x", "old");
  {
    WholeFile left(folder_ / "x");
    std::ofstream(left.part()) << "half";
    EXPECT_EQ(text("x"), "old");
  }
  EXPECT_EQ(text("x"), "old");
  EXPECT_EQ(files(), 1u);
  WholeFile whole(folder_ / "x");
  write_whole(whole, "new");
  EXPECT_EQ(text("x"), "new");
  EXPECT_EQ(files(), 1u);
}

TEST_F(WholeFiles, LinksAreFollowedAndPipesAreWrittenDirectly) {
  put("x", "old");
  fs::create_symlink(folder_ / "x", folder_ / "link");
  WholeFile whole(folder_ / "link");
  write_whole(whole, "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(text("x"), "new");
  WholeFile nothing("/dev/null");
  write_whole(nothing, "new");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  WholeFile full("/dev/full");
  EXPECT_THROW(write_whole(full, "new"), FileError);
  WholeFile nowhere(folder_ / "none" / "x");
  EXPECT_THROW(write_whole(nowhere, "new"), FileError);
}

TEST_F(WholeFiles, LinksUnderTheOtherNameAreNotFollowed) {
  put("mine", "mine");
  const auto plant = [this](const fs::path& link) {
    fs::create_symlink(folder_ / "mine", link);
    return link;
  };
  plant(folder_ / "x.new");
  WholeFile whole(folder_ / "x", next_name(folder_ / "x"));
  write_whole(whole, "new");
  plant(WholeFile(folder_ / "y").part());
  WholeFile named(folder_ / "y");
  write_whole(named, "new");
  CsvFile csv(plant(folder_ / "t.csv"), 1, std::vector<InvariantColumn>{});
  const RunDescription description{.dimension = 1};
  RunRows rows(description);
  { RunFile run(folder_ / "run.h5", description, rows); }
  plant(folder_ / "run.h5.new");
  { RunFile run(folder_ / "run.h5", description, rows); }
  write_reverse_file((plant(folder_ / "reverse.h5.new"), folder_ / "reverse.h5"), "text", {}, {}, nullptr);
  EXPECT_EQ(text("mine"), "mine");
  for (const char* name : {"x", "y", "t.csv", "run.h5", "reverse.h5"}) {
    EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(folder_ / name))) << name;
  }
  fs::create_directory(folder_ / "z.new");
  WholeFile taken(folder_ / "z", next_name(folder_ / "z"));
  EXPECT_THROW(write_whole(taken, "new"), FileError);
}

TEST_F(WholeFiles, OtherLinesAreFound) {
  std::uint64_t bytes = 0;
  std::uint64_t hash = 0;
  {
    CsvFile csv(folder_ / "t.csv", 1, std::vector<InvariantColumn>{});
    csv.append({});
    csv.flush();
    bytes = csv.bytes();
    hash = csv.hash();
    csv.append({});  // what stands behind is dropped when the run goes on
  }
  const std::string good = text("t.csv");
  EXPECT_EQ(refused_csv(folder_ / "t.csv", bytes, hash), "");
  for (std::size_t i = 0; i < bytes; ++i) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ 1);
    put("t.csv", bad);
    EXPECT_NE(refused_csv(folder_ / "t.csv", bytes, hash), "") << i;
  }
  put("t.csv", good.substr(0, bytes - 1));
  EXPECT_NE(refused_csv(folder_ / "t.csv", bytes, hash).find("but the checkpoint needs"), std::string::npos);
  EXPECT_NE(refused_csv(folder_ / "none.csv", bytes, hash).find("does not exist"), std::string::npos);
}

}  // namespace
