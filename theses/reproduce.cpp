#include "reproduce.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <fstream>
#include <mutex>
#include <new>
#include <sstream>
#include <thread>

#include "hamflow/core/error.hpp"
#include "hamflow/figures/stop_drawing.hpp"
#include "hamflow/workflow/sweep.hpp"
#include "report.hpp"
#include "shared_work.hpp"
#include "store.hpp"

namespace hamflow {

namespace {
namespace fs = std::filesystem;
using namespace reproduction;

constexpr const char* mark_of_begin = "begun.txt";

bool is_there(const fs::path& file) {
  std::error_code none;
  return fs::exists(file, none);
}

/// The output directory. Each experiment has its own folder in it, which is replaced when the experiment runs again.
const FolderKind& reproduction_folder() {
  static const FolderKind kind{
      .name = "reproduction", .signs = {"reproduction"}, .files = {}, .resumes_from = "reproduction"};
  return kind;
}

/// @throws FileError
WorkFolder prepared(const ReproduceRequest& request) {
  WorkFolder folder(request.folder, reproduction_folder(), request.existing);
  folder.prepare();
  std::error_code error;
  const bool has_shards = request.existing == Existing::resume && !shard_folders(request.folder).empty();
  if (!fs::is_empty(request.folder, error) && !is_there(folder / "reproduction") && !has_shards) {
    throw FileError("found in " + request.folder.string() +
                    " no reproduction; allowed the folder of one, or a new one");
  }
  fs::create_directories(folder / "reproduction", error);
  if (error) throw FileError("cannot make the folder " + request.folder.string() + ": " + error.message());
  return folder;
}

/// Removes the folder of an experiment. The file mark_of_begin shows that the folder belongs to hamflow. A folder
/// without it may be removed if it is empty or has a partly written mark, as after a kill. The mark is therefore
/// removed last.
void clear(const fs::path& folder) {
  std::error_code error;
  if (is_there(folder) && !is_there(folder / mark_of_begin)) {
    for (const auto& entry : fs::directory_iterator(folder, error)) {
      if (entry.path().filename().string().find(mark_of_begin) == std::string::npos) {
        throw FileError("found the folder " + folder.string() + ", which is not hamflow's; allowed --out another");
      }
    }
  }
  std::vector<fs::path> all;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().filename() != mark_of_begin) all.push_back(entry.path());
  }
  all.push_back(folder);  // removes the mark, too
  for (const fs::path& one : all) {
    fs::remove_all(one, error);
    if (error) throw FileError("cannot remove " + one.string() + ": " + error.message());
  }
}

fs::path folder_of(const fs::path& reproduction, const std::string& id) { return reproduction / "reproduction" / id; }

/// Reads a finished experiment of any size from its folder.
std::optional<ExperimentReport> done_in(const fs::path& folder, const Experiment& experiment) {
  auto done = read_stored_experiment(experiment, folder);
  if (!done) return {};
  return ExperimentReport{.info = experiment.info,
                          .status = "done",
                          .claims = std::move(done->kept.claims),
                          .extent = done->extent,
                          .seconds = done->kept.seconds,
                          .was_done = true};
}

void move(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) throw FileError("cannot move " + from.string() + " to " + to.string() + ": " + error.message());
}

/// Copies a finished experiment from the folder of a shard, in the largest size that any shard has.
void take_from_shards(const fs::path& reproduction, const fs::path& folder, const Experiment& experiment) {
  std::optional<WorkExtent> largest;
  fs::path source;
  for (const fs::path& shard : shard_folders(reproduction)) {
    const fs::path found = folder_of(shard, experiment.info.id);
    const auto done = done_in(found, experiment);
    if (!done || (largest && done->extent <= *largest)) continue;
    largest = done->extent;
    source = found;
  }
  const auto own = done_in(folder, experiment);
  if (!largest || (own && own->extent >= *largest)) return;
  const fs::path copy = folder.string() + ".copy";  // so that a kill does not leave an incomplete folder in its place
  clear(copy);
  std::error_code error;
  fs::create_directories(copy, error);
  if (!error) fs::copy_file(source / mark_of_begin, copy / mark_of_begin, error);
  if (!error) fs::copy(source, copy, fs::copy_options::recursive | fs::copy_options::skip_existing, error);
  if (error) throw FileError("cannot copy " + source.string() + " to " + copy.string() + ": " + error.message());
  clear(folder);
  move(copy, folder);
}

