// Errors at one place of a typed text. All messages about numbers and formulas have this form:
//     found "2*pi/0", column 5: 2*pi divided by 0; allowed a divisor other than 0; did you mean ...?
#pragma once

#include <string>
#include <string_view>

namespace hamflow {

/// The text; of a long text, the part around `at`.
std::string shown(std::string_view text, std::size_t at = 0);
/// The text without blanks at its ends.
std::string_view trimmed(std::string_view text);
/// A blank or a tab.
constexpr bool is_blank(char c) { return c == ' ' || c == '\t'; }
constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }
/// Whether a name may begin with c: an ASCII letter or '_'.
constexpr bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
/// Whether c continues a UTF-8 character, that is, is not its first byte.
constexpr bool continues_character(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }
/// The word in lower case.
std::string lower(std::string_view word);
/// How hamflow writes a function or constant of other programs ("ln", "pow", "e"); empty if unknown.
std::string written_here(std::string_view name);
/// The character at a place in quotes, or "the end".
std::string character_at(std::string_view text, std::size_t at);

/// @param at offset in bytes; the message counts characters, from 1 @param meant proposed text; empty: none
/// @throws Error always
[[noreturn]] void refuse_at(std::string_view text, std::size_t at, const std::string& what, const std::string& allowed,
                            const std::string& meant = "");

}  // namespace hamflow
