// Text for gnuplot. All strings are single-quoted, because gnuplot executes backticks in double-quoted ones.
#pragma once

#include <string>
#include <vector>

namespace hamflow::figures {

/// Replaces control characters by blanks, and broken UTF-8 by a replacement character.
std::string printable(const std::string& text);
/// Returns printable text as a gnuplot string in single quotes; quotes in it are doubled.
std::string quoted(const std::string& text);
/// Returns text that enhanced mode shows literally, without subscripts, braces or fonts.
std::string escaped(const std::string& text);
/// Returns the name of a coordinate as a symbol in enhanced text: q1 is q with subscript 1, phi is the Greek letter.
std::string symbol(const std::string& name);
/// Returns the name that a user or a problem gave to a quantity: as a symbol if it looks like one (L_z, kin_1),
/// otherwise as words (angular momentum).
std::string quantity(const std::string& name);
/// Returns x1 for x[1], a name in typed systems of any size; other names are unchanged.
std::string without_brackets(const std::string& name);
/// Returns "10^{-15}" in enhanced text, with a real minus sign.
std::string power_of_ten(int exponent);
/// Writes a small number in enhanced text: 2.2 times 10^{-16}.
std::string short_number(double x);
/// Returns the number of printed characters, without the markup of enhanced text.
std::size_t printed_length(const std::string& enhanced);
/// Writes a number with at most four digits, such as 2000 or 10^{5}, in enhanced text.
std::string short_value(double x);
/// Shortens plain texts to at most `most` characters. Of a longer text, a part from where the texts differ is kept
/// between dots. Texts that are then equal are numbered.
std::vector<std::string> shortened(const std::vector<std::string>& texts, std::size_t most);
/// Breaks a text into at most `most` lines of about `width` characters, at spaces or after commas if there are any.
std::vector<std::string> wrapped(const std::string& text, std::size_t width, std::size_t most);
/// The same for enhanced text, whose groups are kept whole. Without spaces it is broken after an operator.
std::vector<std::string> wrapped_enhanced(const std::string& text, std::size_t width, std::size_t most);

}  // namespace hamflow::figures
