// The gnuplot process: a script goes in, the bytes of a figure come out.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

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

/// Runs a script and returns what gnuplot writes. @param longest seconds after which gnuplot is ended
/// @throws FileError with gnuplot's own words, or when it takes longer   @throws DrawingStopped
std::string run_gnuplot(const std::string& script, double longest = 300);

/// The same figure without what changes from run to run or names the program: dates, and tooltips saying "Gnuplot".
/// @throws FileError when the bytes are not a figure of that format
std::string finished(std::string bytes, Format format, const std::string& title);

/// gnuplot draws blanks where there is no font, and says nothing. @throws FileError naming the package to install
void require_font();

}  // namespace hamflow::figures
