// The declaration of an option. The reader of scenarios with its messages, `show`, `list` and `new`, the options of a
// method on the command line and in the shell, the keys that --resume may change, and docs/reference.md use it.
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
  bool open = false;   // least and most are excluded
  bool whole = false;  // whole numbers only; 1e6 is one
  bool not_zero = false;

  static const Range any, positive, not_negative;
  static const Range count;  // a whole number from 1 to 10^6
  static constexpr Range whole_from(double least, double most) { return {least, most, false, true}; }
  static constexpr Range between(double least, double most) { return {least, most, true, false}; }

  /// False for NaN and infinities.
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
  word_list,       // a list of some of `words`; a single word counts as a list of one
  yes_no,          // true, false
  text,            // any non-empty text
  table            // with the keys `keys`
};

struct OptionInfo {
  std::string name;
  std::string default_value{};  // a number, "[...]" or a word; empty: `unset` says what holds without the option
  std::string meaning{};
  Range range{};  // of each number
  OptionType type = OptionType::number;
  std::size_t length = 0;  // of a list; 0: any length from 1
  bool required = false;
  std::vector<std::string> words{};  // the allowed words; for numbers those allowed instead of a number, e.g. "auto"
  std::string unset{};               // what holds without a default, e.g. "its rounding level"
  std::string unit{};                // e.g. "1/time"; empty: the unit of the input, or none
  std::string condition{};           // when it applies, e.g. "with arithmetic = \"lattice\""
  std::string example{};             // a value for `new` if there is no default
  int position = 0;                  // from 1: can be given by position, as in cg(2,6); 0: by name only
  bool beyond_double = false;        // values outside the range of double are allowed
  bool free_on_resume = false;       // does not change a bit of the results: --resume accepts another value
  std::vector<OptionInfo> keys{};    // of a table
};

/// The allowed values, for messages: "a whole number from 1 to 1000", "a positive number, or \"auto\"", "error, halve".
std::string allowed_text(const OptionInfo& option);
/// The range alone: "positive", "from 1 to 64", "between 0 and 1", "other than 0"; empty if all numbers are allowed.
std::string range_text(const Range& range);
/// The error of a text given for an option: "found '...'; allowed ...; did you mean ...?"; empty if the text is
/// accepted. For a malformed number it is the message of the formula reader, which has the column of the error.
std::string refused_value(const OptionInfo& option, const std::string& text);
/// The default, or what holds without the option, in square brackets as in tables: "[newton]", "[unset: ...]".
std::string default_text(const OptionInfo& option);
/// The text as a TOML value: quoted unless it is a number, true or false.
std::string toml_text(const OptionInfo& option, const std::string& text);

/// The option of that name; null if there is none.
const OptionInfo* find_option(std::span<const OptionInfo> options, const std::string& name);
std::vector<std::string> option_names(const std::vector<OptionInfo>& options);

/// The value of a text that refused_value() accepts.
double number_value(const std::string& text);
/// As number_value(), but in long double if a double would be 0, subnormal or infinite.
long double wide_number_value(const std::string& text);

/// An option that sets members of a struct of options, from a text that refused_value() accepts.
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

/// A struct of options from the given texts; other members keep their values.
template <class Owner>
Owner read_options(const BoundOptions<Owner>& options, const Texts& given, Owner into = {}) {
  for (const auto& option : options) {
    if (const auto text = given.find(option.info.name); text != given.end()) option.set(into, text->second);
  }
  return into;
}

/// Binds a number to a member of type int, double, long double or std::optional<double>; each word stands for the value
/// next to it.
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

/// Binds a closed list of words to a member; each word stands for the value next to it.
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
