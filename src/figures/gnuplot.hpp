// The gnuplot process: a script goes in, the bytes of a figure come out.
#pragma once

#include <filesystem>
#include <string>

#include "terminal.hpp"

namespace hamflow::figures {

/// Runs a script and returns what gnuplot writes. @throws FileError with gnuplot's own words
std::string run_gnuplot(const std::string& script);

/// The same figure without what changes from run to run or names the program: dates, and tooltips saying "Gnuplot".
/// @throws FileError when the bytes are not a figure of that format
std::string finished(std::string bytes, Format format, const std::string& title);

/// gnuplot draws blanks where there is no font, and says nothing. @throws FileError naming the package to install
void require_font();

/// Writes a whole file or leaves the old one. @throws FileError
void write_whole(const std::filesystem::path& file, const std::string& bytes);

}  // namespace hamflow::figures
