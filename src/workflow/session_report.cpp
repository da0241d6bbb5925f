// Makes the summary and writes the folder of a session.
#include <algorithm>

#include "csv_file.hpp"
#include "hamflow/workflow/session.hpp"
#include "hamflow/workflow/work_folder.hpp"
#include "run_description.hpp"
#include "run_file.hpp"
#include "summary.hpp"
#include "whole_file.hpp"

namespace hamflow {

Summary session_summary(const Session& session, const SessionOutcome& last) {
  RunResult result;
  result.outcome = last.outcome;
  if (is_failure(last.outcome)) result.failure = cause_of(session.failure());
  result.wall_seconds = last.wall_seconds;
  result.steps_taken = session.step();
  Summary all = summary_of(session.present(), session, result, nullptr, nullptr, &session.turns());
  all.changes = session.changes();
  if (all.changes.empty()) return all;
  all.diagnostics.reset();  // they only cover the last part
  if (session.reversed()) {
    all.exact.reset();  // both follow from the start, which is now on another orbit
    all.bodies.clear();
  }
  return all;
}

void save_session(const Session& session, const SampleKeeper& samples, const SessionOutcome& last,
                  const std::filesystem::path& path, bool replace) {
  WorkFolder folder(path, run_folder(), replace ? Existing::replace : Existing::refuse);
  folder.prepare();
  const Scenario present = session.present();
  const std::vector<Frame> kept = samples.with_current_state(session);
  RunDescription description = description_of(present, kept.size());
  description.events.clear();
  description.section = false;       // a session does not search for section points
  description.energy_range = false;  // each part of the session has its own range
  const auto falls = [](const Frame& a, const Frame& b) { return !(a.time < b.time); };
  description.particles.time_grows = std::adjacent_find(kept.begin(), kept.end(), falls) == kept.end();
  WholeFile whole(folder / "run.h5", next_name(folder / "run.h5"));
  {
    RunRows rows(description);
    RunFile h5(whole.part(), description, rows);
    for (const Frame& sample : kept) {
      rows.append(sample, observable_values(present, sample));
      h5.flush_if_many();
    }
    if (description.walls) {
      for (const Bounce& bounce : session.bounces()) rows.append(bounce);
    }
    h5.flush();
  }
  whole.put_in_place();
  if (std::find(present.formats.begin(), present.formats.end(), "csv") != present.formats.end()) {
    WholeFile text(folder / "trajectory.csv", next_name(folder / "trajectory.csv"));
    CsvFile csv(text.part(), present.start_q.size(), csv_columns(present));
    for (const Frame& sample : kept) csv.append(sample, observable_values(present, sample));
    csv.flush();
    text.put_in_place();
  }
  folder.write("summary.json", summary_json(session_summary(session, last)));
}

}  // namespace hamflow
