#include "checkpoint.hpp"

#include <fstream>
#include <iterator>

#include "file_format.hpp"
#include "hamflow/detail/core/hash.hpp"
#include "hamflow/detail/core/option_names.hpp"
#include "whole_file.hpp"

namespace hamflow {

namespace {

// The file consists of these two words, the payload, and a checksum of both.
constexpr std::uint64_t magic = 0x4b43'574f'4c46'4d48u;  // "HMFLOWCK"; it also shows the byte order
constexpr std::size_t sum_bytes = sizeof(std::uint64_t);

}  // namespace

void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint) {
  Writer ar;
  ar(magic, file_format_word, checkpoint);
  ar(fnv1a(ar.bytes()));
  WholeFile whole(file, next_name(file));
  write_whole(whole, ar.bytes());
}

Checkpoint read_checkpoint(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw FileError("cannot read the checkpoint " + file.string());
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const std::span<const std::byte> bytes(reinterpret_cast<const std::byte*>(text.data()), text.size());
  const auto damaged = [&](const std::string& how) {
    return FileError("the checkpoint " + file.string() + " " + how + advice_to_overwrite());
  };
  if (bytes.size() < 2 * sizeof(std::uint64_t) + sum_bytes) throw damaged("is damaged: it is too short");
  std::uint64_t found_sum = 0;
  Reader(bytes.last(sum_bytes))(found_sum);
  const auto content = bytes.first(bytes.size() - sum_bytes);
  Checkpoint checkpoint;
  try {
    Reader ar(content);
    std::uint64_t found_magic = 0;
    std::uint64_t found_format = 0;
    ar(found_magic, found_format);
    if (found_magic != magic) {
      throw damaged("was not written by hamflow, or on a machine with another byte order, or is damaged");
    }
    if (found_sum != fnv1a(content)) throw damaged("is damaged: its checksum is wrong");
    if (const std::string wrong = refused_format(found_format); !wrong.empty()) throw damaged(wrong);
    ar(checkpoint);
    ar.finish();
  } catch (const Error& error) {
    throw damaged(std::string("is damaged: ") + error.what());
  }
  if (checkpoint.keys.size() != checkpoint.values.size()) throw damaged("is damaged: its settings do not match");
  return checkpoint;
}

}  // namespace hamflow
