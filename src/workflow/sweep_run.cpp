#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "hamflow/core/text.hpp"
#include "hamflow/detail/core/option_names.hpp"
#include "hamflow/workflow/sweep.hpp"
#include "measures/measures.hpp"
#include "run_keys.hpp"
#include "summary.hpp"
#include "sweep_figure.hpp"
#include "sweep_folder.hpp"
#include "sweep_report.hpp"
#include "sweep_shards.hpp"
#include "sweep_table.hpp"
#include "toml_path.hpp"
#include "warnings.hpp"

namespace hamflow {

namespace {

namespace fs = std::filesystem;

LaneSet lanes_named(const std::string& name) {
  for (const LaneSet set : {LaneSet::none, LaneSet::generic, LaneSet::avx2, LaneSet::avx512}) {
    if (name == hamflow::name(set) && set <= widest_lanes()) return set;
  }
  if (name.empty() || name == "auto") return widest_lanes();
  std::vector<std::string> allowed{"auto", "none", "generic"};
  if (widest_lanes() >= LaneSet::avx2) allowed.emplace_back("avx2");
  if (widest_lanes() >= LaneSet::avx512) allowed.emplace_back("avx512");
  throw Error("found \"" + name + "\"; allowed on this machine: " + joined(allowed) + suggestion(name, allowed));
}

/// Returns whether a key only decides what a single run writes, and when.
bool belongs_to_single_runs(const std::string& path) {
  const RunKeys& keys = run_keys();
  const std::vector<std::string> all{output_table, run_path(keys.checkpoint_every), run_path(keys.record_every),
                                     run_path(keys.record), run_path(keys.certificate)};
  return std::any_of(all.begin(), all.end(),
                     [&](const std::string& key) { return is_part_of_other(key, path) && path.size() >= key.size(); });
}

/// Returns whether a key decides which columns, or which section, the table of a sweep has.
bool decides_columns(const std::string& path) {
  const RunKeys& keys = run_keys();
  for (const OptionInfo& key : {keys.lyapunov, keys.eigenvalues, keys.section}) {
    if (is_part_of_other(run_path(key), path)) return true;
  }
  return false;
}

/// For a gas, adds one warning with the number of finished members in which particles may have passed through each
/// other. Its details are those of the first such member.
void add_passing_particles(const Sweep& sweep, const SweepRequest& request, std::vector<Warning>& warnings) {
  if (!sweep.common().problem->particles) return;
  MemberReader reader(sweep.varied(), request.text, request.name, request.sets);
  std::size_t count = 0;
  std::size_t first = 0;
  std::string first_warning;
  for (std::size_t member = 0; member < sweep.members(); ++member) {
    const MemberRow& row = sweep.rows()[member];
    if (row.status != Outcome::done || row.nonsense || row.steps == 0) continue;
    const Reading reading = reader.read(member);
    if (!reading.scenario) continue;
    const Scenario& scenario = *reading.scenario;
    Frame start, end;
    start.q = scenario.start_q;
    start.p = scenario.start_p;
    end.q = row.q;
    end.p = row.p;
    std::string why = passing_in_a_step(scenario.request, *scenario.problem, scenario.dt, start, end);
    if (why.empty()) continue;
    if (count++ == 0) first = member;
    if (first_warning.empty()) first_warning = std::move(why);
  }
  if (count == 0) return;
  warnings.push_back({"long_step", fmt::format("in {} of {} members, first in member {}, {}", count, sweep.members(),
                                               first, first_warning)});
}

/// Reads the varied keys. Errors in the request other than those of the scenario are added to `wrong`.
Varied varied_of(const SweepRequest& request, SweepOptions& how, std::vector<Complaint>& wrong) {
  std::vector<Vary> varied;
  const auto complain = [&](const char* option, std::string message) {
    wrong.push_back({"", 0, 0, option_name(option), std::move(message)});
  };
  if (request.varied.empty()) complain("vary", "missing; allowed PATH=a:b:n, PATH=v1,v2,... or PATH=FORMULA");
  if (request.threads < 0 || request.threads > most_sweep_threads) {
    complain("threads", "found " + std::to_string(request.threads) + "; allowed 1 to " +
                            std::to_string(most_sweep_threads) + ", 0 for all");
  }
  const auto try_to = [&](const char* option, const auto& action) {
    try {
      action();
    } catch (const Error& error) {
      complain(option, error.what());
    }
  };
  // The values of a range take memory, so they are counted before they are made.
  double members = 1;
  for (const std::string& vary : request.varied) members *= static_cast<double>(count_of_range(vary));
  if (!request.zip && members > static_cast<double>(most_members)) {
    complain("vary", "found more than 10000000 members; allowed fewer values for each key");
    return {};
  }
  for (const std::string& vary : request.varied) {
    try_to("vary", [&] { varied.push_back(parse_vary(vary)); });
  }
  for (const Vary& vary : varied) {
    if (decides_columns(vary.path)) {
      complain("vary", "found " + vary.path + ", which must be the same for all members; allowed " +
                           set_option(vary.path, "...") + ", with a sweep for each value");
    }
    if (!belongs_to_single_runs(vary.path)) continue;
    complain("vary",
             "found " + vary.path +
                 (is_part_of_other(output_path(output_keys().observables), vary.path)
                      ? ", which must be the same for all members; allowed " + set_option(vary.path, "...") + ", "
                      : ", which does not change the results of a sweep; allowed ") +
                 "keys of [problem], [method] and the others of [run]");
  }
  for (std::size_t i = 0; i < varied.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (varied[i].path == varied[j].path) {
        complain("vary", "found " + varied[i].path + " twice");
      } else if (is_part_of_other(varied[i].path, varied[j].path)) {
        complain("vary", "found " + varied[j].path + " and " + varied[i].path +
                             ", of which one replaces the other; allowed one of them");
      }
    }
    for (const std::string& set : request.sets) {
      const std::string path = parsed_set(set).first;
      if (!is_part_of_other(path, varied[i].path) || path.size() < varied[i].path.size()) continue;
      complain("set", "found " + path + ", which " + option_name("vary") + " " + varied[i].path +
                          " replaces; allowed one of them");
    }
  }
  Varied all;
  if (wrong.empty()) {
    try_to(request.zip ? "zip" : "vary", [&] { all = Varied(std::move(varied), request.zip); });
  }
  try_to("lanes", [&] { how.lanes = lanes_named(request.lanes); });
  return all;
}

}  // namespace

