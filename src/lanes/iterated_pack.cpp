#include "iterated_pack.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hamflow {

namespace {
void add(Effort& sum, const Effort& part, int times) {
  sum.force += times * part.force;
  sum.gradient += times * part.gradient;
  sum.hessian += times * part.hessian;
}
}  // namespace

std::int64_t IteratedPack::run(const IteratedFamily& family, const NewtonOptions& options, bool automatic,
                               std::span<const PackLane> lanes, std::int64_t steps, const StepAlone& alone) {
  family_ = &family;
  options_ = &options;
  automatic_ = automatic;
  lanes_ = lanes;
  at_ = family.recorded().frame;
  taken_ = 0;
  start();
  const auto are_gone = [&] {
    return std::all_of(places_.begin(), places_.end(), [](Place place) { return place == Place::gone; });
  };
  for (std::int64_t left = steps; left > 0 && !are_gone(); --left) {
    take_step();
    for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
      if (places_[lane] != Place::outside) continue;
      places_[lane] = alone(lane, left) ? Place::in_lane : Place::gone;
      if (is_here(lane)) put(lane, lanes_[lane].frame);
    }
  }
  for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
    if (is_here(lane)) leave(lane, carried_);
  }
  return taken_;
}

/// Starts the lanes. Those without a member are set to zeros.
void IteratedPack::start() {
  width_ = family_->lanes();
  std::vector<std::size_t> sets;
  for (const PackLane& lane : lanes_) sets.push_back(lane.parameters);
  constants_of_correct_ = family_->constants_of_correct(sets);
  constants_of_finish_ = family_->constants_of_finish(sets);
  carried_.resize(at_.size() * width_);
  ends_.resize((at_.m + 4 * at_.n) * width_);
  sizes_.resize(width_);
  totals_.resize(width_);
  progress_.resize(width_);
  places_.assign(width_, Place::gone);
  std::fill_n(places_.begin(), lanes_.size(), Place::in_lane);
  failed_ = std::make_unique<bool[]>(width_);
  std::fill(carried_.begin(), carried_.end(), 0.0);
  for (std::size_t lane = 0; lane < lanes_.size(); ++lane) put(lane, lanes_[lane].frame);
}

void IteratedPack::put(std::size_t lane, std::span<const double> frame) {
  for (std::size_t k = 0; k < at_.size(); ++k) number(k, lane) = frame[k];
}

void IteratedPack::take_step() {
  solve();
  before_.assign(carried_.begin(), carried_.begin() + static_cast<std::ptrdiff_t>(at_.x() * width_));
  std::fill_n(failed_.get(), width_, false);
  family_->finish().run(carried_, constants_of_finish_, {failed_.get(), width_});
  for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
    if (!is_here(lane)) continue;
    const bool is_coarse = automatic_ && (!(std::abs(number(at_.gain(), lane)) <= number(at_.gain() + 1, lane)) ||
                                          !(number(at_.change(), lane) <= 0));
    if (failed_[lane] || is_coarse) {
      leave(lane, before_);
    } else {
      count(lane);
    }
  }
}

/// Iterates until the step of every lane has ended or left the lane.
void IteratedPack::solve() {
  for (std::size_t lane = 0; lane < width_; ++lane) {
    progress_[lane] = {NewtonProgress<double>(convergence_of(options_->iteration)), 0, !is_here(lane)};
  }
  const auto all_settled = [&] {
    return std::all_of(progress_.begin(), progress_.end(), [](const LaneProgress& one) { return one.settled; });
  };
  int k = 0;
  for (; k < options_->max_iterations && !all_settled(); ++k) {
    std::fill_n(failed_.get(), width_, false);
    family_->correct().run(carried_, constants_of_correct_, {failed_.get(), width_});
    measure_corrections(&number(at_.correction(), 0), &number(at_.unit(), 0), at_.m, width_, sizes_.data(),
                        totals_.data());
    for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
      if (!progress_[lane].settled) judge(lane);
    }
    if (all_settled()) continue;
    for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
      if (is_here(lane) && progress_[lane].settled && progress_[lane].solves == k + 1) keep_end(lane);
    }
  }
  for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
    if (!is_here(lane)) continue;
    if (!progress_[lane].settled) {
      leave(lane, carried_);
    } else if (progress_[lane].solves < k) {
      take_end(lane);
    }
  }
}

/// Decides about the correction of one lane.
void IteratedPack::judge(std::size_t lane) {
  LaneProgress& of_lane = progress_[lane];
  const NewtonDecision decision = of_lane.progress.judge(sizes_[lane], totals_[lane], 1.0);
  if (failed_[lane] || decision == NewtonDecision::not_finite) return leave(lane, carried_);
  ++of_lane.solves;
  if (decision == NewtonDecision::go_on) return;
  of_lane.settled = true;
  // A step that stalls, that began far from its solution, or whose unknowns are hidden by rounding, needs further
  // checks.
  const bool is_plain = decision == NewtonDecision::settled && !of_lane.progress.began_far_away(1.0) &&
                        !(options_->iteration == Iteration::newton && is_hidden(lane));
  if (!is_plain) leave(lane, carried_);
}

/// Whether rounding hides the unknowns; see detail::hiding_terms (averages_rows.hpp).
bool IteratedPack::is_hidden(std::size_t lane) const {
  return hidden_by_rounding(&carried_[at_.unit() * width_ + lane], &carried_[at_.x() * width_ + lane], at_.m, width_);
}

/// Saves the end of the step while the lane waits for others.
void IteratedPack::keep_end(std::size_t lane) {
  const std::size_t size = at_.m + 2 * at_.n;
  for (std::size_t k = 0; k < size; ++k) ends_[k * width_ + lane] = number(at_.end() + k, lane);
  for (std::size_t k = 0; k < 2 * at_.n; ++k) ends_[(size + k) * width_ + lane] = number(at_.state(k), lane);
  rest(lane);
}

void IteratedPack::take_end(std::size_t lane) {
  const std::size_t size = at_.m + 2 * at_.n;
  for (std::size_t k = 0; k < size; ++k) number(at_.end() + k, lane) = ends_[k * width_ + lane];
  for (std::size_t k = 0; k < 2 * at_.n; ++k) number(at_.state(k), lane) = ends_[(size + k) * width_ + lane];
}

/// Sets the lane to zeros, because its results are not used and library functions such as sine return quickly for 0.
void IteratedPack::rest(std::size_t lane) {
  for (std::size_t k = 0; k < 2 * at_.n; ++k) number(at_.state(k), lane) = 0;
  for (std::size_t i = 0; i < at_.m; ++i) number(at_.x() + i, lane) = 0;
}

/// Removes a member from its lane.   @param at the numbers of all lanes, after the last step that this lane completed
void IteratedPack::leave(std::size_t lane, const LaneNumbers& at) {
  for (std::size_t k = 0; k * width_ < at.size(); ++k) lanes_[lane].frame[k] = at[k * width_ + lane];
  places_[lane] = Place::outside;
  progress_[lane].settled = true;
  rest(lane);
}

/// Counts the work of a completed step, as ImplicitMethod does.
void IteratedPack::count(std::size_t lane) {
  Effort& effort = *lanes_[lane].effort;
  const int solves = progress_[lane].solves;
  add(effort, family_->recorded().of_correct, solves);
  add(effort, family_->recorded().of_finish, 1);
  effort.linear_solves += solves;
  effort.solves_min = effort.steps == 0 || solves < effort.solves_min ? solves : effort.solves_min;
  effort.solves_max = solves > effort.solves_max ? solves : effort.solves_max;
  ++effort.steps;
  ++taken_;
}

}  // namespace hamflow
