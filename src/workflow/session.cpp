#include "hamflow/workflow/session.hpp"

#include <algorithm>
#include <cmath>

#include "engine/large_steps.hpp"
#include "gas_checks.hpp"
#include "hamflow/detail/run/digits.hpp"
#include "hamflow/methods/step_control.hpp"
#include "method_keys.hpp"
#include "run_description.hpp"
#include "run_keys.hpp"
#include "scenario_edit.hpp"
#include "wall_checks.hpp"

namespace hamflow {

namespace {

std::vector<std::string> texts_of(const std::vector<double>& numbers) {
  std::vector<std::string> texts;
  texts.reserve(numbers.size());
  for (const double x : numbers) texts.push_back(shortest(x));
  return texts;
}

Effort sum(const Effort& a, const Effort& b) {
  Effort all = b;
  all.force += a.force;
  all.gradient += a.gradient;
  all.hessian += a.hessian;
  all.linear_solves += a.linear_solves;
  all.steps += a.steps;
  all.stagnated += a.stagnated;
  all.halved += a.halved;
  if (a.steps > 0) {
    all.solves_min = b.steps > 0 ? std::min(a.solves_min, b.solves_min) : a.solves_min;
    all.solves_max = std::max(a.solves_max, b.solves_max);
  }
  return all;
}

/// Returns the method as a TOML table for [method].
std::string method_table(const MethodSpec& method) {
  std::string text = "{ " + method_name_key().name + " = \"" + method.name + "\"";
  for (const OptionInfo& option : find_method(method.name).family->options) {
    const auto given = method.options.find(option.name);
    if (given != method.options.end()) text += ", " + option.name + " = " + toml_text(option, given->second);
  }
  return text + " }";
}

/// Returns methods that have the option, one of each family.
std::string methods_with(const std::string& option) {
  std::vector<std::string> names;
  for (const MethodFamily& family : method_families()) {
    if (find_option(family.options, option) != nullptr) names.push_back(family.methods.front());
  }
  return joined(names);
}

}  // namespace

Session::Session(const Scenario& scenario) : scenario_(scenario), request_(scenario.request) {
  remember(request_.method);
  restart();
}

void Session::restart() {
  Request request = request_;
  request.start = scenario_.request.start;
  simulation_ = make_simulation(request);
  request_ = request;
  changes_.clear();
  reversed_ = false;
  one_part_ = true;
  step_before_ = 0;
  time_before_ = 0;
  exact_time_before_ = "0";
  effort_before_ = {};
  bounces_before_.clear();
  bounces_.clear();
  report_bounces();
  initial_energy_ = simulation_->energy().initial;
  worst_energy_ = 0;
  worst_residuals_.reset();
  Frame start;
  simulation_->look(start);
  sizes_ = scenario_.problem->invariant_sizes(request_.parameters, start.q.size());
  exact_initial_energy_ = start.digits.energy;
  initial_invariants_ = start.invariants;
  reference_ = start.invariants;
  offset_.assign(start.invariants.size(), 0);
  worst_invariants_.assign(sizes_.size(), 0);
  turns_ = TurningPointObserver(evaluate_number<double>(request_.dt), takes_equal_steps(simulation_->method()));
}

void Session::set_step_size(const std::string& text) {
  const OptionInfo& dt = run_keys().dt;
  if (const std::string refused = refused_value(dt, text); !refused.empty()) throw Error(dt.name + ": " + refused);
  Request next = request_;
  next.dt = text;
  change(next, dt.name + " = " + text);
}

void Session::set_method(const MethodSpec& method) {
  Request next = request_;
  next.method = method;
  for (const OptionInfo& option : find_method(method.name).family->options) {
    const auto before = std::find_if(options_.begin(), options_.end(),
                                     [&](const auto& set) { return same_option(*set.first, option); });
    if (before != options_.end() && refused_value(option, before->second).empty()) {
      next.method.options.emplace(option.name, before->second);
    }
  }
  const auto control = next.method.options.find(step_control_option);
  const bool varies = control != next.method.options.end() && control->second == reversible_steps;
  if (!varies && !method.options.contains(monitor_option)) next.method.options.erase(monitor_option);
  auto refused = refused_option(next.method);
  if (!refused) refused = refused_option(next.method, scenario_.start_q.size());
  if (refused) throw Error(method.name + ": " + refused->name + ": " + refused->message);
  if (const std::string why_not = refused_by_walls(next, *scenario_.problem, scenario_.start_q); !why_not.empty()) {
    throw Error("method: found " + describe(next.method).name + " with problem.wall_rule = \"" + rule_of_walls(next) +
                "\" " + why_not);
  }
  if (const std::string why_not = refused_by_size(next, scenario_.start_q.size()); !why_not.empty()) {
    throw Error("method: found " + describe(next.method).name + " " + why_not);
  }
  change(next, "method = " + describe(next.method).name);
  remember(next.method);
}

/// Remembers the options of a method for later methods that have the same option.
void Session::remember(const MethodSpec& method) {
  for (const OptionInfo& option : find_method(method.name).family->options) {
    const auto text = method.options.find(option.name);
    if (text == method.options.end()) continue;
    std::erase_if(options_, [&](const auto& set) { return same_option(*set.first, option); });
    options_.emplace_back(&option, text->second);
  }
}

void Session::set_tolerance(const std::string& text) {
  const std::string& method = request_.method.name;
  const OptionInfo* const option = find_option(find_method(method).family->options, tolerance_option);
  if (option == nullptr) {
    throw Error("tol: the method " + method + " has no tolerance; allowed with " + methods_with(tolerance_option));
  }
  Request next = request_;
  if (text == "off") {
    next.method.options.erase(option->name);
  } else {
    OptionInfo with_off = *option;
    with_off.words.emplace_back("off");
    if (const std::string refused = refused_value(with_off, text); !refused.empty()) throw Error("tol: " + refused);
    next.method.options[option->name] = text;
  }
  change(next, option->name + " = " + text);
  std::erase_if(options_, [&](const auto& set) { return same_option(*set.first, *option); });
  remember(request_.method);
}

/// Refuses a change if H depends on t: a new simulation would start at t = 0, and negated momenta do not reverse H(q,
/// p, t).
void Session::refuse_time(const std::string& what) const {
  if (!scenario_.problem->structure || !scenario_.problem->structure->time) return;
  throw Error("found " + what + " after step " + std::to_string(step()) +
              ", but H depends on t; allowed before the first step, or as a separate run");
}

void Session::change(const Request& next, const std::string& what) {
  if (one_part_ && simulation_->step() == 0) {  // restarts from the given start, with all its digits
    const Request before = std::exchange(request_, next);
    try {
      restart();
    } catch (...) {
      request_ = before;
      throw;
    }
    return;
  }
  refuse_time(what);
  Frame now;
  simulation_->look(now);
  Request from_here = next;
  from_here.start = {};
  from_here.start.q = now.digits.q.empty() ? texts_of(now.q) : now.digits.q;
  from_here.start.p = now.digits.p.empty() ? texts_of(now.p) : now.digits.p;
  auto other = make_simulation(from_here);
  watch_from_here();
  Frame fresh;
  other->look(fresh);
  for (std::size_t i = 0; i < offset_.size(); ++i) offset_[i] += now.invariants[i] - fresh.invariants[i];
  effort_before_ = effort();
  bounces_before_ = wall_counts();
  step_before_ += now.step;
  time_before_ += now.time;
  if (!now.digits.time.empty()) exact_time_before_ = sum_of(exact_time_before_, now.digits.time, request_.arithmetic);
  worst_residuals_ = constraints();
  simulation_ = std::move(other);
  report_bounces();
  request_ = from_here;
  changes_.push_back({step_before_, time_before_, what});
  turns_.restart(step_before_, evaluate_number<double>(request_.dt), takes_equal_steps(simulation_->method()));
}

Scenario Session::present() const {
  Scenario now = scenario_;
  now.request.method = request_.method;
  now.request.dt = request_.dt;
  now.dt = evaluate_number<double>(request_.dt);
  now.steps = step();
  const Request& first = scenario_.request;
  const bool same_method = first.method == request_.method;
  const bool steered = !same_method || first.dt != request_.dt || !changes_.empty();
  if (!steered && now.steps == scenario_.steps && scenario_.record.empty()) return now;
  now.text = !steered ? "" : session_heading;
  for (const SessionChange& c : changes_) {
    now.text +=
        std::string(change_heading) + std::to_string(c.step) + ", t = " + shortest(c.time) + ": " + c.what + "\n";
  }
  std::vector<ScenarioEdit> edits{{run_path(run_keys().dt), "\"" + request_.dt + "\""},
                                  {run_path(run_keys().t_end), {}},
                                  {run_path(run_keys().steps), std::to_string(now.steps)}};
  if (!same_method) edits.push_back({"method", method_table(request_.method)});
  if (!scenario_.record.empty()) {  // a session keeps samples by steps
    edits.push_back({run_path(run_keys().record), {}});
    now.record.clear();
    now.record_steps.clear();
  }
  now.text += edited_scenario(scenario_.text, edits);
  return now;
}

bool Session::records_more_bounces() const { return std::ssize(bounces_) < scenario_.record_events; }

/// Collects the bounces of the current part, whose steps and times count from the start of the part.
void Session::report_bounces() {
  reports_bounces_ = records_more_bounces();
  if (!reports_bounces_) return;
  simulation_->on_bounce([this](const Bounce& bounce) {
    if (!records_more_bounces()) return;
    Bounce& kept = bounces_.emplace_back(bounce);
    kept.step += step_before_;
    kept.time += time_before_;
    if (!kept.digits.q.empty() && !one_part_) {
      kept.digits.time = sum_of(exact_time_before_, kept.digits.time, request_.arithmetic);
    }
  });
}

Outcome Session::advance(std::int64_t steps) {
  if (reports_bounces_ && !records_more_bounces()) {  // unreported bounces cost less
    simulation_->on_bounce({});
    reports_bounces_ = false;
  }
  if (one_part_) return simulation_->advance(steps);
  for (std::int64_t i = 0; i < steps; ++i) {
    const Outcome outcome = simulation_->advance(1);
    if (outcome != Outcome::done) return outcome;
    look(scratch_);
    watch(scratch_);
  }
  return Outcome::done;
}

std::int64_t Session::step() const { return step_before_ + simulation_->step(); }

void Session::look(Frame& frame) const {
  simulation_->look(frame);
  in_session(frame);
}

/// Changes steps, times and evaluations of the current part to those of the session.
void Session::in_session(Frame& frame) const {
  frame.step += step_before_;
  frame.time += time_before_;
  for (std::size_t i = 0; i < offset_.size(); ++i) frame.invariants[i] += offset_[i];
  frame.effort = sum(effort_before_, frame.effort);
  if (frame.digits.q.empty() || one_part_) return;
  frame.digits.time = sum_of(exact_time_before_, frame.digits.time, request_.arithmetic);
  frame.digits.initial_energy = exact_initial_energy_;
}

std::vector<std::byte> Session::save() const { throw Error("a session cannot be saved as a checkpoint"); }
void Session::restore(std::span<const std::byte>) { throw Error("a session cannot be restored from a checkpoint"); }
std::unique_ptr<Simulation> Session::clone() const { throw Error("a session cannot be copied"); }

Outcome Session::look_ahead(const std::string& time, Frame& frame) const {
  if (one_part_) return simulation_->look_ahead(time, frame);
  const double t = evaluate_number<double>(time);
  const Outcome outcome = simulation_->look_ahead(shortest(t - time_before_), frame);
  if (outcome == Outcome::done) in_session(frame);
  return outcome;
}

Outcome Session::look_part(double theta, Frame& frame) const {
  const Outcome outcome = simulation_->look_part(theta, frame);
  if (outcome == Outcome::done) in_session(frame);
  return outcome;
}

void Session::reverse_time() {
  watch_from_here();
  simulation_->reverse_time();
}

void Session::negate_momenta() {
  refuse_time("negated momenta");
  watch_from_here();
  simulation_->negate_momenta();
  look(scratch_);
  reference_ = scratch_.invariants;
  reversed_ = true;
  turns_.restart(scratch_.step, turns_.step_length(), turns_.is_active());  // every coordinate turns here
  changes_.push_back({scratch_.step, scratch_.time, std::string(momenta_negated)});
}

Excursion Session::energy() const {
  const Excursion part = simulation_->energy();
  if (one_part_) return part;
  Excursion all = first_part_;
  all.final = part.final;
  all.max_error = worst_energy_;
  all.exchanged = std::max(first_part_.exchanged, part.exchanged);
  return all;
}

std::optional<ConstraintResiduals> Session::constraints() const {
  auto worst = simulation_->constraints();
  if (!worst || !worst_residuals_) return worst;
  return ConstraintResiduals{std::max(worst->position, worst_residuals_->position),
                             std::max(worst->velocity, worst_residuals_->velocity)};
}

std::vector<InvariantExcursion> Session::invariants() const {
  if (one_part_) return simulation_->invariants();
  Frame now;
  look(now);
  std::vector<InvariantExcursion> all;
  auto at = std::ptrdiff_t{0};
  for (std::size_t k = 0; k < sizes_.size(); ++k) {
    const auto end = at + static_cast<std::ptrdiff_t>(sizes_[k]);
    all.push_back({{initial_invariants_.begin() + at, initial_invariants_.begin() + end},
                   {now.invariants.begin() + at, now.invariants.begin() + end},
                   worst_invariants_[k]});
    at = end;
  }
  return all;
}

std::vector<WallCount> Session::wall_counts() const {
  std::vector<WallCount> all = simulation_->wall_counts();
  for (std::size_t i = 0; i < bounces_before_.size(); ++i) all.at(i).bounces += bounces_before_[i].bounces;
  return all;
}

Effort Session::effort() const { return sum(effort_before_, simulation_->effort()); }

void Session::watch_from_here() {
  if (!one_part_) return;
  first_part_ = simulation_->energy();
  worst_energy_ = first_part_.max_error;
  const std::vector<InvariantExcursion> seen = simulation_->invariants();
  for (std::size_t k = 0; k < seen.size(); ++k) worst_invariants_[k] = seen[k].max_error;
  one_part_ = false;
}

void Session::watch(const Frame& frame) {
  const std::string& exact = frame.digits.energy;
  const double error = exact.empty()
                           ? frame.energy - initial_energy_
                           : static_cast<double>(differences_from_first({exact_initial_energy_, exact}).back());
  worst_energy_ = std::max(worst_energy_, std::abs(error));
  for (std::size_t k = 0; k < sizes_.size(); ++k) {
    worst_invariants_[k] = std::max(worst_invariants_[k], deviation(frame.invariants, k));
  }
}

/// Returns the norm of the deviation of the k-th invariant from its reference.
double Session::deviation(const std::vector<double>& values, std::size_t k) const {
  std::size_t at = 0;
  for (std::size_t i = 0; i < k; ++i) at += sizes_[i];
  double square = 0;
  for (std::size_t i = at; i < at + sizes_[k]; ++i) square += (values[i] - reference_[i]) * (values[i] - reference_[i]);
  return std::sqrt(square);
}

SampleKeeper::SampleKeeper(std::int64_t every, std::size_t dimension, std::size_t most) : every_(every), most_(most) {
  constexpr std::size_t most_numbers = std::size_t{1} << 23;
  if (most_ == 0) most_ = std::max<std::size_t>(most_numbers / (2 * dimension + 30), 100);
}

std::int64_t SampleKeeper::next_due(std::int64_t step) const {
  return step % every_ == 0 ? step : step + (every_ - step % every_);
}

Verdict SampleKeeper::observe(const Frame& frame) {
  if (!samples_.empty() && samples_.back().step == frame.step) return Verdict::go_on;
  samples_.push_back(frame);
  if (samples_.size() > most_) {
    every_ *= 2;
    std::erase_if(samples_, [&](const Frame& sample) { return sample.step % every_ != 0; });
  }
  return Verdict::go_on;
}

std::vector<Frame> SampleKeeper::with_current_state(const Simulation& simulation) const {
  std::vector<Frame> all = samples_;
  if (all.empty() || all.back().step != simulation.step()) all.emplace_back();
  simulation.look(all.back());  // the momenta may have been negated since the sample
  return all;
}

}  // namespace hamflow
