// A TOML table under examination: typed look-ups that collect complaints instead of stopping at the first.
#pragma once

#include <toml++/toml.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

/// A number as text, with its value in double.
struct Number {
  std::string text;
  double value = 0;
};

class TomlTable {
 public:
  /// @param table may be null: every key is then missing   @param path dotted, empty for the root
  TomlTable(const toml::table* table, std::string path, std::string file, std::vector<Complaint>& complaints);

  bool exists() const { return table_ != nullptr; }
  bool has(const std::string& key) const { return table_ != nullptr && table_->contains(key); }

  // Each look-up makes the key known; finish() complains about the others.
  std::optional<std::string> string(const std::string& key);
  /// A string out of a closed list.
  std::optional<std::string> choice(const std::string& key, const std::vector<std::string>& allowed);
  std::optional<Number> number(const std::string& key);
  std::optional<bool> boolean(const std::string& key);
  std::optional<std::int64_t> whole(const std::string& key, std::int64_t least, std::int64_t most);
  /// An array of so many numbers; 0: any, but not none.
  std::optional<std::vector<Number>> numbers(const std::string& key, std::size_t count);
  std::optional<std::vector<Number>> number_or_numbers(const std::string& key);
  /// An array of so many tables.
  std::optional<std::vector<TomlTable>> tables(const std::string& key, std::size_t count);
  /// A list of strings out of a closed list; a single string counts as a list of one.
  std::optional<std::vector<std::string>> choices(const std::string& key, const std::vector<std::string>& allowed);
  TomlTable table(const std::string& key);
  void know(const std::string& key) { known_.push_back(key); }
  void know_all(const std::vector<std::string>& keys) { known_.insert(known_.end(), keys.begin(), keys.end()); }
  bool is_boolean(const std::string& key) const { return has(key) && table_->get(key)->is_boolean(); }
  /// Whether the value came from the command line and not from the file.
  bool from_set(const std::string& key) const { return has(key) && table_->get(key)->source().begin.line == 0; }

  /// Complains about every key nobody asked for, naming the nearest that is known.
  void finish();

  void missing(const std::string& key, const std::string& allowed);
  /// A complaint at the key's value, or at the table when the key is absent.
  void complain(const std::string& key, const std::string& message);
  std::string full(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }
  std::string found(const std::string& key) const;

 private:
  const toml::node* find(const std::string& key);
  std::optional<Number> number_of(const toml::node& node, const std::string& key);
  void complain_at(const toml::source_region& where, const std::string& key, const std::string& message);

  const toml::table* table_;
  std::string path_;
  std::string file_;
  std::vector<Complaint>* complaints_;
  std::vector<std::string> known_;
};

/// "a, b, c".
std::string joined(const std::vector<std::string>& words);
/// "; did you mean NAME?" or nothing.
std::string suggestion(const std::string& name, const std::vector<std::string>& candidates);

}  // namespace hamflow
