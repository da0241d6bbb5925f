// The keys of [method], as the families of methods declare them.
#pragma once

#include <toml++/toml.h>

#include <memory>
#include <string>
#include <vector>

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// `name`, one of the closed list; in a scenario it may carry options, as in "cg(1,5)".
const OptionInfo& method_name_key();
/// The names of the options of all families, each once.
const std::vector<std::string>& all_method_keys();
/// Whether the text is the name of a method with something in parentheses behind it.
bool names_method_with_options(const std::string& text);
/// The name of the method in a document, without options; empty where there is none.
std::string method_named_in(const toml::table& root);
/// Whether two families mean the same by an option, so that a value for the one is one for the other: the tolerance of
/// a series is none of a Newton iteration.
bool same_option(const OptionInfo& a, const OptionInfo& b);
/// The keys of [method] in the file that do not apply because a method was set from outside (--set, --vary): options
/// that it does not have or means otherwise than the file's own method, and options that its name carries.
/// @param file_method the name of the file's own, method_named_in() before anything was set
std::vector<std::string> replaced_method_keys(const toml::table& method, const std::string& file_method);
/// [method], with each --set carried out, for the methods of a comparison, which stand on the command line: what `run`
/// would do with the name set to each of them. Keys of --set that one of several methods does not have are not its own.
class SharedMethodKeys {
 public:
  /// @param text the scenario's
  SharedMethodKeys(const std::string& text, const std::vector<std::string>& sets);
  ~SharedMethodKeys();
  SharedMethodKeys(const SharedMethodKeys&) = delete;
  SharedMethodKeys& operator=(const SharedMethodKeys&) = delete;

  /// Takes the options that apply to a method and that it does not carry itself.
  /// @param spelled the method as it was given, with its options
  void add_to(MethodSpec& method, const std::string& spelled);
  /// Keys that no method has: misspelt ones, with which every method is refused.
  std::vector<std::string> unknown() const;
  /// The keys that some method was read without, and why, a sentence each.
  /// @param one_row_each of a comparison with one dt
  std::vector<std::string> notes(bool one_row_each) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Removes them from the [method] of a document.
void drop_replaced_method_keys(toml::table& root, const std::string& file_method);

}  // namespace hamflow
