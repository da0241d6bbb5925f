#include "map.hpp"

#include <emscripten.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "hamflow/detail/run/state_expression.hpp"
#include "hamflow/detail/verify/lyapunov.hpp"

namespace hamflow {

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

bool same_walls(const std::optional<Walls>& a, const std::optional<Walls>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  const auto same = [](const Walls::Interval& x, const Walls::Interval& y) {
    return x.coordinate == y.coordinate && x.min == y.min && x.max == y.max;
  };
  return a->rule == b->rule && a->strength == b->strength && a->exponent == b->exponent &&
         std::equal(a->intervals.begin(), a->intervals.end(), b->intervals.begin(), b->intervals.end(), same);
}

/// Whether two requests differ at most in start, parameters and step size.
bool same_kind(const Request& a, const Request& b) {
  return a.problem == b.problem && a.variant == b.variant && a.arithmetic == b.arithmetic &&
         a.method.name == b.method.name && a.method.options == b.method.options && same_walls(a.walls, b.walls);
}

/// The text of a number that a map can set without the reader: of the start, a parameter or the step size; null if the
/// path names none.
std::string* text_at(const std::string& path, Request& request) {
  const auto entry = [&](const std::string& list, std::vector<std::string>& texts) -> std::string* {
    for (std::size_t i = 0; path.starts_with(list) && i < texts.size(); ++i) {
      if (path == list + "[" + std::to_string(i) + "]") return &texts[i];
    }
    return nullptr;
  };
  if (path == "run.dt") return &request.dt;
  if (path == "problem.initial.energy" && !request.start.energy.empty()) return &request.start.energy;
  if (std::string* const q = entry("problem.initial.q", request.start.q)) return q;
  if (std::string* const p = entry("problem.initial.p", request.start.p)) return p;
  for (const char* const table : {"problem.parameters.", "problem."}) {
    if (!path.starts_with(table)) continue;
    const auto found = request.parameters.find(path.substr(std::string(table).size()));
    if (found != request.parameters.end()) return &found->second;
  }
  return nullptr;
}

}  // namespace

Map::Map(const std::string& text, const std::string& x, const std::string& y, std::string observable,
         std::int64_t steps)
    : varied_({parse_vary(y), parse_vary(x)}, false),
      reader_(varied_, text, "scenario", {}),
      observable_(std::move(observable)),
      steps_(steps) {
  constexpr std::array<const char*, 4> names{"lyapunov", "energy_error", "relative_energy_error", "bounces"};
  kind_ = static_cast<Kind>(std::find(names.begin(), names.end(), observable_) - names.begin());
  if (!reader_.family().complaints().empty()) throw Rejection(reader_.family().complaints());
  // Single cells may have no start, but not all of them.
  const std::size_t all = varied_.members();
  std::optional<Cell> any;
  for (const std::size_t number : {all / 2 + columns() / 2, std::size_t{0}, all - 1}) {
    if (!any && number < all) any = read_cell(number, 0);
  }
  if (!any) {
    const Reading reading = reader_.read(0);
    if (!reading.complaints.empty()) throw Rejection(reading.complaints);
    throw Error(reading.no_start);
  }
  pattern_ = any->scenario;
  if (!are_makeable()) pattern_.reset();
  prepare(*any);
  numbers_.assign(1, nothing);
  run_together({&*any, 1});
}

/// Nothing if the cell has no start or its scenario is refused.
std::optional<Map::Cell> Map::read_cell(std::size_t number, std::size_t place) {
  Reading reading = reader_.read(number);
  if (!reading.scenario) return std::nullopt;
  Member member = member_of(*reading.scenario);
  return Cell{place, std::move(*reading.scenario), std::move(member)};
}

