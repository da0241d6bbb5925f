#include "toml_depth.hpp"

#include <algorithm>
#include <string_view>

namespace hamflow {

namespace {

/// Scans a text and skips strings and comments.
class Walk {
 public:
  explicit Walk(std::string_view text) : text_(text) {}

  std::optional<NestingError> carry_out() {
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '"' || c == '\'') {
        skip_string(c);
      } else if (c == '#') {
        at_ = std::min(text_.find('\n', at_), text_.size()) - 1;
      } else if (c == '.') {
        if (++dots_ >= most_key_parts) return here("a key of more than", most_key_parts, "parts");
      } else if (c == '[' || c == '{') {
        dots_ = 0;
        if (++depth_ > most_nested_brackets) return here("brackets within more than", most_nested_brackets, "others");
      } else if (c == ']' || c == '}') {
        --depth_;
      } else if (c == '\n' || c == ',' || c == '=') {  // blanks do not end a key: "a . b" is a key of two parts
        dots_ = 0;
      }
    }
    return std::nullopt;
  }

 private:
  /// Moves to the last quote of the string, or to the end of the text if there is none; then the parser complains.
  void skip_string(char quote) {
    const std::string three(3, quote);
    if (text_.substr(at_, 3) == three) {
      const std::size_t end = text_.find(three, at_ + 3);
      at_ = end == std::string_view::npos ? text_.size() : end + 2;
      return;
    }
    for (++at_; at_ < text_.size() && text_[at_] != quote && text_[at_] != '\n'; ++at_) {
      if (quote == '"' && text_[at_] == '\\') ++at_;
    }
  }

  NestingError here(const std::string& found, int most, const std::string& things) const {
    const std::string_view before = text_.substr(0, at_);
    NestingError where;
    for (const char c : before) where.line += c == '\n' ? 1 : 0;
    where.column = static_cast<int>(at_ - (before.rfind('\n') + 1)) + 1;
    where.message =
        "found " + found + " " + std::to_string(most) + " " + things + "; allowed at most " + std::to_string(most);
    return where;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int dots_ = 0;
  int depth_ = 0;
};

}  // namespace

std::optional<NestingError> too_deep(const std::string& toml) { return Walk(toml).carry_out(); }

}  // namespace hamflow
