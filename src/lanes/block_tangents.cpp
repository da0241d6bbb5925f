#include "block_tangents.hpp"

#include <algorithm>

#include "engine/recorded_tangents.hpp"

namespace hamflow {

bool BlockTangents::load(const FamilyLoop::Steps& start, const FamilyLoop::Steps& steady) {
  const auto is_null = [](const auto& step) { return step == nullptr; };
  if (std::any_of(start.begin(), start.end(), is_null) || std::any_of(steady.begin(), steady.end(), is_null)) {
    return false;
  }
  const RecordedStep& first = *start[0];
  values_ = first.program.values();
  if (steady[0]->program.values() != values_) return false;
  moving_ = moving_values(first.program, first.state.size());
  const auto with_slopes = [this](const Program& program) { return with_moving(program, moving_, vectors_); };
  return start_.load(start, with_slopes) && steady_.load(steady, with_slopes);
}

/// Advances all lanes together from one number of steps to the next larger one.
void BlockTangents::carry(std::span<LaneTangents> jobs) {
  const std::size_t lanes = steady_.lanes();
  carried_.assign(place(vectors_, 0), 0.0);
  std::vector<LaneTangents*> by_steps;
  for (LaneTangents& job : jobs) by_steps.push_back(&job);
  std::sort(by_steps.begin(), by_steps.end(), [](auto* a, auto* b) { return a->steps < b->steps; });
  std::vector<const LaneTangents*> of_lane(lanes, &jobs.front());  // lanes without vectors take any job
  for (const LaneTangents& job : jobs) of_lane[job.lane] = &job;
  for (std::size_t lane = 0; lane < lanes; ++lane) write(*of_lane[lane], lane);
  const auto flags = std::make_unique<bool[]>(lanes);
  const std::span<bool> failed(flags.get(), lanes);
  std::int64_t taken = 0;
  for (LaneTangents* job : by_steps) {
    if (taken == 0) {
      start_.run(carried_, 1, failed);
      taken = 1;
    }
    if (job->steps > taken) {
      steady_.run(carried_, job->steps - taken, failed);
      taken = job->steps;
    }
    if (!failed[job->lane]) read(*job);
  }
}

void BlockTangents::write(const LaneTangents& job, std::size_t lane) {
  const std::size_t state = job.z->size();
  for (std::size_t k = 0; k < state; ++k) carried_[k * steady_.lanes() + lane] = (*job.z)[k];
  for (std::size_t v = 0; v < vectors_; ++v) {
    for (std::size_t j = 0; j < state; ++j) slope(v, j)[lane] = (*job.vectors)[v][j];
  }
}

void BlockTangents::read(LaneTangents& job) const {
  const std::size_t state = job.z->size();
  for (std::size_t k = 0; k < state; ++k) (*job.z)[k] = carried_[k * steady_.lanes() + job.lane];
  for (std::size_t v = 0; v < vectors_; ++v) {
    for (std::size_t j = 0; j < state; ++j) (*job.vectors)[v][j] = carried_[place(v, j) + job.lane];
  }
  job.carried = true;
}

}  // namespace hamflow
