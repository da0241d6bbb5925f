// Typed access to a TOML table that collects complaints instead of stopping at the first one.
#pragma once

#include <toml++/toml.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hamflow/core/text.hpp"
#include "hamflow/detail/core/option_info.hpp"
#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

class TomlTable {
 public:
  /// @param table may be null; then every key is missing   @param path dotted path, empty for the root
  TomlTable(const toml::table* table, std::string path, std::string file, std::vector<Complaint>& complaints);

  bool exists() const { return table_ != nullptr; }
  /// Returns the table itself, or an empty one if there is none.
  const toml::table& node() const;
  bool has(const std::string& key) const { return table_ != nullptr && table_->contains(key); }

  /// Returns whether there is a value other than an empty list.
  bool has_any(const std::string& key) const;

  // Each access makes the key known; finish() complains about the others. A value that the option does not accept
  // causes a complaint and is then treated as missing. A missing required value causes a complaint, too.
  /// Returns the value as text: "0.1", "[1, 2]", "auto", "true".
  /// @param behind appended to the allowed values in messages, for example " (the mass)"
  std::optional<std::string> text(const OptionInfo& option, const std::string& behind = "");
  std::optional<double> number(const OptionInfo& option);
  std::optional<std::int64_t> whole(const OptionInfo& option);
  /// Returns the entries of a list of numbers.
  std::optional<std::vector<std::string>> numbers(const OptionInfo& option);
  /// Returns the entries of a list of words; a single string counts as a list of one.
  std::optional<std::vector<std::string>> words(const OptionInfo& option);
  std::optional<bool> yes_no(const OptionInfo& option);
  /// Returns the tables of an array with `count` entries; 0: any number.
  std::optional<std::vector<TomlTable>> tables(const std::string& key, std::size_t count);
  TomlTable table(const std::string& key);
  /// Returns the keys of the table, in the order of the file.
  std::vector<std::string> keys() const;
  /// Returns the keys that no access has made known.
  std::vector<std::string> unknown_keys() const;
  /// Returns the entries of a list of free texts, none of which is empty.
  std::optional<std::vector<std::string>> texts(const std::string& key);
  void know(const std::string& key) { known_.push_back(key); }
  bool knows(const std::string& key) const { return std::find(known_.begin(), known_.end(), key) != known_.end(); }
  void know_all(const std::vector<std::string>& keys) { known_.insert(known_.end(), keys.begin(), keys.end()); }
  /// Returns whether the value came from the command line instead of the file.
  bool is_set(const std::string& key) const;

  /// Complains about every key that no access has made known, and names the nearest known one.
  /// @param problem,method if they are known, only keys that other tables have with them are suggested
  void finish(const ProblemEntry* problem = nullptr, const std::string& method = "");

  /// Returns the text of a string; nullopt, without a complaint, if the value is not a string.
  std::optional<std::string> plain_string(const std::string& key);
  void missing(const std::string& key, const std::string& allowed);
  /// Complains at the value of the key, or at the table if the key is missing. If a part of it was set from outside,
  /// the complaint has no line of the file.
  void complain(const std::string& key, const std::string& message);
  /// Complains at a part of a value: "invariants.L", "coordinates[1]".
  void complain_in(const std::string& part, const std::string& message);
  std::string full(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }
  std::string found(const std::string& key) const;

 private:
  /// Makes "; allowed ...". It is called only for a complaint, because a sweep reads hundreds of thousands of
  /// scenarios.
  using Allowed = std::function<std::string()>;

  const toml::node* find(const std::string& key);
  template <class Wanted>
  std::vector<std::string> keys_where(const Wanted& wanted) const;
  std::optional<std::string> number_text(const toml::node& node, const OptionInfo& option, const Allowed& allowed);
  std::optional<std::string> list_text(const toml::node& node, const OptionInfo& option, const Allowed& allowed);
  std::optional<std::vector<std::string>> list_entries(const toml::node& node, const OptionInfo& option,
                                                       const Allowed& allowed);
  std::optional<std::string> word_text(const toml::node& node, const OptionInfo& option, const Allowed& allowed);
  void complain_at(const toml::source_region& where, const std::string& key, const std::string& message);

  const toml::table* table_;
  std::string path_;
  std::string file_;
  std::vector<Complaint>* complaints_;
  std::vector<std::string> known_;
};

}  // namespace hamflow
