// Reads --size and --dpi of a figure.
#pragma once

#include <filesystem>
#include <string>

#include "hamflow/figures/page.hpp"

namespace hamflow {

/// Sets width and height from "8.5x6" (centimetres), "85x60mm" or "3.35x2.4in".
/// @returns what is wrong with the text, "found ...; allowed ..."; empty if nothing is
std::string read_page_size(const std::string& text, figures::PageOptions& page);

/// Explains why a file of that name cannot have this resolution; empty if it can.
std::string refused_dpi(int dpi, const std::filesystem::path& file, const figures::PageOptions& page);

}  // namespace hamflow
