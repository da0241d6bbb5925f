// **Ledger of bits**: final states, energy errors and evaluation counts of ten thousand short runs, as hashes.
//
//     bits_ledger check bits.txt [PART...]   compare with the stored hashes; exit status 1 where one differs
//     bits_ledger write bits.txt             store the hashes anew
//     bits_ledger show PART...               print the request and the numbers of cases whose names contain PART
//
// A change that is meant to keep every bit passes `check`. After a deliberate change, `write` the file, and say in the
// commit why the bits of these cases changed. To see how two builds differ, compare what `show` prints in each.
//
// Cases that differ only in their last word, mostly the arithmetic, are a row. Rows of one problem stand under its
// name. A row has up to three hashes, of its cases of each kind:
//     +      only + - * / sqrt in double, compensated, double-double or on the lattice: the same bits on every machine
//     libm   calls exp, sin, ... of the C library, which may have other last bits in another version or on another
//            processor: compared only where these functions give the bits that they gave when the file was written
//     other  in quad or mp(d), or with functions of double-double: not compared in a portable build
//
// Some cases have variants that must not change a bit: steps that are not recorded, a run that is saved and restored,
// members in SIMD lanes, threads. Their numbers are compared with those of the case itself, whatever its kind.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <map>
#include <span>
#include <sstream>

#include "bits_cases.hpp"
#include "function_calls.hpp"
#include "hamflow/arithmetic/double_double.hpp"
#include "hamflow/core/error.hpp"
#include "hamflow/detail/core/hash.hpp"
#include "hamflow/detail/numerics/lobatto.hpp"
#include "hamflow/numerics/gauss_legendre.hpp"

namespace hamflow::test {
namespace {

constexpr const char* c_library_name = "C-library";

const std::string portable = "+";
const std::string c_library = "libm";
const std::string other = "other";
/// By kind.
using Hashes = std::map<std::string, std::string>;
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
  return std::string(text).substr(4);
}

/// Made once and kept: that their first user calls functions would make its case one of another kind.
void make_tables() {
  (void)gauss_rule<double>(1);
  for (int stages = 2; stages <= 10; ++stages) {
    (void)lobatto_pair<double>(stages);
    (void)lobatto_pair<DoubleDouble>(stages);
  }
}

/// The numbers of a case, and its kind.
std::pair<std::string, std::string> computed(const Case& one) {
  (void)function_calls();
  std::string numbers = one.numbers();
  const FunctionCalls calls = function_calls();
  const bool is_other = one.is_beyond_portable || calls.double_double;
  return {std::move(numbers), is_other ? other : calls.c_library ? c_library : portable};
}

struct Computed {
  Hashes hashes{};
  std::map<std::string, std::size_t> cases{};  // how many there are of each kind
  std::vector<std::string> changed{};          // variants with other numbers
  std::size_t variants = 0;
};
Computed computed(const Row& row) {
  Computed result;
  std::map<std::string, std::string> texts;
  for (const Case& one : row.cases) {
    const auto [numbers, kind] = computed(one);
    texts[kind] += one.name + "\n" + numbers;
    ++result.cases[kind];
    for (const Variant& variant : one.variants) {
      if (variant.numbers() != numbers) result.changed.push_back(one.name + ": other numbers when " + variant.name);
    }
    result.variants += one.variants.size();
  }
  for (const auto& [kind, text] : texts) result.hashes[kind] = hash_text(fnv1a(std::as_bytes(std::span(text))));
  return result;
}

std::map<std::string, Hashes> read_file(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw Error(file + ": cannot be read");
  std::map<std::string, Hashes> rows;
  std::string section;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string name, kind, hash;
    words >> name;
    if (!line.starts_with(' ')) section = name;
    Hashes hashes;
    while (words >> kind >> hash) hashes[kind] = hash;
    if (!hashes.empty()) rows[line.starts_with(' ') ? section + "/" + name : name] = hashes;
  }
  return rows;
}

bool is_chosen(const std::string& name, std::span<const std::string> parts) {
  return parts.empty() || std::any_of(parts.begin(), parts.end(),
                                      [&](const std::string& part) { return name.find(part) != std::string::npos; });
}
bool is_chosen(const Row& row, std::span<const std::string> parts) {
  return std::any_of(row.cases.begin(), row.cases.end(), [&](const Case& one) { return is_chosen(one.name, parts); });
}

