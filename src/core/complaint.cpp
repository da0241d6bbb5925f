#include "hamflow/core/complaint.hpp"

#include <utility>

#include "hamflow/core/text.hpp"

namespace hamflow {

namespace {
/// Escapes line ends and control characters, so that a key or a string cannot break the line or steer a terminal.
std::string plain(const std::string& raw) {
  std::string out;
  for (const char c : raw) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte != 0x7f) {
      out += c;
    } else {
      constexpr const char* digits = "0123456789abcdef";
      out += c == '\n' ? "\\n" : c == '\t' ? "\\t" : std::string("\\x") + digits[byte >> 4] + digits[byte & 15];
    }
  }
  return out;
}

std::string lines_of(const std::vector<Complaint>& all) {
  return joined(
      all, [](const Complaint& one) { return one.text(); }, "\n");
}
}  // namespace

std::string Complaint::origin() const {
  if (key.starts_with("-")) return key;
  return line > 0 || file.empty() || file.starts_with("--") ? file : "--set";
}

std::string Complaint::text() const {
  const std::string from = origin();
  const std::string place = line > 0 ? file + ":" + std::to_string(line) + ":" + std::to_string(column) : from;
  return plain((place.empty() ? "" : place + ": ") + "error: " + (key.empty() || key == from ? "" : key + ": ") +
               message);
}

Rejection::Rejection(std::vector<Complaint> all) : Error(lines_of(all)), complaints(std::move(all)) {}

Rejection::Rejection(std::string option, std::string message)
    : Rejection({{"", 0, 0, std::move(option), std::move(message)}}) {}

}  // namespace hamflow
