// Reads and checks the members of a sweep, and groups those that can share a block.
#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include "hamflow/core/stop_question.hpp"
#include "hamflow/detail/core/hash.hpp"
#include "hamflow/detail/core/option_names.hpp"
#include "hamflow/run/walls.hpp"
#include "memory.hpp"
#include "on_threads.hpp"
#include "sweep.hpp"

namespace hamflow {

namespace {
/// Returns whether `part` is the key itself or a part of it, such as problem.initial.q[0] of problem.initial.
bool is_key_or_part_of(const std::string& key, const std::string& part) {
  return part.starts_with(key) && (part.size() == key.size() || part[key.size()] == '.' || part[key.size()] == '[');
}
}  // namespace

Sweep::Sweep(const std::string& text, const std::string& name, const std::vector<std::string>& sets, Varied varied,
             SweepOptions options)
    : varied_(std::move(varied)), options_(std::move(options)), raw_text_(text), name_(name), sets_(sets) {
  MemberReader reader(varied_, text, name, sets);
  text_ = reader.family().text();
  complaints_ = reader.family().complaints();
  if (!complaints_.empty()) return;
  if (const std::string wrong = refused_members(own_members(), coordinates_of_first(reader), available_memory());
      !wrong.empty()) {
    complaints_.push_back({"", 0, 0, option_name("vary"), wrong});
    return;
  }
  rows_.resize(own_members());
  starts_.resize(rows_.size());
  steps_.resize(rows_.size());
  names_ = SweepNames(members());
  threads_ = options_.threads > 0 ? options_.threads : static_cast<int>(processors());
  threads_ = std::max(threads_, 1);
  read_members(name);
  common_.settings = reader.family().settings();
  common_.start_contents = start_contents_;
}

/// Returns 0 if the member cannot be read; a message follows later.
std::size_t Sweep::coordinates_of_first(MemberReader& reader) const {
  const Reading reading = reader.read(0);
  const std::optional<Scenario>& any = reading.scenario ? reading.scenario : reading.scenario_without_start;
  return any ? any->start_q.size() : 0;
}

void Sweep::read_members(const std::string& name) {
  std::atomic<std::size_t> next{0};
  constexpr std::size_t batch = 64;
  // Member 0 shows the settings that all members share, so every shard reads it.
  const std::size_t others = is_own(0) ? 0 : 1;
  const std::size_t count = rows_.size() + others;
  const auto member_at = [&](std::size_t k) { return k < others ? 0 : own_member(k - others); };
  const auto work = [&] {
    MemberReader reader(varied_, raw_text_, name, sets_);
    for (std::size_t begin = next.fetch_add(batch); begin < count; begin = next.fetch_add(batch)) {
      if (StopQuestion::stop_requested()) {  // only true on the caller's thread
        next = count;
        throw ReadingStopped();
      }
      for (std::size_t k = begin; k < std::min(begin + batch, count); ++k) {
        const std::size_t member = member_at(k);
        const Reading reading = reader.read(member);
        if (reading.scenario) {
          add(member, *reading.scenario);
        } else if (reading.scenario_without_start) {
          leave_without_start(member, reading);
        } else {
          add_complaints(member, reading, reader.paths());
        }
      }
    }
  };
  (void)on_threads(count > 4 * batch ? threads_ : 1, work);
  refuse_different_kinds();
  if (!found_.empty()) {
    report(found_);
    return;
  }
  for (auto& [key, group] : groups_) std::sort(group.members.begin(), group.members.end());
  merge_names();
}

/// Complains about the first member that differs from member 0, whatever the order in which threads read them.
void Sweep::refuse_different_kinds() {
  if (first_of_kind_.size() < 2) return;
  std::vector<std::size_t> firsts;
  for (const auto& [kind, first] : first_of_kind_) firsts.push_back(first);
  std::sort(firsts.begin(), firsts.end());
  found_[{"--vary", 0, 0, "problem",
          "found members with different problems or numbers of coordinates; allowed members with the same problem and "
          "size, because they share a table"}] = {firsts[1]};
}

MemberObservables Sweep::observables_of(const Scenario& scenario) const {
  return options_.observables_of ? options_.observables_of(scenario) : MemberObservables{};
}

/// Unites the names of all members, because the rows of a table have the same columns.
void Sweep::merge_names() {
  const SweepNames::NameConflict clash = names_.merge_all();
  if (clash.name.empty()) return;
  const auto part = [&](std::size_t i) {
    return std::to_string(clash.sizes[i]) + (clash.sizes[i] == 1 ? " number in " : " numbers in ") +
           varied_.described(clash.members[i]);
  };
  complaints_.push_back(
      {"--vary", 0, 0, "problem",
       "found " + clash.name + " of " + part(0) + ", and of " + part(1) +
           "; allowed invariants that have the same size in all members, because they share a table"});
}

void Sweep::add_complaints(std::size_t member, const Reading& reading, const std::vector<std::string>& paths) {
  const std::lock_guard lock(mutex_);
  for (Complaint complaint : reading.complaints) {
    complaint.message = varied_.as_typed(complaint.message, member);
    const bool of_vary = std::any_of(paths.begin(), paths.end(), [&](const std::string& path) {
      return is_key_or_part_of(path, complaint.key) || is_key_or_part_of(complaint.key, path);
    });
    if (complaint.line == 0) complaint.file = of_vary ? "--vary" : "--set";
    found_[complaint].push_back(member);
  }
}

void Sweep::leave_without_start(std::size_t member, const Reading& reading) {
  const MemberNames names(*reading.scenario_without_start, observables_of(*reading.scenario_without_start).names);
  const std::lock_guard lock(mutex_);
  keep_shared_settings(member, *reading.scenario_without_start);
  names_.add(member, names, names.key());
  if (!is_own(member)) return;
  rows_[place(member)].no_start = true;
  rows_[place(member)].message = reading.no_start;
}

void Sweep::report(const std::map<Complaint, std::vector<std::size_t>>& found) {
  constexpr std::size_t most = 10;
  std::vector<std::pair<std::size_t, Complaint>> all;
  for (const auto& [complaint, members] : found) {
    const std::size_t first = *std::min_element(members.begin(), members.end());
    all.emplace_back(first, complaint);
    if (members.size() >= rows_.size()) continue;
    all.back().second.message += " (" + varied_.described(first) +
                                 (members.size() > 1 ? "; " + std::to_string(members.size()) + " members" : "") + ")";
  }
  std::sort(all.begin(), all.end());
  for (std::size_t i = 0; i < std::min(all.size(), most); ++i) complaints_.push_back(all[i].second);
  if (all.size() > most) {
    complaints_.push_back({"", 0, 0, "", "and " + std::to_string(all.size() - most) + " more of this kind"});
  }
}

/// Members of one table are states of one problem. The other shared settings are taken from the first member with a
/// start.
void Sweep::keep_shared_settings(std::size_t member, const Scenario& scenario) {
  const bool has_start = !scenario.start_p.empty() && scenario.start_p.front() == scenario.start_p.front();
  const std::pair kind(scenario.problem->info.name, scenario.start_q.size());
  const auto [at, is_new] = first_of_kind_.try_emplace(kind, member);
  if (!is_new) at->second = std::min(at->second, member);
  const bool better = has_start == common_has_start_ ? member < common_member_ : has_start;
  if (common_.problem != nullptr && !better) return;
  common_ = scenario;
  common_member_ = member;
  common_has_start_ = has_start;
}

/// Keeps notes on keys that are not used. Their number is bounded by the number of methods and keys, not of members.
void Sweep::keep_notes(std::size_t member, const Scenario& scenario) {
  for (const std::string& note : scenario.notes) {
    // other notes contain numbers of the member
    if (!note.starts_with("method.") && !note.starts_with("problem.")) continue;
    const auto [at, is_new] = method_notes_.try_emplace(note, member);
    if (!is_new) at->second = std::min(at->second, member);
  }
}

std::vector<std::string> Sweep::notes() const {
  std::vector<std::string> all = common_.notes;
  std::vector<std::pair<std::size_t, std::string>> others;
  for (const auto& [note, member] : method_notes_) {
    if (std::find(all.begin(), all.end(), note) == all.end()) others.emplace_back(member, note);
  }
  std::sort(others.begin(), others.end());
  for (auto& [member, note] : others) all.push_back(std::move(note));
  return all;
}

void Sweep::add(std::size_t member, const Scenario& scenario) {
  const Request& request = scenario.request;
  const Parameters<double> parameters(request.parameters);
  ParameterShape shape;
  MemberStart start{scenario.start_q, scenario.start_p, {}, evaluate_number<double>(request.dt)};
  std::string key = request.problem + '\n' + request.method.name + '\n' + request.arithmetic;
  for (const auto& [option, value] : request.method.options) key += '\n' + option + '=' + value;
  for (const auto& [choice, value] : request.variant) key += '\n' + choice + '=' + value;
  if (request.walls) {
    key += '\n' + wall_rules()[static_cast<std::size_t>(request.walls->rule)] + ' ' + request.walls->strength + ' ' +
           request.walls->exponent;
    for (const Walls::Interval& wall : request.walls->intervals) {
      key += '\n' + wall.coordinate + ' ' + wall.min + ' ' + wall.max;
    }
  }
  for (const ParameterInfo& info : scenario.problem->info.parameters) {
    if (!parameters.has(info.name)) continue;
    const std::vector<double>& numbers = parameters.list(info.name);
    shape.emplace_back(info.name, numbers.size());
    start.parameters.insert(start.parameters.end(), numbers.begin(), numbers.end());
    key += '\n' + info.name + ' ' + std::to_string(numbers.size());
  }
  key += '\n' + std::to_string(scenario.steps);
  const MemberObservables observables = observables_of(scenario);
  const MemberNames names(scenario, observables.names);
  const std::string name_key = names.key();
  // observers in a block have the same kinds in each lane; members with events run without lanes
  key += '\n' + name_key;

  const std::lock_guard lock(mutex_);
  keep_shared_settings(member, scenario);
  keep_notes(member, scenario);
  if (scenario.start_contents) {  // the order of reading must not matter
    const std::array<std::uint64_t, 2> one{member, *scenario.start_contents};
    start_contents_ = start_contents_.value_or(0) ^ fnv1a(std::as_bytes(std::span(one)));
  }
  names_.add(member, names, name_key);
  if (!is_own(member)) return;
  auto [at, is_new] = groups_.try_emplace(key);
  Group& group = at->second;
  if (is_new) {
    arithmetics_.insert(request.arithmetic);
    beyond_double_ = beyond_double_ || digits_beyond_double(request.arithmetic) > 0;
    halves_steps_ = halves_steps_ || describe(request.method).halves_steps;
    group.request = request;
    group.shape = shape;
    group.steps = scenario.steps;
    group.observables = observables;
    group.has_section = scenario.section.has_value();
    const auto block = make_ensemble_block(request, options_.lanes);
    // Events, and section points within steps that bounce, are located on a simulation of the member alone.
    const bool sought = !scenario.events.empty() || (scenario.section && has_hard_walls(request));
    const bool alone = block == nullptr || sought;
    group.lanes = alone || !block->load(shape, {&start, 1}) ? 0 : block->lanes();
  }
  group.members.push_back(member);
  steps_[place(member)] = scenario.steps;
  total_steps_ += scenario.steps;
  if (group.lanes > 0) {
    ++in_lanes_;
    lane_count_ = std::max(lane_count_, group.lanes);
    starts_[place(member)] = std::move(start);
  }
}

}  // namespace hamflow
