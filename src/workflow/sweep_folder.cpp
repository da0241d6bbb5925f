#include "sweep_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "hamflow/detail/core/option_names.hpp"
#include "resume.hpp"
#include "run_description.hpp"
#include "sweep_shards.hpp"
#include "sweep_table.hpp"

namespace hamflow {

namespace {

namespace fs = std::filesystem;
/// Returns the differences from the sweep in the folder that forbid resuming.
std::vector<Complaint> differences_of(const Sweep& sweep, const SweepIdentity& now, const SweepIdentity& before) {
  Checkpoint began;
  began.version = before.version;
  began.keys = before.keys;
  began.values = before.values;
  std::vector<Complaint> all = differences(sweep.common(), began);
  const auto complain = [&](const std::string& option, const std::string& found, const std::string& allowed) {
    all.push_back({"", 0, 0, option,
                   "found " + found + "; allowed with " + option_name("resume") + " " + allowed +
                       ", as when the sweep began" + advice_to_overwrite()});
  };
  for (std::size_t i = 0; i < std::max(now.varied.size(), before.varied.size()); ++i) {
    const std::string found = i < now.varied.size() ? now.varied[i] : "no further key";
    const std::string allowed = i < before.varied.size() ? before.varied[i] : "no further key";
    if (found != allowed) complain(option_name("vary"), found, allowed);
  }
  const auto name = [](bool in_step) { return (in_step ? "" : "no ") + option_name("zip"); };
  if (now.functions != before.functions) {
    all.push_back({"", 0, 0, option_name("resume"),
                   "found members computed on a machine whose C library gives other last bits of sin, exp and others; "
                   "allowed members of machines that agree with this one" +
                       advice_to_overwrite()});
  }
  if (now.in_step != before.in_step) complain(option_name("zip"), name(now.in_step), name(before.in_step));
  return all;
}

}  // namespace

SweepIdentity head_of(const Sweep& sweep, const SweepRequest& request) {
  const Checkpoint of_scenario = first_checkpoint(sweep.common(), "");
  return {.version = of_scenario.version,
          .keys = of_scenario.keys,
          .values = of_scenario.values,
          .varied = request.varied,
          .in_step = request.zip,
          .functions = functions_of_this_machine(),
          .text = request.text,
          .name = request.name,
          .sets = request.sets};
}

SweepFolder::SweepFolder(Sweep& sweep, const SweepRequest& request, fs::path folder, Existing existing)
    : sweep_(sweep), folder_(folder_of(request.shard, folder), sweep_folder(), existing) {
  StoredSweep past;
  past.head = head_of(sweep, request);
  if (existing == Existing::replace && request.shard.count == 1 && !shard_journals(folder).empty()) {
    throw FileError("found shards of a sweep in " + folder.string() + ", which " + option_name("force") +
                    " does not replace; remove them, or give another " + option_name("out"));
  }
  if (folder_.resumes()) {
    StoredSweep found = read_journal(folder_ / members_file);
    wrong_ = differences_of(sweep, past.head, found.head);
    if (!wrong_.empty()) return;
    past.members = std::move(found.members);
    restore(past);
  }
  if (existing == Existing::resume) take_others(past.head, folder);
  if (!wrong_.empty()) return;
  note_progress();
  if (request.shard.count == 1) {  // the journal of the whole sweep is the union of all
    for (std::size_t member = 0; member < sweep_.members(); ++member) {
      const MemberRow& row = sweep_.rows()[member];
      if (row.is_finished())
        past.members.try_emplace(member, FinishedMember{sweep_.steps_of(member), seconds_before_, row});
    }
  }
  if (folder_.resumes()) folder_.remove("summary.json");  // belongs to the part before
  folder_.prepare(sweep_.common());
  journal_.emplace(folder_ / members_file, past);
}

/// Restores members that are finished in other journals of the sweep, of other shards or of the whole.
void SweepFolder::take_others(const SweepIdentity& head, const fs::path& whole) {
  std::vector<fs::path> journals = shard_journals(whole);
  journals.push_back(whole / members_file);
  for (const fs::path& file : journals) {
    if (file == folder_ / members_file || !fs::exists(file)) continue;
    StoredSweep found = read_journal(file);
    if (!differences_of(sweep_, head, found.head).empty()) {
      throw FileError(file.string() +
                      " belongs to another sweep; allowed shards of one scenario with the same varied "
                      "keys, computed by one version of hamflow");
    }
    for (auto& [member, finished] : found.members) {
      if (member >= sweep_.members()) throw FileError(file.string() + " belongs to another sweep");
      const bool is_new = sweep_.is_own(member) && !sweep_.rows()[member].is_finished();
      if (!is_new || finished.steps != sweep_.steps_of(member)) continue;
      seconds_before_ = std::max(seconds_before_, finished.seconds);
      sweep_.restore(member, std::move(finished.row));
    }
  }
}

/// Restores finished members of this folder's journal. Those that were finished with another number of steps are run
/// again from the start.
void SweepFolder::restore(StoredSweep& past) {
  std::size_t shorter = 0;
  for (const auto& [member, finished] : past.members) {
    seconds_before_ = std::max(seconds_before_, finished.seconds);
    if (member >= sweep_.members()) throw FileError(folder_.path().string() + ": members.bin belongs to another sweep");
    if (finished.steps != sweep_.steps_of(member)) ++shorter;
  }
  std::erase_if(past.members, [&](const auto& each) { return each.second.steps != sweep_.steps_of(each.first); });
  for (const auto& [member, finished] : past.members) sweep_.restore(member, finished.row);
  if (shorter > 0) {
    notes_.push_back(fmt::format("{} members had another number of steps; they are run again", shorter));
  }
}

void SweepFolder::note_progress() {
  const std::size_t left = sweep_.members_left();
  if (!folder_.resumes() && left == sweep_.own_members()) {
    if (!folder_.note().empty()) notes_.push_back(folder_.note());
  } else if (left == 0) {
    notes_.emplace_back("the sweep is complete already; there is nothing to do");
  } else {
    notes_.push_back(fmt::format("{} of {} members are finished already or have no start", sweep_.own_members() - left,
                                 sweep_.own_members()));
  }
}

double SweepFolder::seconds() const {
  return seconds_before_ + std::chrono::duration<double>(Clock::now() - begin_).count();
}

void SweepFolder::keep(std::size_t member) {
  journal_->append(member, {sweep_.steps_of(member), seconds(), sweep_.rows()[member]});
  table_is_outdated_ = true;
}

void SweepFolder::save_if_due() {
  const Clock::time_point now = Clock::now();
  if (failed_ || !table_is_outdated_ || now - last_ < pause_) return;
  table_is_outdated_ = false;
  try {
    if (sweep_.shard().count > 1) {
      journal_->force();
    } else {
      auto hold = sweep_.hold_rows();
      const SweepTables tables = tables_of(sweep_);
      hold.unlock();
      write_table(tables);
    }
  } catch (const std::exception&) {  // for example a full disk or too little memory; the sweep itself continues
    failed_ = true;
  }
  last_ = Clock::now();
  pause_ = std::max<Clock::duration>(std::chrono::milliseconds(250), 20 * (last_ - now));
}

void SweepFolder::write_table(const SweepTables& tables) const {
  journal_->force();
  const std::vector<std::string>& formats = sweep_.common().formats;
  const auto is_wanted = [&](const char* format) {
    return std::find(formats.begin(), formats.end(), format) != formats.end();
  };
  if (is_wanted("h5")) write_sweep_h5(folder_ / "sweep.h5", sweep_, tables, {HAMFLOW_VERSION, host_name()});
  if (is_wanted("csv")) write_sweep_csv(folder_.path(), tables);
}

void SweepFolder::save(const std::string& summary) {
  if (sweep_.shard().count == 1) {
    write_table(tables_of(sweep_));
  } else {
    journal_->force();  // the table is written when all shards are merged
  }
  folder_.write("summary.json", summary);
}

}  // namespace hamflow
