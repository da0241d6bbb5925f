// **Ledger of bits**: final states, energy errors and evaluation counts of ten thousand short runs, as hashes.
//
//     bits_ledger check bits.txt [PART...]   compare with the stored hashes; exit status 1 where one differs
//     bits_ledger write bits.txt             store the hashes anew
//     bits_ledger show PART...               print the request and the numbers of cases whose names contain PART
//
// A change that is meant to keep every bit passes `check`. After a deliberate change, `write` the file, and say in the
// commit why the bits of these cases changed. To see how two builds differ, compare what `show` prints in each.
//
// The file has one hash for the cases that differ only in their last word, mostly the arithmetic: a row. Rows of one
// problem stand under its name.
//
// Some cases have variants that must not change a bit: steps that are not recorded, a run that is saved and restored,
// members in SIMD lanes, threads. Their numbers are compared with those of the case itself.
//
// exp, sin, ... of the C library may have other last bits in another version of it or on another processor. A row
// that calls them is marked `libm`. Where the functions give other bits than those that the file was written with,
// such rows are compared with their variants alone.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <map>
#include <span>
#include <sstream>

#include "bits_cases.hpp"
#include "c_library.hpp"
#include "hamflow/core/error.hpp"
#include "hamflow/detail/core/hash.hpp"

namespace hamflow::test {
namespace {

constexpr const char* c_library_name = "C-library";

/// What the file says of a row.
struct Entry {
  std::string hash;
  bool calls_c_library = false;
};
struct Row {
  std::string name;
  std::vector<Case> cases{};
};

/// Everything before the last '/' of a name.
std::string parent(const std::string& name) { return name.substr(0, std::min(name.rfind('/'), name.size())); }
/// The first two words of a name, under which rows stand in the file.
std::string section_of(const std::string& row) {
  const std::size_t first = row.find('/');
  return row.substr(0, first == std::string::npos ? first : row.find('/', first + 1));
}

std::vector<Row> all_rows() {
  std::vector<Row> rows;
  std::map<std::string, std::size_t> places;
  for (Case& one : all_cases()) {
    const auto [at, is_new] = places.try_emplace(parent(one.name), rows.size());
    if (is_new) rows.push_back({at->first});
    rows[at->second].cases.push_back(std::move(one));
  }
  std::stable_sort(rows.begin(), rows.end(),
                   [](const Row& a, const Row& b) { return section_of(a.name) < section_of(b.name); });
  return rows;
}

std::string hash_text(std::uint64_t hash) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}
Entry entry_of(const std::string& numbers) {
  return {hash_text(fnv1a(std::as_bytes(std::span(numbers)))), called_c_library()};
}

/// The numbers of all cases of a row. @param changed receives which variants have other ones
std::string numbers_of(const Row& row, std::vector<std::string>& changed, std::size_t& variants) {
  std::string all;
  for (const Case& one : row.cases) {
    const std::string numbers = one.numbers();
    all += one.name + "\n" + numbers;
    for (const Variant& variant : one.variants) {
      if (variant.numbers() != numbers) changed.push_back(one.name + ": other numbers when " + variant.name);
    }
    variants += one.variants.size();
  }
  return all;
}

std::map<std::string, Entry> read_file(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw Error(file + ": cannot be read");
  std::map<std::string, Entry> entries;
  std::string section;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string name, mark;
    Entry entry;
    if (!line.starts_with(' ')) {
      section = line;
    } else if (words >> entry.hash >> name >> mark; !entry.hash.empty()) {
      entry.calls_c_library = mark == "libm" || name == "libm";
      const bool is_section = name.empty() || name == "libm";
      entries[is_section ? section : section + "/" + name] = entry;
    }
  }
  return entries;
}

bool is_chosen(const std::string& name, std::span<const std::string> parts) {
  return parts.empty() || std::any_of(parts.begin(), parts.end(),
                                      [&](const std::string& part) { return name.find(part) != std::string::npos; });
}
bool is_chosen(const Row& row, std::span<const std::string> parts) {
  return std::any_of(row.cases.begin(), row.cases.end(), [&](const Case& one) { return is_chosen(one.name, parts); });
}

