// File formats of figures and the gnuplot terminals that write them.
#pragma once

#include <filesystem>
#include <string>

namespace hamflow {

/// Returns an empty text if the file's extension is .svg, .pdf or .png, otherwise what is wrong with it.
std::string refused_figure_file(const std::filesystem::path& file);

}  // namespace hamflow

namespace hamflow::figures {

enum class Format { svg, pdf, png };

/// Returns the format for the extension of the file, in upper or lower case. @throws Error for another extension
Format format_of(const std::filesystem::path& file);

/// Returns the lines that choose the terminal for a page with this size in millimetres. In every format a line width of
/// 1 is one point, and a point size of 1 is a radius of three points.   @param dpi pixels per inch of a PNG
std::string terminal(Format format, double width, double height, double text_points, int dpi);

/// Returns "font ',8'", which is the font of the terminal in another size.
std::string font(Format format, double points);

}  // namespace hamflow::figures
