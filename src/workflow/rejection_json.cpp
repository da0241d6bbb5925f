#include "hamflow/workflow/rejection_json.hpp"

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "summary.hpp"

namespace hamflow {

namespace {
using Json = nlohmann::ordered_json;

std::string rejected(const Json& errors) { return json_text({{"status", "rejected"}, {"errors", errors}}); }

/// What an option gave stands in no file.
Json entry(const Complaint& c) {
  const std::string option = c.key.starts_with("--") ? c.key : "--set";
  const std::string& file = c.line > 0 || c.file.empty() || c.file.starts_with("--") ? c.file : option;
  return {{"file", file}, {"line", c.line}, {"column", c.column}, {"key", c.key}, {"message", c.message}};
}

/// "--p: found ..." has the key --p, "found the option --bla; ..." the key --bla; other sentences have none.
Complaint of_sentence(const std::string& text) {
  const std::string option = "found --";
  if (text.starts_with(option)) {
    const std::size_t begin = option.size() - 2;
    return {"", 0, 0, text.substr(begin, text.find_first_of(" ;,", begin) - begin), text};
  }
  const std::size_t colon = text.find(": ");
  const std::string word = colon == std::string::npos ? "" : text.substr(0, colon);
  if (word.empty() || word.find_first_of(" \"'") != std::string::npos) return {"", 0, 0, "", text};
  const std::string message = text.substr(colon + 2);
  const std::string unknown = "found the option ";
  if (word.starts_with("-") || !message.starts_with(unknown)) return {"", 0, 0, word, message};
  return {"", 0, 0, message.substr(unknown.size(), message.find(';') - unknown.size()), message};
}

/// FILE:LINE:COL: error: KEY: message, --vary: error: KEY: message, --out: message, or another sentence.
Complaint parts_of(const std::string& line) {
  const std::string plain = "error: ";
  if (line.starts_with(plain)) return of_sentence(line.substr(plain.size()));
  const std::string mark = ": error: ";
  const std::size_t at = line.find(mark);
  if (at == std::string::npos) return of_sentence(line);
  const std::string head = line.substr(0, at);
  Complaint all{"", 0, 0, "", line.substr(at + mark.size())};
  const std::size_t colon = all.message.find(": ");
  const std::string key = all.message.substr(0, colon);
  // A quoted key may have blanks.
  const bool told = colon != std::string::npos && all.message.compare(colon + 2, 6, "found ") == 0;
  const bool has_key = colon != std::string::npos && (told || key.find(' ') == std::string::npos);
  if (has_key) {
    all.key = key;
    all.message = all.message.substr(colon + 2);
  }
  if (head.starts_with("--")) {
    all.file = head;
    if (!has_key) all.key = head;
    return all;
  }
  const std::size_t second = head.rfind(':');
  const std::size_t first = second == std::string::npos || second == 0 ? second : head.rfind(':', second - 1);
  if (first == std::string::npos || first == second) return all;
  all.file = head.substr(0, first);
  all.line = std::atoi(head.c_str() + first + 1);
  all.column = std::atoi(head.c_str() + second + 1);
  return all;
}
}  // namespace

std::string rejection_json(const std::vector<Complaint>& complaints) {
  Json errors = Json::array();
  for (const Complaint& c : complaints) errors.push_back(entry(c));
  return rejected(errors);
}

std::string rejection_json(const std::vector<std::string>& lines) {
  Json errors = Json::array();
  for (const std::string& line : lines) errors.push_back(entry(parts_of(line)));
  return rejected(errors);
}

std::string failure_json(const std::string& kind, const std::string& message) {
  return json_text({{"status", "failed"}, {"error", {{"kind", kind}, {"message", message}}}});
}

}  // namespace hamflow
