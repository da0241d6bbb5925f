// The gnuplot process: scripts go in, the bytes of their figures come out.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "hamflow/core/error.hpp"
#include "terminal.hpp"

namespace hamflow::figures {

/// gnuplot was ended because whoever waited for it was asked to stop.
struct DrawingStopped : FileError {
  using FileError::FileError;
};

/// While it lives, this thread asks `go_on` whenever it waits for gnuplot; an answer of false ends gnuplot.
class WhileDrawing {
 public:
  explicit WhileDrawing(std::function<bool()> go_on);
  ~WhileDrawing();
  WhileDrawing(const WhileDrawing&) = delete;
  WhileDrawing& operator=(const WhileDrawing&) = delete;

 private:
  std::function<bool()> go_on_;
  const std::function<bool()>* before_;
};

/// Runs scripts, whose first lines choose the terminals, in one process and returns the figures that it writes, one of
/// each.   @param longest seconds for each of them, after which gnuplot is ended
/// @throws FileError with gnuplot's own words, or when it takes longer   @throws DrawingStopped
std::vector<std::string> run_gnuplot(const std::vector<std::string>& scripts, double longest = 300);

/// The same figure without what changes from run to run or names the program: dates, and tooltips saying "Gnuplot".
/// @throws FileError when the bytes are not a figure of that format
std::string finished(std::string bytes, Format format, const std::string& title);

/// A script that shows whether gnuplot finds a font: without one it draws blanks, and says nothing.
std::string font_probe();
/// @param probed what font_probe() drew   @throws FileError naming the package to install
void require_font(const std::string& probed);

}  // namespace hamflow::figures