/// The same cell, made of the pattern without the reader. Nothing if it has no start.
std::optional<Map::Cell> Map::made_cell(std::size_t number, std::size_t place) const {
  Cell cell{place, *pattern_, {}};
  Request& request = cell.scenario.request;
  for (std::size_t key = 0; key < varied_.size(); ++key) {
    std::string* const text = text_at(varied_.keys()[key].path, request);
    if (text == nullptr) return std::nullopt;
    *text = varied_.text(number, key);
  }
  try {
    Frame start = cell.scenario.problem->start(request);
    if (!cell.scenario.problem->regular(request.parameters, start.q, start.p)) return std::nullopt;
    cell.scenario.start_q = std::move(start.q);
    cell.scenario.start_p = std::move(start.p);
  } catch (const NoStart&) {
    return std::nullopt;
  }
  cell.member = member_of(cell.scenario);
  return cell;
}

/// Whether cells can be made of the pattern: both keys are numbers of the start, parameters or the step size, and some
/// cells are those that are read.
bool Map::are_makeable() {
  if (pattern_->request.walls || pattern_->request.start.geometric() || pattern_->request.start.q.empty()) return false;
  for (const Vary& key : varied_.keys()) {
    if (!key.range || text_at(key.path, pattern_->request) == nullptr) return false;
  }
  const std::size_t all = varied_.members();
  for (const std::size_t number : {std::size_t{0}, all / 3, all / 2 + columns() / 2, all - 1}) {
    if (number >= all) continue;
    const std::optional<Cell> read = read_cell(number, 0);
    const std::optional<Cell> made = made_cell(number, 0);
    if (read.has_value() != made.has_value()) return false;
    if (read && (read->member.start.q != made->member.start.q || read->member.start.p != made->member.start.p ||
                 read->member.start.parameters != made->member.start.parameters ||
                 read->member.start.h != made->member.start.h || read->member.shape != made->member.shape)) {
      return false;
    }
  }
  return true;
}

/// Whether the block is for cells like this one.
bool Map::is_ready_for(const Cell& cell) const {
  return request_ && same_kind(*request_, cell.scenario.request) && cell.member.shape == shape_;
}

void Map::prepare(const Cell& cell) {
  if (is_ready_for(cell)) return;
  const Request& request = cell.scenario.request;
  request_ = request;
  shape_ = cell.member.shape;
  block_ = block_for(cell.scenario, cell.member);
  lanes_ = block_ != nullptr ? block_->lanes() : 0;
  if (kind_ == Kind::lyapunov && (lanes_ == 0 || !block_->expect_tangents(1))) {
    throw Error("lyapunov: found " + cell.scenario.request.method.name + " in " + cell.scenario.request.arithmetic +
                "; allowed, in the laboratory, explicit methods in double without walls");
  }
}

void Map::compute(std::size_t first, std::size_t stride, std::size_t count, double milliseconds) {
  const double end = emscripten_get_now() + milliseconds;
  numbers_.clear();
  std::vector<Cell> cells;
  for (std::size_t k = 0; k < count && first + k * stride < varied_.members();) {
    numbers_.push_back(nothing);
    const std::size_t number = first + k * stride;
    if (std::optional<Cell> next = pattern_ ? made_cell(number, k) : read_cell(number, k)) {
      if (!is_ready_for(*next)) run(cells);
      prepare(*next);
      cells.push_back(std::move(*next));
    }
    ++k;
    if (cells.size() < std::max<std::size_t>(lanes_, 1)) continue;
    run(cells);
    if (emscripten_get_now() > end) break;
  }
  run(cells);
}

/// Runs cells of one kind, and takes them off the list.
void Map::run(std::vector<Cell>& cells) {
  if (cells.empty()) return;
  run_together(cells);
  cells.clear();
}

void Map::run_together(std::span<const Cell> cells) {
  std::vector<MemberStart> starts;
  for (const Cell& each : cells) starts.push_back(each.member.start);
  if (lanes_ > 0 && block_->load(shape_, starts)) return run_in_lanes(cells);
  for (const Cell& each : cells) run_alone(each);
}

void Map::run_in_lanes(std::span<const Cell> cells) {
  if (kind_ == Kind::lyapunov) return find_exponents(cells);
  block_->advance(steps_);
  Frame frame;
  for (std::size_t lane = 0; lane < cells.size(); ++lane) {
    if (block_->is_lost(lane)) continue;
    block_->show(lane, frame);
    const MemberEnd end = block_->look(lane);
    if (end.regular) numbers_[cells[lane].place] = number(cells[lane], frame, end.energy, end.walls);
  }
}

