// What is wrong at one place of a text that was typed: the form of all messages about numbers and formulas,
//     found "2*pi/0", column 5: 2*pi divided by 0; allowed a divisor other than 0; did you mean ...?
#pragma once

#include <string>
#include <string_view>

namespace hamflow {

/// A text, or what stands around one place of it where it is long.
std::string shown(std::string_view text, std::size_t at = 0);
/// Without the blanks at its ends.
std::string_view trimmed(std::string_view text);
/// A blank or a tab.
constexpr bool is_blank(char c) { return c == ' ' || c == '\t'; }
constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }
/// Of a name: an ASCII letter or '_'.
constexpr bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
/// Not the first byte of a character in UTF-8.
constexpr bool continues_character(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }
/// With small letters in place of large ones.
std::string lower(std::string_view word);
/// How what others write as a function or a constant ("ln", "pow", "e") is written here; empty where nothing is known.
std::string written_here(std::string_view name);
/// The character at a place in quotes, or "the end".
std::string character_at(std::string_view text, std::size_t at);

/// @param at offset in bytes; the message counts characters, from 1   @param meant empty: nothing is proposed
/// @throws Error always
[[noreturn]] void refuse_at(std::string_view text, std::size_t at, const std::string& what, const std::string& allowed,
                            const std::string& meant = "");

}  // namespace hamflow