int check(const std::string& file, std::span<const std::string> parts) {
  const std::map<std::string, Entry> stored = read_file(file);
  const auto library = stored.find(c_library_name);
  const bool is_same_library = library != stored.end() && library->second.hash == hash_text(hash_of_c_library());
  std::vector<std::string> differing;
  std::size_t compared = 0, variants = 0, left_out = 0, known = 1;
  for (const Row& row : all_rows()) {
    const auto found = stored.find(row.name);
    known += found != stored.end() ? 1 : 0;
    if (!is_chosen(row, parts)) continue;
    (void)called_c_library();
    const Entry entry = entry_of(numbers_of(row, differing, variants));
    if (found == stored.end()) {
      differing.push_back(row.name + ": not in the file");
    } else if (!is_same_library && (entry.calls_c_library || found->second.calls_c_library)) {
      left_out += row.cases.size();
    } else {
      compared += row.cases.size();
      if (found->second.hash != entry.hash) differing.push_back(row.name);
    }
  }
  if (stored.size() != known) {
    differing.push_back(file + " has " + std::to_string(stored.size()) + " rows, " + std::to_string(known) +
                        " of which there are");
  }
  for (std::size_t i = 0; i < std::min<std::size_t>(differing.size(), 20); ++i) std::cout << differing[i] << "\n";
  std::cout << compared << " cases and " << variants << " variants of them compared, " << differing.size()
            << " differ\n";
  if (left_out > 0)
    std::cout << left_out << " cases were not compared: the C library gives other bits than that of the file\n";
  if (!differing.empty()) std::cout << "to see numbers: bits_ledger show NAME, in both builds\n";
  return differing.empty() ? 0 : 1;
}

int write(const std::string& file) {
  std::string text = std::string(c_library_name) + "\n  " + hash_text(hash_of_c_library()) + "\n";
  std::string section;
  std::vector<std::string> changed;
  std::size_t variants = 0;
  for (const Row& row : all_rows()) {
    (void)called_c_library();
    const Entry entry = entry_of(numbers_of(row, changed, variants));
    const std::string here = section_of(row.name);
    if (here != section) text += here + "\n";
    section = here;
    text += "  " + entry.hash + (row.name == here ? "" : " " + row.name.substr(here.size() + 1)) +
            (entry.calls_c_library ? " libm\n" : "\n");
  }
  for (const std::string& each : changed) std::cout << each << "\n";
  std::ofstream out(file);
  out << text;
  if (!out.flush()) throw Error(file + ": cannot be written");
  return changed.empty() ? 0 : 1;
}

int show(std::span<const std::string> parts) {
  for (const Case& one : all_cases()) {
    if (!is_chosen(one.name, parts)) continue;
    (void)called_c_library();
    const std::string numbers = one.numbers();
    std::cout << "== " << one.name << (called_c_library() ? " (calls the C library)" : "") << "\n"
              << one.request << "--\n"
              << numbers;
    for (const Variant& variant : one.variants) {
      const std::string other = variant.numbers();
      if (other != numbers) std::cout << "-- other numbers when " << variant.name << "\n" << other;
    }
  }
  return 0;
}

int main_of(const std::vector<std::string>& words) {
  const std::string command = words.empty() ? "" : words[0];
  const std::span rest(words);
  if (command == "check" && words.size() >= 2) return check(words[1], rest.subspan(2));
  if (command == "write" && words.size() == 2) return write(words[1]);
  if (command == "show" && words.size() >= 2) return show(rest.subspan(1));
  std::cerr << "usage: bits_ledger check FILE [PART...] | write FILE | show PART...\n";
  return 2;
}

}  // namespace
}  // namespace hamflow::test

int main(int count, char** words) {
  try {
    return hamflow::test::main_of({words + 1, words + count});
  } catch (const std::exception& error) {
    std::cerr << "bits_ledger: " << error.what() << "\n";
    return 2;
  }
}