class ScenarioSweep::Impl {
 public:
  explicit Impl(const SweepRequest& asked) : request(asked) {
    SweepOptions how{.shard = request.shard, .threads = request.threads};
    Varied varied = varied_of(request, how, complaints);
    if (!complaints.empty()) return;
    how.observables_of = sweep_columns;
    how.is_meaningless = [](const Scenario& scenario, const MemberRow& row) {
      Frame end;
      end.q = row.q;
      end.p = row.p;
      return is_energy_meaningless(scenario, row.energy, end);
    };
    sweep.emplace(request.text, request.name, request.sets, std::move(varied), how);
    complaints = sweep->complaints();
    if (!complaints.empty()) return;
    notes = sweep->notes();
    const Scenario& common = sweep->common();
    if (!common.folder.empty())
      notes.push_back(output_path(output_keys().folder) + " is not used: " + option_name("out") +
                      " gives the folder of a sweep");
    if (!common.figures.empty())
      notes.push_back(output_path(output_keys().figures) + " is not used: " + option_name("figure") +
                      " draws the figure of a sweep");
  }

  SweepRequest request;
  std::vector<Complaint> complaints;
  std::vector<std::string> notes;
  std::optional<Sweep> sweep;
  std::optional<SweepFolder> folder;
  std::chrono::steady_clock::time_point begin = std::chrono::steady_clock::now();
  bool stopped = false;
};

ScenarioSweep::ScenarioSweep(const SweepRequest& request) : impl_(std::make_unique<Impl>(request)) {}
ScenarioSweep::~ScenarioSweep() = default;
const std::vector<Complaint>& ScenarioSweep::complaints() const { return impl_->complaints; }
const std::vector<std::string>& ScenarioSweep::notes() const { return impl_->notes; }
std::int64_t ScenarioSweep::total_steps() const { return impl_->sweep->total_steps(); }
std::int64_t ScenarioSweep::steps_before() const { return impl_->sweep->steps_before(); }

void ScenarioSweep::check_figure(const fs::path& file, const std::string& column, bool mean) const {
  (mean ? check_mean_figure : check_sweep_figure)(*impl_->sweep, file, column);
}

