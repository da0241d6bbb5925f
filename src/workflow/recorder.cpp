#include "recorder.hpp"

#include <algorithm>

#include "run_description.hpp"
#include "whole_file.hpp"

namespace hamflow {

Recorder::Recorder(const Scenario& scenario, const std::filesystem::path& folder, const std::string& identity,
                   const Checkpoint* from, std::function<void()> restart_range)
    : scenario_(scenario), folder_(folder), restart_range_(std::move(restart_range)) {
  const auto wants = [&](const char* format) {
    return std::find(scenario.formats.begin(), scenario.formats.end(), format) != scenario.formats.end();
  };
  if (from != nullptr) {
    // A checkpoint is written after the samples of its step. It excludes a sample that was only written because the run
    // ended.
    const bool step_is_written = by_times() || from->step % scenario.record_every == 0;
    first_ = from->step + (step_is_written ? 1 : 0);
    last_ = step_is_written ? from->step : -1;
    written_ = static_cast<std::size_t>(
        std::upper_bound(scenario.record_steps.begin(), scenario.record_steps.end(), from->step) -
        scenario.record_steps.begin());
  }
  if (folder.empty() || wants("h5")) {
    RunDescription description = description_of(scenario, static_cast<std::size_t>(sample_count(scenario)));
    description.identity = identity;
    if (from == nullptr) {
      rows_.emplace(description);
    } else {
      rows_.emplace(description, RowCounts{from->rows, from->section_rows, from->wall_rows, from->event_rows});
    }
    if (!folder.empty()) h5_ = std::make_unique<RunFile>(folder / "run.h5", description, *rows_);
  }
  if (!folder.empty() && wants("csv")) {
    const std::filesystem::path file = folder / "trajectory.csv";
    csv_ = from == nullptr ? std::make_unique<CsvFile>(file, scenario.start_q.size(), csv_columns(scenario))
                           : std::make_unique<CsvFile>(file, from->csv_bytes, from->csv_hash);
  }
}

std::int64_t Recorder::next_due(std::int64_t step) const {
  step = std::max(step, first_);
  if (by_times()) {
    const auto next = std::lower_bound(scenario_.record_steps.begin(), scenario_.record_steps.end(), step);
    return next == scenario_.record_steps.end() ? never : *next;
  }
  const std::int64_t every = scenario_.record_every;
  const std::int64_t next = step % every == 0 ? step : step + (every - step % every);
  return step <= scenario_.steps ? std::min(next, scenario_.steps) : never;
}

std::span<const std::string> Recorder::times(std::int64_t step) const {
  const auto [begin, end] = std::equal_range(scenario_.record_steps.begin(), scenario_.record_steps.end(), step);
  return std::span(scenario_.record)
      .subspan(static_cast<std::size_t>(begin - scenario_.record_steps.begin()), static_cast<std::size_t>(end - begin));
}

Verdict Recorder::observe(const Frame& frame) {
  const bool is_for_the_end = !by_times() && frame.step % scenario_.record_every != 0;
  if (is_for_the_end) before_the_end_ = sizes();
  const std::vector<double> observables = observable_values(scenario_, frame);
  if (rows_) rows_->append(frame, observables);
  if (h5_) h5_->flush_if_many();
  if (csv_) csv_->append(frame, observables);
  if (!is_for_the_end) restart_range_();  // a longer run would not have this sample, so it continues the range
  last_ = frame.step;
  ++written_;
  return Verdict::go_on;
}

void Recorder::append(const SectionPoint& point) {
  if (!rows_) return;
  rows_->append(point);
  if (h5_) h5_->flush_if_many();
}

void Recorder::append(const Bounce& bounce) {
  if (!records_more_bounces()) return;
  rows_->append(bounce);
  if (h5_) h5_->flush_if_many();
}
bool Recorder::records_more_bounces() const {
  return rows_ && rows_->bounce_rows() < static_cast<std::uint64_t>(scenario_.record_events);
}

void Recorder::append(std::size_t event, std::int64_t step, const SectionPoint& point) {
  const auto most = static_cast<std::uint64_t>(scenario_.record_events);
  if (!rows_ || rows_->event_rows(event) >= most) return;
  rows_->append(event, step, point);
  if (h5_) h5_->flush_if_many();
}

void Recorder::finish(const Simulation& simulation) {
  if (!by_times() && last_ != simulation.step()) {
    Frame frame;
    simulation.look(frame);
    (void)observe(frame);
  }
  flush();
}

void Recorder::flush() {
  if (h5_) h5_->flush();
  if (csv_) csv_->flush();
}

void Recorder::flush_if_due() {
  if (h5_) h5_->flush_if_due();
}

Recorder::Sizes Recorder::sizes() const {
  return {rows_ ? rows_->counts().samples : 0, csv_ ? csv_->bytes() : 0, csv_ ? csv_->hash() : 0};
}

void Recorder::mark(Checkpoint& checkpoint) {
  flush();
  if (h5_) force_to_disk(folder_ / "run.h5");
  if (csv_) force_to_disk(folder_ / "trajectory.csv");
  const Sizes now = before_the_end_.value_or(sizes());
  checkpoint.rows = now.rows;
  const RowCounts counts = rows_ ? rows_->counts() : RowCounts{};
  checkpoint.section_rows = counts.section;  // section points do not depend on how the run continues
  checkpoint.wall_rows = counts.bounces;
  checkpoint.event_rows = counts.events;
  checkpoint.csv_bytes = now.csv_bytes;
  checkpoint.csv_hash = now.csv_hash;
}

std::optional<std::string> Recorder::failed_at(std::int64_t step) const {
  if (!by_times() || written_ >= scenario_.record.size() || scenario_.record_steps[written_] != step) return {};
  return scenario_.record[written_];
}

}  // namespace hamflow
