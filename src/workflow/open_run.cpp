#include "hamflow/workflow/open_run.hpp"

#include <fstream>
#include <iterator>

#include "figure_data.hpp"
#include "run_description.hpp"
#include "run_file.hpp"

namespace hamflow {

OpenedRun open_run(const std::filesystem::path& run) {
  const std::filesystem::path file = stored_run_in(run);
  StoredRun stored = read_run_file(file, {.digits = true, .counts = true, .events = true});
  OpenedRun opened{scenario_of(stored, file), std::move(stored.tables), {}};
  const std::filesystem::path summary = file.parent_path() / "summary.json";
  std::ifstream in(summary, std::ios::binary);
  if (in) opened.summary.assign(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  return opened;
}

}  // namespace hamflow
