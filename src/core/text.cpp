#include "hamflow/core/text.hpp"

#include <algorithm>
#include <sstream>
#include <vector>

#include "other_names.hpp"

namespace hamflow {

namespace {
/// The least number of insertions, deletions, replacements and exchanges of neighbours that turn a into b, where no
/// part of the text is edited twice ([WagnerFischer1974] with the exchange of neighbours).
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before(b.size() + 1);  // the row before the last
  std::vector<std::size_t> last(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before.swap(last);
    last.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({row[j - 1] + 1, last[j] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      const bool exchanged = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (exchanged) row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row.back();
}

std::string lower_case(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

/// Returns the candidate for which `name` is another name (other_names.hpp); empty if there is none.
std::string candidate_by_other_name(const std::string& name, std::span<const std::string> candidates) {
  std::string said = lower_case(name);
  std::replace(said.begin(), said.end(), '_', '-');
  std::replace(said.begin(), said.end(), ' ', '-');
  std::istringstream lines{std::string(other_names)};
  for (std::string line; std::getline(lines, line);) {
    const std::size_t colon = line.find(": ");
    if (colon == std::string::npos) continue;
    const std::string here = line.substr(0, colon);
    const std::vector<std::string> others = split_list(line.substr(colon + 2));
    const bool is_meant = std::find(others.begin(), others.end(), said) != others.end();
    if (is_meant && std::find(candidates.begin(), candidates.end(), here) != candidates.end()) return here;
  }
  return "";
}
}  // namespace

std::string joined(std::span<const std::string> words, std::string_view separator) {
  return joined(
      words, [](const std::string& word) -> const std::string& { return word; }, separator);
}

std::vector<std::string> split_list(const std::string& text) {
  std::vector<std::string> parts(1);
  int depth = 0;
  for (const char c : text) {
    if (c == '(' || c == '[') ++depth;
    if (c == ')' || c == ']') --depth;
    if (c == ',' && depth == 0) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  for (std::string& part : parts) {
    const auto first = part.find_first_not_of(" \t");
    part = first == std::string::npos ? "" : part.substr(first, part.find_last_not_of(" \t") - first + 1);
  }
  return parts;
}

namespace {
/// The name without '_' and '-', so that px equals p_x.
std::string without_separators(std::string name) {
  std::erase_if(name, [](char c) { return c == '_' || c == '-'; });
  return name;
}
}  // namespace

std::string nearest(const std::string& name, std::span<const std::string> candidates) {
  const std::string wanted = lower_case(name);
  const auto joined_otherwise = std::find_if(candidates.begin(), candidates.end(), [&](const std::string& candidate) {
    return without_separators(lower_case(candidate)) == without_separators(wanted);
  });
  if (!wanted.empty() && joined_otherwise != candidates.end()) return *joined_otherwise;
  std::string best;
  std::size_t least = std::max<std::size_t>((name.size() + 1) / 3, 1) + 1;
  for (const std::string& candidate : candidates) {
    // The distance is at least the difference of the lengths. This bound skips very long names, which would take
    // seconds.
    if (std::max(name.size(), candidate.size()) - std::min(name.size(), candidate.size()) >= least) continue;
    const std::size_t distance = edit_distance(wanted, lower_case(candidate));
    const bool nothing_in_common = distance >= std::max(name.size(), candidate.size());
    if (distance < least && !nothing_in_common && !name.empty()) {
      least = distance;
      best = candidate;
    }
  }
  if (!best.empty() || name.size() < 3) return best;
  const auto begun = std::find_if(candidates.begin(), candidates.end(), [&](const std::string& candidate) {
    return lower_case(candidate).starts_with(wanted);
  });
  if (begun != candidates.end()) return *begun;
  // A word of four letters allows one error; two are allowed if it begins like exactly one candidate.
  constexpr std::size_t beginning = 3;
  const auto near = [&](const std::string& candidate) {
    const std::string word = lower_case(candidate);
    return word.starts_with(wanted.substr(0, beginning)) && edit_distance(wanted, word) == 2;
  };
  const bool single = name.size() > beginning && std::count_if(candidates.begin(), candidates.end(), near) == 1;
  return single ? *std::find_if(candidates.begin(), candidates.end(), near) : "";
}

std::string suggestion(const std::string& name, std::span<const std::string> candidates) {
  const std::string known = candidate_by_other_name(name, candidates);
  const std::string near = known.empty() ? nearest(name, candidates) : known;
  return near.empty() ? "" : "; did you mean " + near + "?";
}

}  // namespace hamflow
