// Lets a program stop drawing, for example after Ctrl-C, while it waits for gnuplot.
#pragma once

#include <functional>

#include "hamflow/core/error.hpp"

namespace hamflow::figures {

/// Thrown if gnuplot was ended because the caller's `go_on` returned false.
struct DrawingStopped : FileError {
  using FileError::FileError;
};

/// While an object exists, this thread calls `go_on` whenever it waits for gnuplot; if it returns false, gnuplot is
/// ended.
class StopDrawingScope {
 public:
  explicit StopDrawingScope(std::function<bool()> go_on);
  ~StopDrawingScope();
  StopDrawingScope(const StopDrawingScope&) = delete;
  StopDrawingScope& operator=(const StopDrawingScope&) = delete;

 private:
  std::function<bool()> go_on_;
  const std::function<bool()>* before_;
};

}  // namespace hamflow::figures
