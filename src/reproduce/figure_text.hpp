// A figure in words, for who cannot see it.
#pragma once

#include <string>

#include "page.hpp"

namespace hamflow::reproduction {

/// "2 panels. 1: E over t, x from 0 to 25, y from -1 to 1; exact (a line), element (dots)."
std::string in_words(const figures::Page& page);
/// gnuplot's enhanced text without its marks: "{/:Italic p}_1" is "p1".
std::string plain_text(const std::string& enhanced);

}  // namespace hamflow::reproduction
