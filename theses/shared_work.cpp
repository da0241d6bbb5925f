#include "shared_work.hpp"

#include <algorithm>
#include <utility>

namespace hamflow::reproduction {

void SharedWork::take_one(Job& job, std::unique_lock<std::mutex>& lock) {
  const std::size_t i = job.next++;
  ++job.running;
  lock.unlock();
  std::exception_ptr error;
  try {
    (*job.piece)(i);
  } catch (...) {
    error = std::current_exception();
  }
  lock.lock();
  if (error) {
    if (!job.error) job.error = error;
    job.next = job.count;
  }
  --job.running;
  changed_.notify_all();
}

void SharedWork::each(std::size_t count, const std::function<void(std::size_t)>& piece) {
  Job job{.count = count, .piece = &piece};
  std::unique_lock lock(mutex_);
  const auto place = jobs_.insert(jobs_.end(), &job);
  changed_.notify_all();
  while (job.next < job.count) take_one(job, lock);
  changed_.wait(lock, [&] { return job.running == 0; });
  jobs_.erase(place);
  if (job.error) std::rethrow_exception(job.error);
}

void SharedWork::reduce_threads(std::size_t threads) {
  const std::lock_guard lock(mutex_);
  busy_ -= threads;
  changed_.notify_all();
}

void SharedWork::help() {
  std::unique_lock lock(mutex_);
  --busy_;
  changed_.notify_all();
  while (true) {
    const auto open = std::find_if(jobs_.begin(), jobs_.end(), [](const Job* job) { return job->next < job->count; });
    if (open != jobs_.end()) {
      take_one(**open, lock);
    } else if (busy_ == 0) {
      return;
    } else {
      changed_.wait(lock);
    }
  }
}

}  // namespace hamflow::reproduction
