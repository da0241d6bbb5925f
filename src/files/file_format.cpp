#include "file_format.hpp"

#include <charconv>

#include "hamflow/core/version.hpp"

namespace hamflow {

std::string refused_format(const std::string& found) {
  std::uint64_t major = 0;
  const char* const end = found.data() + found.size();
  const auto [dot, error] = std::from_chars(found.data(), end, major);
  if (error == std::errc() && dot != end && *dot == '.' && major == file_format_word >> 16) return "";
  return "has format " + found + "; hamflow " HAMFLOW_VERSION " reads format 1" +
         (error == std::errc() && major > file_format_word >> 16 ? ", and a later version wrote this file" : "");
}

std::string refused_format(std::uint64_t word) {
  return refused_format(std::to_string(word >> 16) + "." + std::to_string(word & 0xffff));
}

}  // namespace hamflow
