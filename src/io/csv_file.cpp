#include "csv_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <span>

#include "hamflow/core/error.hpp"
#include "whole_file.hpp"

namespace hamflow {

CsvFile::CsvFile(const std::filesystem::path& file, std::size_t dimension, const std::vector<InvariantColumn>& more)
    : path_(file), out_(fdopen(open_new_file(file), "w"), std::fclose) {
  if (!out_) fail();
  std::string header = "step,t";
  for (const char* letter : {"q", "p"}) {
    for (std::size_t i = 1; i <= dimension; ++i) header += fmt::format(",{}{}", letter, i);
  }
  header += ",energy";
  for (const InvariantColumn& each : more) {
    for (std::size_t k = 1; k <= each.size; ++k) {
      header += ',' + each.name + (each.size == 1 ? "" : "_" + std::to_string(k));
    }
  }
  put(header + '\n');
}

CsvFile::CsvFile(const std::filesystem::path& file, std::uint64_t bytes, std::uint64_t hash)
    : path_(file), out_(nullptr, std::fclose), bytes_(bytes), hash_(hash) {
  if (const std::string wrong = refused_csv(file, bytes, hash); !wrong.empty()) {
    throw FileError("cannot resume with " + file.string() + ": " + wrong);
  }
  std::error_code error;
  std::filesystem::resize_file(file, bytes, error);
  out_.reset(std::fopen(file.c_str(), "ae"));
  if (error || !out_) fail();
}

void CsvFile::put(std::string_view text) {
  (void)std::fwrite(text.data(), 1, text.size(), out_.get());  // flush() reports errors
  bytes_ += text.size();
  hash_ = fnv1a(std::as_bytes(std::span(text)), hash_);
}

void CsvFile::append(const Frame& frame, std::span<const double> observables) {
  fmt::memory_buffer line;
  const auto to = std::back_inserter(line);
  const auto add = [&](double x) { fmt::format_to(to, ",{:.17g}", without_sign_of_nan(x)); };
  if (const FrameDigits& digits = frame.digits; !digits.q.empty()) {
    fmt::format_to(to, "{},{}", frame.step, digits.time);
    for (const std::string& x : digits.q) fmt::format_to(to, ",{}", x);
    for (const std::string& x : digits.p) fmt::format_to(to, ",{}", x);
    fmt::format_to(to, ",{}", digits.energy);
  } else {
    fmt::format_to(to, "{},{:.17g}", frame.step, frame.time);
    for (const double x : frame.q) add(x);
    for (const double x : frame.p) add(x);
    add(frame.energy);
  }
  for (const double x : frame.invariants) add(x);
  for (const double x : observables) add(x);
  line.push_back('\n');
  put({line.data(), line.size()});
}

void CsvFile::flush() {
  if (std::fflush(out_.get()) != 0 || std::ferror(out_.get()) != 0) fail();
}

void CsvFile::fail() const { throw FileError("cannot write " + path_.string() + " (is the disk full?)"); }

std::string refused_csv(const std::filesystem::path& file, std::uint64_t bytes, std::uint64_t hash) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return "it does not exist or cannot be read";
  std::uint64_t found = fnv1a_of_nothing;
  std::uint64_t left = bytes;
  std::vector<char> part(std::size_t{1} << 16);
  while (left > 0) {
    in.read(part.data(), static_cast<std::streamsize>(std::min<std::uint64_t>(left, part.size())));
    const auto count = static_cast<std::size_t>(in.gcount());
    if (count == 0) {
      return "it has " + std::to_string(bytes - left) + " bytes, but the checkpoint needs " + std::to_string(bytes);
    }
    found = fnv1a(std::as_bytes(std::span(part.data(), count)), found);
    left -= count;
  }
  return found == hash ? "" : "its samples are not those of the run, or were changed";
}

}  // namespace hamflow
