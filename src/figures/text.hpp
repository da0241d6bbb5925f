// Text for gnuplot. Strings are single-quoted throughout: in double quotes gnuplot would run what stands in backticks.
#pragma once

#include <string>
#include <vector>

namespace hamflow::figures {

/// The text with control characters blank and broken UTF-8 replaced.
std::string printable(const std::string& text);
/// 'text', printable, as a gnuplot string: quotes doubled.
std::string quoted(const std::string& text);
/// The text itself, where enhanced mode is on: no subscripts, no braces, no fonts.
std::string escaped(const std::string& text);
/// The name of a coordinate as a symbol in enhanced text: q1 is q with subscript 1, phi the Greek letter.
std::string symbol(const std::string& name);
/// The name of a quantity that a user or a problem gave it: a symbol where it reads like one, as L_z and kin_1 do, else
/// its words, as angular momentum.
std::string quantity(const std::string& name);
/// x1 of x[1], as typed systems of any size name their coordinates; other names as they are.
std::string without_brackets(const std::string& name);
/// "10^{-15}" in enhanced text, with a real minus sign.
std::string power_of_ten(int exponent);
/// A small number for reading: 2.2 times 10^{-16}, in enhanced text.
std::string short_number(double x);
/// Characters in print, without the signs of enhanced text.
std::size_t printed_length(const std::string& enhanced);
/// A number of four digits at most, 2000 or 10^{5}, in enhanced text.
std::string short_value(double x);
/// Texts of at most `most` characters: of longer ones a part, from where they differ, between dots. Texts that are
/// alike then are numbered. Plain text, as it goes in and comes out.
std::vector<std::string> shortened(const std::vector<std::string>& texts, std::size_t most);
/// At most `most` lines of about `width` characters, broken at spaces or behind commas where there are any.
std::vector<std::string> wrapped(const std::string& text, std::size_t width, std::size_t most);
/// The same of enhanced text, whose groups stay whole; without spaces it is broken behind an operator.
std::vector<std::string> wrapped_enhanced(const std::string& text, std::size_t width, std::size_t most);

}  // namespace hamflow::figures
