#include "whole_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "hamflow/core/error.hpp"

namespace hamflow {

namespace {

namespace fs = std::filesystem;

FileError cannot(const std::string& what, const fs::path& path, int error) {
  return FileError("cannot " + what + " " + path.string() + ": " + std::strerror(error));
}

fs::path folder_of_file(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : fs::path("."); }

/// Returns the target of a link, so that the link itself is kept.
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

/// Returns -1 on failure; errno gives the reason.
int new_descriptor(const fs::path& file) {
  if (unlink(file.c_str()) != 0 && errno != ENOENT) return -1;
  return open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
}

}  // namespace

fs::path next_name(const fs::path& file) { return file.string() + ".new"; }

int open_new_file(const fs::path& file) {
  const int descriptor = new_descriptor(file);
  if (descriptor < 0) throw cannot("write", file, errno);
  return descriptor;
}

void force_to_disk(const fs::path& file_or_folder) {
  const int descriptor = open(file_or_folder.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw cannot("open", file_or_folder, errno);
  // fsync fails for pipes and read-only file systems, where nothing has to be forced
  const bool forced = fsync(descriptor) == 0 || errno == EINVAL || errno == EROFS;
  const int error = errno;
  close(descriptor);
  if (!forced) throw cannot("force to the disk", file_or_folder, error);
}

WholeFile::WholeFile(const fs::path& file) : file_(is_device(file) ? file : followed(file)) {
  part_ = is_device(file) ? file_ : hidden_name(file_);
}
WholeFile::WholeFile(fs::path file, fs::path part) : file_(std::move(file)), part_(std::move(part)) {}

WholeFile::~WholeFile() {
  close_descriptor();
  std::error_code none;
  if (is_pending_ && part_ != file_) fs::remove(part_, none);
}

void WholeFile::fail(int error) const { throw cannot("write", file_, error); }

void WholeFile::close_descriptor() {
  if (descriptor_ >= 0) close(descriptor_);
  descriptor_ = -1;
}

void WholeFile::write(std::span<const std::byte> bytes) {
  if (descriptor_ < 0) descriptor_ = part_ == file_ ? open(part_.c_str(), O_WRONLY | O_CLOEXEC) : new_descriptor(part_);
  if (descriptor_ < 0) fail(errno);
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
    if (count < 0 && errno != EINTR) fail(errno);
    if (count > 0) bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

void WholeFile::put_in_place() {
  close_descriptor();
  is_pending_ = part_ != file_;
  if (!is_pending_) return;
  force_to_disk(part_);
  std::error_code error;
  fs::rename(part_, file_, error);
  if (error) throw FileError("cannot replace " + file_.string() + ": " + error.message());
  is_pending_ = false;
  force_to_disk(folder_of_file(file_));
}

void write_whole(WholeFile& file, std::span<const std::byte> bytes) {
  file.write(bytes);
  file.put_in_place();
}

void write_whole(WholeFile& file, std::string_view text) { write_whole(file, std::as_bytes(std::span(text))); }

}  // namespace hamflow