SweepReport ScenarioSweep::run(const std::function<bool(std::int64_t)>& pulse) {
  std::optional<SweepFolder>& folder = impl_->folder;
  bool& stopped = impl_->stopped;
  impl_->begin = std::chrono::steady_clock::now();
  if (folder) folder->begin();
  const auto look = [&](std::int64_t steps) {
    if (pulse && !pulse(steps)) stopped = true;
    if (folder && !stopped) folder->save_if_due();
    return !stopped;
  };
  const auto keep = [&](std::size_t member) { folder->keep(member); };
  impl_->sweep->run(look, folder ? keep : std::function<void(std::size_t)>{});
  return report();
}

std::vector<std::byte> ScenarioSweep::finished_members() const {
  const Sweep& sweep = *impl_->sweep;
  StoredSweep past{.head = head_of(sweep, impl_->request)};
  for (std::size_t member = impl_->request.shard.index; member < sweep.members();
       member += impl_->request.shard.count) {
    const MemberRow& row = sweep.rows()[member];
    if (row.is_finished()) past.members.emplace(member, FinishedMember{sweep.steps_of(member), 0, row});
  }
  return journal_bytes(past);
}

void ScenarioSweep::take(std::span<const std::byte> finished_members) {
  Sweep& sweep = *impl_->sweep;
  StoredSweep past = journal_in(finished_members, "the result of a shard");
  const SweepIdentity own = head_of(sweep, impl_->request);
  if (past.head.version != own.version) {
    throw Error("found members computed by hamflow " + past.head.version + "; allowed hamflow " + own.version +
                ", since results can depend on the version");
  }
  if (past.head.varied != own.varied || past.head.in_step != own.in_step) {
    throw Error("found members of another sweep; allowed members with the same scenario and the same varied keys");
  }
  for (auto& [member, finished] : past.members) {
    if (member >= sweep.members() || finished.steps != sweep.steps_of(member)) {
      throw Error("found member " + std::to_string(member) + " of another sweep");
    }
    if (sweep.rows()[member].is_finished()) continue;
    sweep.restore(member, std::move(finished.row));
    if (impl_->folder) impl_->folder->keep(member);
  }
}

SweepReport ScenarioSweep::report() {
  Sweep& sweep = *impl_->sweep;
  std::optional<SweepFolder>& folder = impl_->folder;
  const double seconds = folder
                             ? folder->seconds()
                             : std::chrono::duration<double>(std::chrono::steady_clock::now() - impl_->begin).count();
  SweepReport report;
  SweepSummary& summary = report.summary;
  summary = sweep_summary(sweep, seconds, impl_->stopped || sweep.members_left() > 0, !folder);
  add_passing_particles(sweep, impl_->request, summary.warnings);
  report.status = summary.status;
  report.json = sweep_json(summary, false);
  report.text = sweep_text(summary);
  report.warnings = warning_lines(summary.warnings);
  for (const MemberFailure& failure : summary.failures) {
    // Members without a start are often many, so they are listed only if no member has a start.
    if (failure.kind == "no_start" && summary.no_start != summary.members) continue;
    report.failures.push_back(fmt::format("member {}, step {}: {}", failure.member, failure.step, failure.message));
    if (report.hint.empty() && failure.kind == name(Outcome::not_converged)) {
      report.hint = hint_for(sweep.common().request, differentiates_steps(sweep.common()), Outcome::not_converged,
                             failure.message);
    }
  }
  if (folder) folder->save(report.json);
  return report;
}

std::vector<Complaint> ScenarioSweep::keep_in(const fs::path& folder, Existing existing) {
  impl_->folder.emplace(*impl_->sweep, impl_->request, folder, existing);
  const std::vector<std::string>& notes = impl_->folder->notes();
  impl_->notes.insert(impl_->notes.end(), notes.begin(), notes.end());
  return impl_->folder->wrong();
}

std::vector<std::string> ScenarioSweep::missing_shards() const {
  if (!impl_->folder) return {};
  std::vector<bool> is_finished;
  for (const MemberRow& row : impl_->sweep->rows()) is_finished.push_back(row.is_finished());
  return hamflow::missing_shards(impl_->folder->path(), is_finished);
}

Table ScenarioSweep::members() const { return members_of(*impl_->sweep); }
Table ScenarioSweep::sections() const { return sections_of(*impl_->sweep); }

void ScenarioSweep::draw(const fs::path& file, const std::string& column, bool mean) const {
  (mean ? draw_mean_figure : draw_sweep_figure)(*impl_->sweep, file, column);
}

}  // namespace hamflow
