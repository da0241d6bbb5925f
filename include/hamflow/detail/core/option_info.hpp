// An option, declared once. From its declaration come the reader of scenarios with its messages, `show`, `list` and
// `new`, the options of a method on the command line and in the shell, what --resume may change, and docs/reference.md.
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace hamflow {

/// Values by name, as text: numbers are read in the arithmetic of the run.
using Texts = std::map<std::string, std::string>;

/// The numbers that an option accepts.
struct Range {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool open = false;   // least and most themselves are excluded
  bool whole = false;  // whole numbers only; 1e6 is one
  bool not_zero = false;

  static const Range any, positive, not_negative;
  static const Range count;  // a whole number from 1 to 10^6
  static constexpr Range whole_from(double least, double most) { return {least, most, false, true}; }
  static constexpr Range between(double least, double most) { return {least, most, true, false}; }

  /// False for NaN and for what is infinite.
  bool contains(long double x) const;
};
inline constexpr Range Range::any{};
inline constexpr Range Range::positive{0, std::numeric_limits<double>::infinity(), true, false};
inline constexpr Range Range::not_negative{0, std::numeric_limits<double>::infinity(), false, false};
inline constexpr Range Range::count{1, 1e6, false, true};

enum class OptionType {
  number,          // a number, or a text with a formula of numbers
  list,            // numbers
  number_or_list,  //
  word,            // one of `words`
  word_list,       // several of them; a single one counts as a list of one
  yes_no,          // true, false
  text,            // any that is not empty
  table            // with the keys `keys`
};

struct OptionInfo {
  std::string name;
  std::string default_value{};  // a number, "[...]" or a word; empty: without the option, what `unset` says holds
  std::string meaning{};
  Range range{};  // of each number
  OptionType type = OptionType::number;
  std::size_t length = 0;  // of a list; 0: any from 1
  bool required = false;
  std::vector<std::string>
      words{};                     // the closed list of words; beside numbers those allowed in their place, e.g. "auto"
  std::string unset{};             // what holds where there is no default, e.g. "its rounding level"
  std::string unit{};              // e.g. "1/time"; empty: that of the input, or none
  std::string condition{};         // on what it depends, e.g. "with arithmetic = \"lattice\""
  std::string example{};           // a value for `new` where there is no default
  int position = 0;                // from 1: it may be given by position, as in cg(2,6); 0: by name only
  bool beyond_double = false;      // it may be smaller or larger than a double can be
  bool free_on_resume = false;     // it decides no bit of what is written: --resume takes another value
  std::vector<OptionInfo> keys{};  // of a table
};

/// What is allowed, for messages: "a whole number from 1 to 1000", "a positive number, or \"auto\"", "error, halve".
std::string allowed_text(const OptionInfo& option);
/// The range alone: "positive", "from 1 to 64", "between 0 and 1", "other than 0"; empty where all numbers are allowed.
std::string range_text(const Range& range);
/// What is wrong with a text given for an option: "found '...'; allowed ...; did you mean ...?". Empty if nothing is.
/// What is no number has the message of the formula reader, which says where the text goes wrong.
std::string refused_value(const OptionInfo& option, const std::string& text);
/// The default, or what holds without the option, in square brackets as in tables: "[newton]", "[unset: ...]".
std::string default_text(const OptionInfo& option);
/// The text as a TOML value: quoted where it is neither a number nor true or false.
std::string toml_text(const OptionInfo& option, const std::string& text);

/// The option of that name; null where there is none.
const OptionInfo* find_option(std::span<const OptionInfo> options, const std::string& name);
std::vector<std::string> option_names(const std::vector<OptionInfo>& options);

/// The value of a text that refused_value() has nothing against.
double number_value(const std::string& text);
/// The same as long double where a double would be 0, subnormal or infinite.
long double wide_number_value(const std::string& text);

/// An option that sets members of a struct of options. The text is one that refused_value() has nothing against.
template <class Owner>
struct BoundOption {
  OptionInfo info;
  std::function<void(Owner&, const std::string& text)> set;
};
template <class Owner>
using BoundOptions = std::vector<BoundOption<Owner>>;

template <class Owner>
std::vector<OptionInfo> declarations_of(const BoundOptions<Owner>& options) {
  std::vector<OptionInfo> all;
  all.reserve(options.size());
  for (const auto& option : options) all.push_back(option.info);
  return all;
}

/// A struct of options from the texts given; what is not given keeps the value of the struct.
template <class Owner>
Owner read_options(const BoundOptions<Owner>& options, const Texts& given, Owner into = {}) {
  for (const auto& option : options) {
    if (const auto text = given.find(option.info.name); text != given.end()) option.set(into, text->second);
  }
  return into;
}

/// Binds a number to a member of type int, double, long double or std::optional<double>; words stand for the values
/// beside them.
template <class Owner, class T>
BoundOption<Owner> bind_number(OptionInfo info, T Owner::*member, std::vector<std::pair<std::string, T>> words = {}) {
  for (const auto& word : words) info.words.push_back(word.first);
  return {std::move(info), [member, words = std::move(words)](Owner& owner, const std::string& text) {
            for (const auto& [word, value] : words) {
              if (text == word) {
                owner.*member = value;
                return;
              }
            }
            if constexpr (std::is_same_v<T, long double>) {
              owner.*member = wide_number_value(text);
            } else if constexpr (std::is_integral_v<T>) {
              owner.*member = static_cast<T>(number_value(text));
            } else {
              owner.*member = number_value(text);
            }
          }};
}

/// Binds a closed list of words to a member; each word stands for the value beside it.
template <class Owner, class T>
BoundOption<Owner> bind_word(OptionInfo info, T Owner::*member, std::vector<std::pair<std::string, T>> words) {
  info.type = OptionType::word;
  for (const auto& word : words) info.words.push_back(word.first);
  return {std::move(info), [member, words = std::move(words)](Owner& owner, const std::string& text) {
            for (const auto& [word, value] : words) {
              if (text == word) owner.*member = value;
            }
          }};
}

template <class Owner>
BoundOption<Owner> bind_yes_no(OptionInfo info, bool Owner::*member) {
  info.type = OptionType::yes_no;
  return {std::move(info), [member](Owner& owner, const std::string& text) { owner.*member = text == "true"; }};
}

}  // namespace hamflow
