#include "lane_run.hpp"

#include <algorithm>
#include <cmath>

namespace hamflow {

LaneRun::LaneRun(EnsembleBlock& block, std::vector<LaneObservers> observers)
    : block_(block), observers_(std::move(observers)), has_sections_(!observers_.empty() && observers_[0].section) {
  if (observers_.empty()) {
    due_ = Observer::never;
    return;
  }
  call_due_observers();
  use_block_sums();
  for (TangentObserver* watch : observers_[0].tangents) {
    const std::optional<TangentsToAdvance> vectors = watch->tangents_to_advance();
    go_in_lanes_.push_back(vectors && block_.expect_tangents(vectors->vectors->size()));
  }
  if (!has_sections_) return;
  for (std::size_t lane = 0; lane < observers_.size(); ++lane) distances_.push_back(section_distance(lane));
}

void LaneRun::advance(std::int64_t steps) {
  const std::int64_t end = taken_ + steps;
  while (taken_ < end) {
    if (has_sections_) {
      block_.take_step();
      ++taken_;
      look_for_sections();
    } else {
      const std::int64_t next = std::min(end, due_);
      block_.advance(next - taken_);
      taken_ = next;
    }
    if (taken_ == due_) call_due_observers();
  }
}

/// If the block sums observables itself, observers that only need sums have seen the start and are not called again.
void LaneRun::use_block_sums() {
  std::vector<std::span<const NamedExpression>> summed;
  for (const LaneObservers& observers : observers_) {
    if (observers.sums == nullptr) return;
    summed.push_back(observers.sums->summed());
  }
  has_sums_ = block_.expect_sums(summed);
  if (!has_sums_) return;
  for (LaneObservers& observers : observers_) {
    std::erase_if(observers.all, [&](Observer* each) { return dynamic_cast<SummedSteps*>(each) == observers.sums; });
  }
  due_ = next_due();
}

void LaneRun::take_sums() {
  for (std::size_t lane = 0; has_sums_ && taken_ > 0 && lane < observers_.size(); ++lane) {
    if (block_.is_lost(lane)) continue;
    block_.show(lane, frame_);
    SummedSteps& observer = *observers_[lane].sums;
    const std::vector<StepSum> sums = block_.sums(lane);
    std::copy(sums.begin(), sums.end(), observer.sums().begin());
    observer.reach(frame_);
  }
}

std::int64_t LaneRun::next_due() const {
  std::int64_t due = Observer::never;
  for (std::size_t lane = 0; lane < observers_.size(); ++lane) {
    if (block_.is_lost(lane)) continue;
    for (const Observer* observer : observers_[lane].all) due = std::min(due, observer->next_due(taken_ + 1));
  }
  return due;
}

void LaneRun::call_due_observers() {
  if (taken_ > 0) advance_tangents();
  for (std::size_t lane = 0; lane < observers_.size(); ++lane) {
    if (block_.is_lost(lane)) continue;
    bool shown = false;
    for (Observer* observer : observers_[lane].all) {
      if (observer->next_due(taken_) != taken_) continue;
      if (!shown) block_.show(lane, frame_);
      shown = true;
      (void)observer->observe(frame_);
    }
  }
  due_ = next_due();
}

/// When the vectors of one lane are due, those of all lanes are advanced to their next observations.
void LaneRun::advance_tangents() {
  for (std::size_t kind = 0; kind < go_in_lanes_.size(); ++kind) {
    if (!go_in_lanes_[kind]) continue;
    jobs_.clear();
    bool wanted = false;
    for (std::size_t lane = 0; lane < observers_.size(); ++lane) {
      TangentObserver& watch = *observers_[lane].tangents[kind];
      if (block_.is_lost(lane)) continue;
      const std::optional<TangentsToAdvance> vectors = watch.tangents_to_advance();
      if (!vectors) continue;
      wanted = wanted || watch.next_due(taken_) == taken_;
      jobs_.push_back({lane, vectors->z, vectors->vectors, vectors->steps});
    }
    if (!wanted) continue;
    block_.carry(jobs_);
    for (const LaneTangents& job : jobs_) {  // the watch itself advances the vectors that were not carried
      if (job.carried) observers_[job.lane].tangents[kind]->set_advanced();
    }
  }
}

double LaneRun::section_distance(std::size_t lane) {
  block_.show(lane, frame_);
  return observers_[lane].section->distance(frame_);
}

void LaneRun::look_for_sections() {
  const Section& first = observers_[0].section->section();
  const std::size_t size = frame_.q.size();
  const double* const x =
      first.expression || first.every_step ? nullptr : block_.numbers(first.coordinate + (first.momentum ? size : 0));
  for (std::size_t lane = 0; lane < observers_.size(); ++lane) {
    SectionSearch& search = *observers_[lane].section;
    const double now = x == nullptr ? section_distance(lane) : x[lane] - first.value;
    const double before = std::exchange(distances_[lane], now);
    if (search.failed() || block_.is_lost(lane)) continue;
    if (first.by_steps) {
      block_.show(lane, frame_);
      search.take_step(before, now, frame_);
      continue;
    }
    if (search.is_to_measure(taken_ - 1)) search.measure(block_.before_step(lane));
    const bool hides = search.may_hide_zeros(before, now);
    if (search.is_long() || hides) {
      block_.show(lane, frame_);
      search.locate_all(block_.before_step(lane), before, frame_, now);
      // the same condition as in SectionFinder
    } else if (search.crosses(before, now) || std::isnan(before) != std::isnan(now)) {
      search.locate(block_.before_step(lane), before, now);
    }
  }
}

}  // namespace hamflow
