#include "whole_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "hamflow/core/error.hpp"

namespace hamflow {

namespace {

namespace fs = std::filesystem;

class Descriptor {
 public:
  Descriptor(const fs::path& path, int flags) : path_(path), id_(open(path.c_str(), flags | O_CLOEXEC, 0666)) {
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
  fs::path path_;
  int id_;
};

fs::path folder_of_file(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : fs::path("."); }

/// Where a link leads, so that the link itself stays.
fs::path followed(const fs::path& file) {
  std::error_code none;
  const fs::path there = fs::is_symlink(file, none) ? fs::weakly_canonical(file, none) : file;
  return none ? file : there;
}

bool is_device(const fs::path& file) {
  std::error_code none;
  return fs::exists(file, none) && !fs::is_regular_file(file, none);
}

fs::path hidden_name(const fs::path& file) {
  return folder_of_file(file) / ("." + file.filename().string() + "." + std::to_string(getpid()) + ".part");
}

}  // namespace

fs::path next_name(const fs::path& file) { return file.string() + ".new"; }

void force_to_disk(const fs::path& file_or_folder) { Descriptor(file_or_folder, O_RDONLY).force(); }

WholeFile::WholeFile(const fs::path& file) : file_(is_device(file) ? file : followed(file)) {
  part_ = is_device(file) ? file_ : hidden_name(file_);
}
WholeFile::WholeFile(fs::path file, fs::path part) : file_(std::move(file)), part_(std::move(part)) {}

WholeFile::~WholeFile() {
  std::error_code none;
  if (waits_ && part_ != file_) fs::remove(part_, none);
}

void WholeFile::put_in_place() {
  waits_ = part_ != file_;
  if (!waits_) return;
  force_to_disk(part_);
  std::error_code error;
  fs::rename(part_, file_, error);
  if (error) throw FileError("cannot replace " + file_.string() + ": " + error.message());
  waits_ = false;
  force_to_disk(folder_of_file(file_));
}

void write_whole(WholeFile& file, std::span<const std::byte> bytes) {
  Descriptor(file.part(), O_WRONLY | O_CREAT | O_TRUNC).write_all(bytes);
  file.put_in_place();
}

void write_whole(WholeFile& file, const std::string& text) { write_whole(file, std::as_bytes(std::span(text))); }

}  // namespace hamflow
