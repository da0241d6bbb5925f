// What a command that runs out of memory leaves behind, where it has a folder that --resume goes on with.
#pragma once

#include <filesystem>
#include <string>

namespace hamflow::app {

struct KeptWork {
  bool forced = false;             // the command was given --force, which --resume takes the place of
  std::filesystem::path folder{};  // empty: the work in it has not begun
  /// Says in the folder what was computed, if it was saved at all; empty: whatever is in the folder was computed.
  std::string checkpoint{};

  /// Where it is and how to go on; empty where there is nothing to go on from.
  std::string sentence() const;
};

}  // namespace hamflow::app