int check(const std::string& file, std::span<const std::string> parts) {
  const std::map<std::string, Hashes> stored = read_file(file);
  const auto library = stored.find(c_library_name);
  const bool is_same_library =
      library != stored.end() && library->second == Hashes{{c_library, hash_text(hash_of_c_library())}};
  const auto is_compared = [&](const std::string& kind) {
    return kind == other ? has_quad_and_mp : kind == portable || is_same_library;
  };
  std::vector<std::string> differing;
  std::map<std::string, std::size_t> compared;
  std::size_t variants = 0, left_out = 0, known = 1;
  make_tables();
  for (const Row& row : all_rows()) {
    const auto found = stored.find(row.name);
    known += found != stored.end() ? 1 : 0;
    if (!is_chosen(row, parts)) continue;
    const Computed here = computed(row);
    differing.insert(differing.end(), here.changed.begin(), here.changed.end());
    variants += here.variants;
    if (found == stored.end()) differing.push_back(row.name + ": not in the file");
    const Hashes& wanted = found == stored.end() ? here.hashes : found->second;
    for (const std::string& kind : {portable, c_library, other}) {
      const auto count = here.cases.find(kind);
      if (!is_compared(kind)) {
        left_out += count == here.cases.end() ? 0 : count->second;
        continue;
      }
      if (count != here.cases.end()) compared[kind] += count->second;
      const auto a = here.hashes.find(kind);
      const auto b = wanted.find(kind);
      const bool are_equal = a == here.hashes.end() ? b == wanted.end() : b != wanted.end() && a->second == b->second;
      if (!are_equal) differing.push_back(row.name + " (" + kind + ")");
    }
  }
  if (stored.size() != known && has_quad_and_mp) {
    differing.push_back(file + " has " + std::to_string(stored.size()) + " rows, " + std::to_string(known) +
                        " of which there are");
  }
  for (std::size_t i = 0; i < std::min<std::size_t>(differing.size(), 20); ++i) std::cout << differing[i] << "\n";
  std::cout << compared[portable] + compared[c_library] + compared[other] << " cases (" << compared[portable]
            << " of + - * / sqrt alone) and " << variants << " variants compared, " << differing.size() << " differ\n";
  if (left_out > 0) {
    std::cout << left_out << " cases were not compared: their functions have other last bits than those of the file\n";
  }
  if (!differing.empty()) std::cout << "to see numbers: bits_ledger show NAME, in both builds\n";
  return differing.empty() ? 0 : 1;
}

int write(const std::string& file) {
  if (!has_quad_and_mp) throw Error("a portable build has no quad and mp(d): found write; allowed check, show");
  std::string text = std::string(c_library_name) + " " + c_library + " " + hash_text(hash_of_c_library()) + "\n";
  std::string section;
  std::vector<std::string> changed;
  make_tables();
  for (const Row& row : all_rows()) {
    const Computed here = computed(row);
    changed.insert(changed.end(), here.changed.begin(), here.changed.end());
    const std::string begin = section_of(row.name);
    if (begin != section || row.name == begin) text += begin;
    if (begin != section && row.name != begin) text += "\n";
    section = begin;
    if (row.name != begin) text += "  " + row.name.substr(begin.size() + 1);
    for (const auto& [kind, hash] : here.hashes) text += " " + kind + " " + hash;
    text += "\n";
  }
  for (const std::string& each : changed) std::cout << each << "\n";
  std::ofstream out(file);
  out << text;
  if (!out.flush()) throw Error(file + ": cannot be written");
  return changed.empty() ? 0 : 1;
}

int show(std::span<const std::string> parts) {
  make_tables();
  for (const Case& one : all_cases()) {
    if (!is_chosen(one.name, parts)) continue;
    const auto [numbers, kind] = computed(one);
    std::cout << "== " << one.name << " (" << kind << ")\n" << one.request << "--\n" << numbers;
    for (const Variant& variant : one.variants) {
      const std::string changed = variant.numbers();
      if (changed != numbers) std::cout << "-- other numbers when " << variant.name << "\n" << changed;
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
