#include "kept_work.hpp"

#include "checkpoint.hpp"

namespace hamflow::app {

namespace {
/// The first checkpoint only says whose folder it is. Whether there is another is asked when memory has run out, and
/// may run out again: nothing is promised then.
bool has_saved_a_step(const std::filesystem::path& checkpoint) {
  try {
    return !read_checkpoint(checkpoint).simulation.empty();
  } catch (const std::exception&) {
    return false;
  }
}
}  // namespace

std::string KeptWork::sentence() const {
  if (folder.empty() || (!checkpoint.empty() && !has_saved_a_step(folder / checkpoint))) return {};
  return "what was computed is in " + folder.string() + ", and the same command with --resume" +
         (forced ? " in place of --force" : "") + " goes on";
}

}  // namespace hamflow::app
