// Keys of [method], which the families of methods declare.
#pragma once

#include <toml++/toml.h>

#include <memory>
#include <string>
#include <vector>

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// Returns the key `name`, a word of a closed list. In a scenario it may carry options, as in "cg(1,5)".
const OptionInfo& method_name_key();
/// Returns the names of the options of all families, each once.
const std::vector<std::string>& all_method_keys();
/// Returns whether the text is the name of a method followed by a parenthesis.
bool names_method_with_options(const std::string& text);
/// Returns the name of the method in a document, without options; empty if there is none.
std::string method_named_in(const toml::table& root);
/// Returns whether an option has the same meaning in two families, so that a value can be transferred. For example, the
/// tolerances of taylor and of Newton's iteration have different meanings.
bool same_option(const OptionInfo& a, const OptionInfo& b);
/// Returns the keys of [method] in the file that do not apply because --set or --vary gives another method: options
/// that the method does not have, that have another meaning than for the method of the file, or that its name contains.
/// @param file_method method of the file: method_named_in() before any key was set
std::vector<std::string> replaced_method_keys(const toml::table& method, const std::string& file_method);
/// Keys of [method] for the methods of a comparison, with every --set applied. Each method gets the options that `run`
/// would use if method.name were set to it. A key of --set that a method does not have is not used for it.
class SharedMethodKeys {
 public:
  /// @param text text of the scenario
  SharedMethodKeys(const std::string& text, const std::vector<std::string>& sets);
  ~SharedMethodKeys();
  SharedMethodKeys(const SharedMethodKeys&) = delete;
  SharedMethodKeys& operator=(const SharedMethodKeys&) = delete;

  /// Adds to a method those options of [method] that apply to it and that it does not have yet.
  /// @param spelled the method as it was typed, with its options
  void add_to(MethodSpec& method, const std::string& spelled);
  /// Returns keys that no method has, such as misspelt ones. With such a key every method is refused.
  std::vector<std::string> unknown() const;
  /// Returns a sentence for each key that some method does not use, with the reason.
  /// @param one_row_each the comparison has one dt
  std::vector<std::string> notes(bool one_row_each) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Removes the replaced_method_keys() from [method] of a document.
void drop_replaced_method_keys(toml::table& root, const std::string& file_method);

}  // namespace hamflow
