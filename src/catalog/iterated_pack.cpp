#include "iterated_pack.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hamflow {

namespace {
constexpr double epsilon = std::numeric_limits<double>::epsilon();

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

/// Lanes without a member rest.
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
  course_.resize(width_);
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

/// The ends of the step, of all lanes that stay.
void IteratedPack::solve() {
  for (std::size_t lane = 0; lane < width_; ++lane) course_[lane] = {.settled = !is_here(lane)};
  const auto all_settled = [&] {
    return std::all_of(course_.begin(), course_.end(), [](const Course& one) { return one.settled; });
  };
  int k = 0;
  for (; k < options_->max_iterations && !all_settled(); ++k) {
    std::fill_n(failed_.get(), width_, false);
    family_->correct().run(carried_, constants_of_correct_, {failed_.get(), width_});
    measure();
    for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
      if (!course_[lane].settled) judge(lane, k);
    }
    if (all_settled()) continue;
    for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
      if (is_here(lane) && course_[lane].settled && course_[lane].solves == k + 1) keep_end(lane);
    }
  }
  for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
    if (!is_here(lane)) continue;
    if (!course_[lane].settled) {
      leave(lane, carried_);
    } else if (course_[lane].solves < k) {
      take_end(lane);
    }
  }
}

/// The corrections in units of what rounding makes of them, as in_units_of_noise (averages_rows.hpp), and the sum that
/// is not finite where one of them is not.
void IteratedPack::measure() {
  double* const sizes = sizes_.data();
  double* const totals = totals_.data();
  std::fill_n(sizes, width_, 0.0);
  for (std::size_t i = 0; i < at_.m; ++i) {
    const double* const correction = &number(at_.correction() + i, 0);
    const double* const units = &number(at_.unit() + i, 0);
    for (std::size_t lane = 0; lane < width_; ++lane) {
      const double size = std::abs(correction[lane]);
      const double own = epsilon * size;
      const double unit = !(units[lane] > epsilon * own) ? own : units[lane];
      const double here = size / larger(unit, std::numeric_limits<double>::min());
      sizes[lane] = here <= sizes[lane] ? sizes[lane] : here;
    }
  }
  std::copy_n(sizes, width_, totals);
  for (std::size_t i = 0; i < at_.m; ++i) {
    const double* const correction = &number(at_.correction() + i, 0);
    for (std::size_t lane = 0; lane < width_; ++lane) totals[lane] += std::abs(correction[lane]);
  }
}

/// What Newton decides after the k-th correction (newton.hpp).
void IteratedPack::judge(std::size_t lane, int k) {
  Course& course = course_[lane];
  if (failed_[lane] || !(totals_[lane] <= std::numeric_limits<double>::max())) return leave(lane, carried_);
  ++course.solves;
  const double size = sizes_[lane];
  if (k == 0) course.first = size;
  course.settled = options_->iteration == Iteration::newton
                       ? newton_at_rounding(size, course.previous, k == 0, 1.0, course.stalls)
                       : linear_at_rounding(size, course.previous, k == 0, 1.0, course.least, course.stalls);
  course.previous = size;
  if (!course.settled && have_stalled(options_->iteration, course.stalls)) {
    return leave(lane, carried_);  // to a closer look
  }
  if (!course.settled) return;
  const bool far = epsilon * course.first > 1;  // the guess was
  if (far || (options_->iteration == Iteration::newton && is_hidden(lane))) leave(lane, carried_);
}

/// Whether rounding hides the unknowns, as detail::hiding_terms (averages_rows.hpp).
bool IteratedPack::is_hidden(std::size_t lane) const {
  double unit = 0;
  double unknown = 0;
  for (std::size_t i = 0; i < at_.m; ++i) {
    unit = larger(unit, number(at_.unit() + i, lane));
    unknown = larger(unknown, std::abs(number(at_.x() + i, lane)));
  }
  return hidden_by_rounding(unit, unknown);
}

/// The lane waits for others.
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

/// What the lane computes is of no use. Sines and other functions of the library, one by one in a lane, answer 0 at
/// once.
void IteratedPack::rest(std::size_t lane) {
  for (std::size_t k = 0; k < 2 * at_.n; ++k) number(at_.state(k), lane) = 0;
  for (std::size_t i = 0; i < at_.m; ++i) number(at_.x() + i, lane) = 0;
}

/// @param at numbers in which the lane stands at the last step that it has taken
void IteratedPack::leave(std::size_t lane, const LaneNumbers& at) {
  for (std::size_t k = 0; k * width_ < at.size(); ++k) lanes_[lane].frame[k] = at[k * width_ + lane];
  places_[lane] = Place::outside;
  course_[lane].settled = true;
  rest(lane);
}

/// The work of a step that was taken, as ImplicitMethod counts it.
void IteratedPack::count(std::size_t lane) {
  Effort& effort = *lanes_[lane].effort;
  const int solves = course_[lane].solves;
  add(effort, family_->recorded().of_correct, solves);
  add(effort, family_->recorded().of_finish, 1);
  effort.linear_solves += solves;
  effort.solves_min = effort.steps == 0 || solves < effort.solves_min ? solves : effort.solves_min;
  effort.solves_max = solves > effort.solves_max ? solves : effort.solves_max;
  ++effort.steps;
  ++taken_;
}

}  // namespace hamflow