void Map::run_alone(const Cell& cell) {
  const auto simulation = make_simulation(cell.scenario.request);
  if (is_failure(simulation->advance(steps_)) || kind_ == Kind::lyapunov) return;
  Frame frame;
  simulation->look(frame);
  numbers_[cell.place] = number(cell, frame, simulation->energy(), simulation->wall_counts());
}

double Map::number(const Cell& cell, const Frame& frame, const Excursion& energy, const std::vector<WallCount>& walls) {
  switch (kind_) {
    case Kind::energy_error:
      return energy.max_error;
    case Kind::relative_energy_error:
      return energy.max_error / energy.scale();
    case Kind::bounces: {
      std::int64_t all = 0;
      for (const WallCount& each : walls) all += each.bounces;
      return static_cast<double>(all);
    }
    default:
      break;
  }
  const Texts& parameters = cell.scenario.request.parameters;
  if (!expression_ || expression_->first != parameters) {
    expression_.emplace(parameters,
                        StateExpression(observable_, *cell.scenario.problem, parameters, cell.scenario.start_q.size()));
  }
  return expression_->second(frame);
}

/// The largest exponent of each cell. State and tangent vector advance together; the lanes share the steps between two
/// normalisations, which are as many as the lane that grows fastest allows.
void Map::find_exponents(std::span<const Cell> cells) {
  std::vector<State<double>> states;
  std::vector<std::vector<State<double>>> vectors;
  std::vector<LaneTangents> jobs;
  std::vector<double> sums(cells.size());
  TangentFrame first(cells[0].member.start.q.size(), 1);
  for (const Cell& each : cells) {
    states.push_back(each.member.start.q);
    states.back().insert(states.back().end(), each.member.start.p.begin(), each.member.start.p.end());
    vectors.push_back(first.vectors());
  }
  if (!block_->expect_tangents(1)) return;
  for (std::size_t lane = 0; lane < cells.size(); ++lane) jobs.push_back({lane, &states[lane], &vectors[lane], 0});
  std::vector<double> logs;
  for (std::int64_t done = 0, some = 1; done < steps_ && !jobs.empty(); done += some) {
    if (done > 0) some = steps_between(some, logs);
    some = std::min(some, steps_ - done);
    for (LaneTangents& job : jobs) job.steps = some, job.carried = false;
    block_->carry(jobs);
    logs.clear();
    std::erase_if(jobs, [&](const LaneTangents& job) {
      const State<double>& v = (*job.vectors)[0];
      double square = 0;
      for (const double x : v) square += x * x;
      const double length = std::sqrt(square);
      if (!job.carried || !(length > 0 && length <= std::numeric_limits<double>::max())) return true;
      for (double& x : (*job.vectors)[0]) x /= length;
      logs.push_back(std::log(length));
      sums[job.lane] += logs.back();
      return false;
    });
  }
  for (const LaneTangents& job : jobs) {
    numbers_[cells[job.lane].place] =
        sums[job.lane] / (static_cast<double>(steps_) * std::abs(cells[job.lane].member.start.h));
  }
}

std::vector<std::pair<std::string, double>> sweepable_keys(const std::string& text) {
  const ScenarioFamily family(text, "scenario", {});
  if (!family.complaints().empty()) throw Rejection(family.complaints());
  std::vector<std::pair<std::string, double>> all;
  const auto add = [&](const std::string& path, const std::string& value) {
    try {
      all.emplace_back(path, evaluate_number<double>(without_quotes(value)));
    } catch (const Error&) {  // a text
    }
  };
  for (const auto& [path, setting] : family.settings()) {
    if (!path.starts_with("problem.") && path != "run.dt") continue;
    const std::string& value = setting.text;
    if (!value.starts_with("[")) {
      add(path, value);
    } else if (value.find('{') == std::string::npos) {
      const std::vector<std::string> parts = list_parts(value);
      for (std::size_t i = 0; i < parts.size(); ++i) add(path + "[" + std::to_string(i) + "]", parts[i]);
    }
  }
  return all;
}

}  // namespace hamflow
