#include "csv_file.hpp"

#include <fmt/format.h>

#include "hamflow/core/error.hpp"

namespace hamflow {

CsvFile::CsvFile(const std::filesystem::path& file, std::size_t dimension,
                 const std::vector<InvariantColumn>& invariants)
    : path_(file), out_(file) {
  if (!out_) throw FileError("cannot write " + file.string());
  out_ << "step,t";
  for (const char* letter : {"q", "p"}) {
    for (std::size_t i = 1; i <= dimension; ++i) out_ << ',' << letter << i;
  }
  out_ << ",energy";
  for (const InvariantColumn& each : invariants) {
    for (std::size_t k = 1; k <= each.size; ++k)
      out_ << ',' << each.name << (each.size == 1 ? "" : "_" + std::to_string(k));
  }
  out_ << '\n';
}

CsvFile::CsvFile(const std::filesystem::path& file, std::uint64_t bytes) : path_(file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) throw FileError("cannot go on with " + file.string() + ": " + error.message());
  if (size < bytes) {
    throw FileError("cannot go on with " + file.string() + ": it has " + std::to_string(size) + " bytes, not the " +
                    std::to_string(bytes) + " that the checkpoint counts");
  }
  std::filesystem::resize_file(file, bytes, error);
  out_.open(file, std::ios::in | std::ios::out | std::ios::ate);
  if (error || !out_) throw FileError("cannot write " + file.string());
}

std::uint64_t CsvFile::bytes() { return static_cast<std::uint64_t>(out_.tellp()); }

void CsvFile::append(const Frame& frame) {
  fmt::memory_buffer line;
  const auto to = std::back_inserter(line);
  if (const FrameDigits& digits = frame.digits; !digits.q.empty()) {
    fmt::format_to(to, "{},{}", frame.step, digits.time);
    for (const std::string& x : digits.q) fmt::format_to(to, ",{}", x);
    for (const std::string& x : digits.p) fmt::format_to(to, ",{}", x);
    fmt::format_to(to, ",{}", digits.energy);
  } else {
    fmt::format_to(to, "{},{:.17g}", frame.step, frame.time);
    for (const double x : frame.q) fmt::format_to(to, ",{:.17g}", x);
    for (const double x : frame.p) fmt::format_to(to, ",{:.17g}", x);
    fmt::format_to(to, ",{:.17g}", frame.energy);
  }
  for (const double x : frame.invariants) fmt::format_to(to, ",{:.17g}", x);
  line.push_back('\n');
  out_.write(line.data(), static_cast<std::streamsize>(line.size()));
}

void CsvFile::flush() {
  out_.flush();
  if (!out_) throw FileError("cannot write " + path_.string() + " (is the disk full?)");
}

}  // namespace hamflow
