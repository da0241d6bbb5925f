// What gnuplot writes: the formats of files, the terminals that make them, and the drawing of a script.
#pragma once

#include <filesystem>
#include <string>

namespace hamflow {

/// Empty if the file's extension is that of a figure, .svg, .pdf or .png, else what is wrong with it.
std::string refused_figure_file(const std::filesystem::path& file);

}  // namespace hamflow

namespace hamflow::figures {

enum class Format { svg, pdf, png };

/// By the extension of the file, in upper or lower case. @throws Error when it is none of a figure
Format format_of(const std::filesystem::path& file);

/// The lines that choose the terminal for a page of so many millimetres. In every format a line width of 1 is one point
/// and a point size of 1 a radius of three points.   @param dpi pixels to the inch, of a PNG
std::string terminal(Format format, double width, double height, double text_points, int dpi);

/// "font ',8'": the font of the terminal in another size.
std::string font(Format format, double points);

}  // namespace hamflow::figures
