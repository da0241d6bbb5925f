#include "checkpoint.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include "hamflow/core/hash.hpp"

namespace hamflow {

namespace {

// The file: these words, the payload, the checksum of all that.
constexpr std::uint64_t magic = 0x4b43'574f'4c46'4d48u;  // "HMFLOWCK", which also tells the order of bytes
constexpr std::uint64_t format = 3;
constexpr std::size_t sum_bytes = sizeof(std::uint64_t);

class Descriptor {
 public:
  Descriptor(const std::filesystem::path& path, int flags) : path_(path), id_(open(path.c_str(), flags, 0666)) {
    if (id_ < 0) fail("open");
  }
  ~Descriptor() { close(id_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  void write_all(std::span<const std::byte> bytes) const {
    while (!bytes.empty()) {
      const ssize_t count = write(id_, bytes.data(), bytes.size());
      if (count < 0 && errno != EINTR) fail("write");
      if (count > 0) bytes = bytes.subspan(static_cast<std::size_t>(count));
    }
  }
  void force() const {
    if (fsync(id_) != 0 && errno != EINVAL && errno != EROFS) fail("force to the disk");  // pipes and such have no disk
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw FileError("cannot " + what + " " + path_.string() + ": " + std::strerror(errno));
  }
  std::filesystem::path path_;
  int id_;
};

}  // namespace

void force_to_disk(const std::filesystem::path& file_or_folder) { Descriptor(file_or_folder, O_RDONLY).force(); }

void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint) {
  Writer ar;
  ar(magic, format, checkpoint);
  ar(fnv1a(ar.bytes()));
  std::filesystem::path next = file;
  next += ".new";
  try {
    {
      const Descriptor out(next, O_WRONLY | O_CREAT | O_TRUNC);
      out.write_all(ar.bytes());
      out.force();
    }
    std::filesystem::rename(next, file);
    force_to_disk(file.has_parent_path() ? file.parent_path() : ".");
  } catch (const std::filesystem::filesystem_error& error) {
    throw FileError("cannot replace " + file.string() + ": " + error.code().message());
  }
}

Checkpoint read_checkpoint(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw FileError("cannot read the checkpoint " + file.string());
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const std::span<const std::byte> bytes(reinterpret_cast<const std::byte*>(text.data()), text.size());
  const auto damaged = [&](const std::string& how) {
    return FileError("the checkpoint " + file.string() + " " + how +
                     "; remove it, and --resume starts the run from the beginning");
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
    if (found_magic != magic) throw damaged("is none of hamflow on a machine like this, or damaged");
    if (found_sum != fnv1a(content)) throw damaged("is damaged: its checksum is wrong");
    if (found_format != format)
      throw damaged("has format " + std::to_string(found_format) + ", this hamflow knows " + std::to_string(format));
    ar(checkpoint);
    ar.finish();
  } catch (const Error& error) {
    throw damaged(std::string("is damaged: ") + error.what());
  }
  if (checkpoint.keys.size() != checkpoint.values.size()) throw damaged("is damaged: its settings do not match");
  return checkpoint;
}

}  // namespace hamflow
