// Stopping while a figure is drawn: a program that catches Ctrl-C is asked while it waits for gnuplot.
#pragma once

#include <functional>

#include "hamflow/core/error.hpp"

namespace hamflow::figures {

/// gnuplot was ended because the caller's `go_on` returned false.
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

}  // namespace hamflow::figures
