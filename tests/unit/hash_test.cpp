// The hash of stored bits.
#include "hamflow/detail/core/hash.hpp"

#include <gtest/gtest.h>

#include <string_view>

namespace hamflow {
namespace {

std::uint64_t hash_of(std::string_view text) { return fnv1a(std::as_bytes(std::span(text))); }

TEST(Hash, IsFnv1a) {  // published test vectors   [RFC9923, appendix C]
  EXPECT_EQ(hash_of(""), 0xcbf29ce484222325u);
  EXPECT_EQ(hash_of("a"), 0xaf63dc4c8601ec8cu);
  EXPECT_EQ(hash_of("foobar"), 0x85944171f73967e8u);
}

}  // namespace
}  // namespace hamflow
