// Numbers whose count is chosen when they are made.
#include "hamflow/detail/core/short_array.hpp"

namespace hamflow {
namespace {

/// In place, and in memory of their own.
constexpr std::size_t sizes_of_arrays[] = {0, 1, 16, 17, 1000};

ShortArray<double> counted(std::size_t size) {
  ShortArray<double> all(size, 0);
  for (std::size_t i = 0; i < size; ++i) all[i] = static_cast<double>(i) + 0.5;
  return all;
}

TEST(ShortArray, AssignedToItselfStaysWhatAndWhereItIs) {
  for (const std::size_t size : sizes_of_arrays) {
    ShortArray<double> array = counted(size);
    ShortArray<double>& itself = array;
    const double* const place = array.data();
    array = itself;
    EXPECT_EQ(array, counted(size)) << size;
    array = std::move(itself);
    EXPECT_EQ(array, counted(size)) << size;
    EXPECT_EQ(array.data(), place) << size;
  }
}

TEST(ShortArray, TakesTheNumbersOfAnother) {
  for (const std::size_t from : sizes_of_arrays) {
    for (const std::size_t to : sizes_of_arrays) {
      const ShortArray<double> given = counted(from);
      ShortArray<double> copy(to, -1);
      copy = given;
      EXPECT_EQ(copy, given) << from << " to " << to;
      ShortArray<double> moved(to, -1);
      moved = counted(from);
      EXPECT_EQ(moved, given) << from << " to " << to;
    }
  }
}

}  // namespace
}  // namespace hamflow