std::string contents_of(const fs::path& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// Prepares the folder of an experiment. If the same experiment was killed, the folder is kept, so that long runs
/// resume.
void begin_in(const fs::path& folder, const std::string& print, bool resume) {
  const fs::path mark = folder / mark_of_begin;
  if (resume && contents_of(mark) == print) return;
  clear(folder);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw FileError("cannot make the folder " + folder.string() + ": " + error.message());
  write_text(mark, print);
}

class Run {
 public:
  Run(const ReproduceRequest& request, const std::function<bool(std::size_t, std::size_t)>& pulse)
      : request_(request), pulse_(pulse), reports_(request.ids.size()), shared_(number_of_threads()) {}

  ReproduceReport all() {
    std::vector<std::thread> others;
    for (std::size_t i = 1; i < number_of_threads(); ++i) {
      try {
        others.emplace_back([this] { work(); });
      } catch (const std::exception&) {  // the system has no more threads; fewer give the same results
        shared_.reduce_threads(number_of_threads() - i);
        break;
      }
    }
    work();
    for (std::thread& other : others) other.join();
    if (out_of_memory_) throw std::bad_alloc();
    if (!trouble_.empty())
      throw FileError(trouble_ + "; what is done stays, and the same command with --resume goes on");
    return finished();
  }

 private:
  std::size_t number_of_threads() const { return static_cast<std::size_t>(std::max(request_.threads, 1)); }

  bool go_on() {
    if (stopped_) return false;
    const std::lock_guard one(mutex_);
    if (pulse_ && !pulse_(done_, reports_.size())) stopped_ = true;
    return !stopped_;
  }
  /// Runs experiments until none is left, in reverse order: the long ones are at the end of the list, and should not
  /// start last. The order of the reports does not depend on threads.
  void work() {
    const figures::StopDrawingScope asks([this] { return go_on(); });
    for (std::size_t taken = next_++; taken < reports_.size(); taken = next_++) {
      const std::size_t i = reports_.size() - 1 - taken;
      try {
        reports_[i] = carried_out(experiment_of(request_.ids[i]));
      } catch (const std::bad_alloc&) {
        out_of_memory_ = true;
        stopped_ = true;
      } catch (const std::exception& error) {  // files cannot be written, so no further result can be kept
        const std::lock_guard one(mutex_);
        if (trouble_.empty()) trouble_ = error.what();
        stopped_ = true;
      }
      ++done_;
    }
    shared_.help();
  }
  ExperimentReport carried_out(const Experiment& experiment) {
    ExperimentReport report{.info = experiment.info, .status = "done", .extent = request_.extent};
    const fs::path folder = folder_of(request_.folder, experiment.info.id);
    const fs::path beside = folder.string() + ".next";  // for a larger size, so that a smaller result is kept meanwhile
    const std::string print = fingerprint(experiment, request_.extent);
    bool keeps_smaller_result = false;
    if (request_.existing == Existing::resume) {
      take_from_shards(request_.folder, folder, experiment);
      auto done = done_in(folder, experiment);
      // The program was killed before the larger size replaced the smaller one.
      if (!done && (!is_there(folder) || done_in(beside, experiment)) && is_there(beside)) {
        clear(folder);
        move(beside, folder);
        done = done_in(folder, experiment);
      }
      keeps_smaller_result = done && done->extent < request_.extent;
      // A result of a larger size serves for this size, too.
      if (done && !keeps_smaller_result) return *std::move(done);
    }
    if (!go_on()) {
      report.status = "interrupted";
      return report;
    }
    const auto begin = std::chrono::steady_clock::now();
    const fs::path place = keeps_smaller_result ? beside : folder;
    if (!keeps_smaller_result) clear(beside);
    begin_in(place, print, request_.existing == Existing::resume);
    Study study(
        experiment.info, request_.extent, [this] { return go_on(); }, place, shared_);
    try {
      experiment.carry_out(study);
      report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      keep(place, study, print, report.seconds);
      if (keeps_smaller_result) {
        clear(folder);
        move(beside, folder);
      }
      report.claims = study.claims();
    } catch (const StudyInterrupted&) {
      report.status = "interrupted";
    } catch (const figures::DrawingStopped&) {
      report.status = "interrupted";
    } catch (const FileError&) {
      throw;
    } catch (const std::bad_alloc&) {  // not a failure of the experiment
      throw;
    } catch (const std::exception& error) {
      report.status = "failed";
      report.message = error.what();
    }
    return report;
  }

  ReproduceReport finished() {
    ReproduceReport report{.status = "done", .experiments = reports_};
    for (const ExperimentReport& one : reports_) {
      if (one.status == "interrupted") report.status = "interrupted";
    }
    if (report.status == "done" && std::any_of(reports_.begin(), reports_.end(),
                                               [](const ExperimentReport& one) { return one.status == "failed"; })) {
      report.status = "failed";
    }
    report.json = verdicts_json(report);
    report.text = verdicts_text(report);
    const ReproduceReport whole = with_others(report);
    write_text(request_.folder / "verdicts.json", verdicts_json(whole));
    write_text(request_.folder / "index.html", page_of(whole, request_.folder));
    return report;
  }

  /// Adds the experiments that are finished in the folder to the requested ones.
  ReproduceReport with_others(const ReproduceReport& asked) const {
    ReproduceReport whole{.status = asked.status};
    for (const Experiment& experiment : all_experiments()) {
      const auto same = [&](const ExperimentReport& one) { return one.info.id == experiment.info.id; };
      const auto found = std::find_if(asked.experiments.begin(), asked.experiments.end(), same);
      // An experiment that did not run may be stored in a smaller size.
      if (found != asked.experiments.end() && found->status == "done") {
        whole.experiments.push_back(*found);
      } else if (auto done = done_in(folder_of(request_.folder, experiment.info.id), experiment)) {
        whole.experiments.push_back(*std::move(done));
      } else if (found != asked.experiments.end()) {
        whole.experiments.push_back(*found);
      }
    }
    return whole;
  }

  const ReproduceRequest& request_;
  const std::function<bool(std::size_t, std::size_t)>& pulse_;
  std::vector<ExperimentReport> reports_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<std::size_t> done_ = 0;
  std::atomic<bool> stopped_ = false;
  std::atomic<bool> out_of_memory_ = false;
  std::mutex mutex_;
  SharedWork shared_;
  std::string trouble_;
};

}  // namespace

std::optional<ExperimentReport> stored_experiment(const fs::path& folder, const std::string& id) {
  const Experiment& experiment = experiment_of(id);
  if (!is_there(folder / "reproduction")) {
    throw FileError("found in " + folder.string() + " no reproduction; allowed the folder of one");
  }
  return done_in(folder_of(folder, id), experiment);
}

ReproduceReport reproduce(const ReproduceRequest& request,
                          const std::function<bool(std::size_t done, std::size_t all)>& pulse) {
  const WorkFolder folder = prepared(request);
  return Run(request, pulse).all();
}

}  // namespace hamflow
