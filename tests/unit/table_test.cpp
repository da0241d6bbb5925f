// Tables: what goes in comes out, in contiguous memory, whatever the order in which columns grow.
#include "hamflow/core/table.hpp"

#include <gtest/gtest.h>

#include "hamflow/core/error.hpp"

namespace hamflow {
namespace {

Table two_rows() {
  Table table;
  table.add({.name = "q", .width = 2, .scalar = false, .parts = {"x", "y"}, .unit = "m"});
  table.add({.name = "step", .type = ValueType::integer});
  table.add({.name = "status", .type = ValueType::text});
  for (int k = 0; k < 2; ++k) {
    table.columns()[0].add(k + 0.5);
    table.columns()[0].add(-k - 0.25);
    table.columns()[1].add(std::int64_t{1} << (52 + k));
    table.columns()[2].add(std::string_view(k == 0 ? "done" : "interrupted"));
  }
  return table;
}

TEST(Tables, HoldWhatWasAdded) {
  const Table table = two_rows();
  EXPECT_EQ(table.rows(), 2U);
  EXPECT_EQ(table["q"].part(1), (std::vector{-0.25, -1.25}));
  EXPECT_EQ(table["q"].row(1), (std::vector{1.5, -1.25}));
  EXPECT_EQ(&table["q"].numbers()[3], table["q"].numbers().data() + 3);
  EXPECT_EQ(table["step"].integers()[1], std::int64_t{1} << 53);
  EXPECT_EQ(table["status"].text(0), "done");
  EXPECT_EQ(table["status"].text(1), "interrupted");
  EXPECT_EQ(table["q"].info().unit, "m");
}

TEST(Tables, CopiesAreTheirOwn) {
  Table table = two_rows();
  const Table copy = table;
  table.columns()[0].numbers()[0] = 7;
  table.cut(1);
  EXPECT_EQ(copy["q"].numbers()[0], 0.5);
  EXPECT_EQ(copy.rows(), 2U);
  EXPECT_EQ(table.rows(), 1U);
  EXPECT_EQ(table["status"].texts(), (std::vector<std::string>{"done"}));
}

TEST(Tables, GrowWithoutLosingAValue) {
  Column column({.name = "x"});
  for (int k = 0; k < 100000; ++k) column.add(0.5 * k);
  ASSERT_EQ(column.rows(), 100000U);
  for (std::size_t k = 0; k < 100000; ++k) ASSERT_EQ(column.numbers()[k], 0.5 * static_cast<double>(k));
  const Column moved = std::move(column);
  EXPECT_EQ(moved.numbers()[99999], 49999.5);
}

TEST(Tables, TextsOfAFixedSizeRefuseLongerOnes) {
  Column column({.name = "digits/t", .type = ValueType::text, .text_size = 4});
  column.add(std::string_view("1.25"));
  EXPECT_THROW(column.add(std::string_view("1.125")), Error);
  EXPECT_EQ(column.texts(), (std::vector<std::string>{"1.25"}));
  EXPECT_EQ(column.bytes().size(), 4U);
}

TEST(Tables, SayWhatIsWrong) {
  Table table = two_rows();
  EXPECT_THROW(table.add({.name = "q"}), Error);
  EXPECT_THROW((void)table["q"].integers(), Error);
  EXPECT_THROW((void)table["q"].part(2), Error);
  EXPECT_THROW((void)table["status"].numbers(), Error);
  EXPECT_THROW(table.columns()[1].add(0.5), Error);
  try {
    (void)table["stats"];
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("status"), std::string::npos);
  }
}

}  // namespace
}  // namespace hamflow
