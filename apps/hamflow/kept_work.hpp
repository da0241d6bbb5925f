// The results that a command has saved when it runs out of memory, if --resume can continue from its folder.
#pragma once

#include <filesystem>
#include <string>

namespace hamflow::app {

struct KeptWork {
  bool forced = false;             // the command was given --force, which --resume has to replace
  std::filesystem::path folder{};  // empty: the command has not yet written to a folder
  /// The checkpoint file in the folder, which tells whether a step was saved; empty: every file there is a result.
  std::string checkpoint{};

  /// Says where the results are and how to continue; empty if there is nothing to continue from.
  std::string sentence() const;
};

}  // namespace hamflow::app
