#include "sweep_journal.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include "file_format.hpp"
#include "hamflow/detail/core/hash.hpp"
#include "hamflow/detail/core/option_names.hpp"

namespace hamflow {

namespace {

// The file begins with these two words. Parts follow: the header, then the records. A part consists of its length, its
// bytes, and a hash of both.
constexpr std::uint64_t magic = 0x5045'4557'534c'4648u;  // "HFLSWEEP"; it also shows the byte order
constexpr std::size_t word = sizeof(std::uint64_t);

template <class... T>
std::vector<std::byte> part_of(const T&... fields) {
  Writer content;
  content(fields...);
  Writer part;
  part(content.bytes());  // the archive of a list of bytes begins with its length
  part(fnv1a(part.bytes()));
  return part.take();
}

/// Returns the content of the part at the beginning of `left`, and removes it from `left`. Empty if the part is
/// incomplete or damaged.
std::span<const std::byte> next_part(std::span<const std::byte>& left) {
  std::uint64_t size = 0;
  if (left.size() < 2 * word) return {};
  Reader(left.first(word))(size);
  if (size > left.size() - 2 * word) return {};
  std::uint64_t sum = 0;
  Reader(left.subspan(word + size, word))(sum);
  if (sum != fnv1a(left.first(word + size))) return {};
  const auto content = left.subspan(word, size);
  left = left.subspan(size + 2 * word);
  return content;
}

}  // namespace

StoredSweep read_journal(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw FileError("cannot read " + file.string());
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  return journal_in(std::as_bytes(std::span(text)), file.string());
}

StoredSweep journal_in(std::span<const std::byte> left, const std::string& name) {
  const auto damaged = [&](const std::string& how) { return FileError(name + " " + how + advice_to_overwrite()); };
  StoredSweep past;
  std::uint64_t found[2] = {};
  if (left.size() < sizeof found) throw damaged("is damaged: it is too short");
  Reader(left.first(sizeof found))(found);
  if (found[0] != magic)
    throw damaged("was not written by hamflow, or on a machine with another byte order, or is damaged");
  if (const std::string wrong = refused_format(found[1]); !wrong.empty()) throw damaged(wrong);
  left = left.subspan(sizeof found);
  const auto head = next_part(left);
  if (head.empty()) throw damaged("is damaged: its header is incomplete");
  try {
    Reader ar(head);
    ar(past.head);
    ar.finish();
    while (!left.empty()) {
      const auto record = next_part(left);
      if (record.empty()) break;
      std::uint64_t member = 0;
      FinishedMember finished;
      Reader fields(record);
      fields(member, finished);
      fields.finish();
      past.members.insert_or_assign(member, std::move(finished));
    }
  } catch (const Error& error) {
    throw damaged(std::string("is damaged: ") + error.what());
  }
  past.dropped_bytes = left.size();
  return past;
}

std::vector<std::byte> journal_bytes(const StoredSweep& past) {
  Writer all;
  all(magic, file_format_word);
  const auto add = [&all](const std::vector<std::byte>& part) { all.raw(part.data(), part.size()); };
  add(part_of(past.head));
  for (const auto& [member, finished] : past.members) add(part_of(member, finished));
  return all.take();
}

SweepJournal::SweepJournal(const std::filesystem::path& file, const StoredSweep& past) : file_(file) {
  WholeFile whole(file, next_name(file));
  write_whole(whole, journal_bytes(past));
  descriptor_ = open(file.c_str(), O_WRONLY | O_APPEND | O_NOFOLLOW | O_CLOEXEC);
  if (descriptor_ < 0) throw FileError("cannot open " + file.string() + ": " + std::strerror(errno));
}

SweepJournal::~SweepJournal() {
  if (descriptor_ >= 0) close(descriptor_);
}

void SweepJournal::append(std::uint64_t member, const FinishedMember& finished) {
  const std::vector<std::byte> part = part_of(member, finished);
  std::span<const std::byte> left = part;
  while (!left.empty()) {
    const ssize_t count = write(descriptor_, left.data(), left.size());
    if (count < 0 && errno != EINTR) {
      throw FileError("cannot write " + file_.string() + ": " + std::strerror(errno) +
                      "; to run the remaining members, repeat the command with " + option_name("resume"));
    }
    if (count > 0) left = left.subspan(static_cast<std::size_t>(count));
  }
}

}  // namespace hamflow
