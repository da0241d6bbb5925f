#include "kept_work.hpp"

#include "checkpoint.hpp"

namespace hamflow::app {

namespace {
/// The first checkpoint holds no step; it only marks the folder as one of this run. This function is called after
/// memory has run out and may run out of it again; then it returns false, so that no result is promised.
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
  return "the results so far are in " + folder.string() + "; to continue, give the same command with --resume" +
         (forced ? " in place of --force" : "");
}

}  // namespace hamflow::app
