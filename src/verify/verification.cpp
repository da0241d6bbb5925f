#include "hamflow/verify/verification.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>

#include "hamflow/core/complaint.hpp"
#include "hamflow/detail/core/option_names.hpp"
#include "hamflow/detail/core/thread.hpp"
#include "measuring_stopped.hpp"

namespace hamflow {

namespace {

std::vector<MethodSpec> methods_of(const VerificationRequest& request) {
  std::vector<MethodSpec> specs;
  std::vector<Complaint> unknown;
  for (const std::string& text : request.methods) {
    try {
      specs.push_back(parse_method(text));
    } catch (const Error& error) {
      unknown.push_back({"", 0, 0, option_name("METHOD"), error.what()});
    }
  }
  if (!unknown.empty()) throw Rejection(std::move(unknown));
  if (!request.all) return specs;
  for (const MethodEntry& entry : methods()) {
    if (entry.family->representatives.empty()) specs.push_back(parse_method(entry.name));
    for (const std::string& text : entry.family->representatives) specs.push_back(parse_method(text));
  }
  return specs;
}

/// Returns the default variant of the problem, or the first variant that all methods can integrate.
Region region_for(const std::string& problem, const std::vector<MethodSpec>& specs) {
  const auto accepted = [&](const ProblemEntry& entry) {
    return std::all_of(specs.begin(), specs.end(), [&](const auto& spec) { return entry.accepts(spec); });
  };
  if (!accepted(*usual_problem(problem))) {
    for (const ProblemEntry& entry : problems()) {
      if (entry.info.name != problem || !accepted(entry)) continue;
      return region_of(problem, {entry.info.variant.begin(), entry.info.variant.end()});
    }
  }
  return region_of(problem);
}

/// A method and the region at walls where it is measured. Without one, the given regions or those of the method are
/// used.
struct Job {
  MethodSpec spec;
  std::optional<Region> at_walls{};
};

}  // namespace

/// The caller's thread only waits, so that it can return the finished rows after an interrupt.
class Verification::Impl {
 public:
  explicit Impl(const VerificationRequest& request) {
    const std::vector<MethodSpec> specs = methods_of(request);
    try {
      if (!request.problem.empty()) given_ = {region_for(request.problem, specs)};
    } catch (const Error& error) {
      throw Rejection(option_name("problem"), error.what());
    }
    for (const Region& region : given_) {
      for (const MethodSpec& spec : specs) (void)step_map_on(region, spec);  // throws if the problem is refused
    }
    const auto at_walls = given_.empty() ? std::nullopt : region_at_walls(request.problem);
    for (const MethodSpec& spec : specs) {
      jobs_.push_back({spec});
      // Methods that carry a second copy of the state are not measured, because the copy meets walls at other times.
      if (at_walls && !describe(spec).carries_copy && find_problem(*at_walls)->accepts(spec)) {
        jobs_.push_back({spec, at_walls});
      }
    }
    measured_.resize(jobs_.size());
    const std::size_t most = std::min<std::size_t>(std::max(1u, processors()), jobs_.size());
    working_threads_ = most;
    try {
      while (worker_threads_.size() < most)
        worker_threads_.emplace_back([this] { work([this] { return !stopped_; }); });
    } catch (const std::system_error&) {  // those that were started do the work, or wait() does
      const std::lock_guard lock(mutex_);
      working_threads_ -= most - worker_threads_.size();
    }
  }
  ~Impl() { stopped_ = true; }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  bool wait(const std::function<bool()>& goes_on) {
    if (worker_threads_.empty()) work([&] { return !stopped_ && !(stopped_ = !goes_on()); });
    std::unique_lock lock(mutex_);
    while (working_threads_ > 0) {
      finished_.wait_for(lock, std::chrono::milliseconds(20));
      lock.unlock();
      const bool go_on = goes_on();
      lock.lock();
      if (!go_on && working_threads_ > 0) return false;
    }
    if (failure_) std::rethrow_exception(failure_);
    return !stopped_;
  }
  std::vector<PropertyRow> rows() {
    const std::lock_guard lock(mutex_);
    std::vector<PropertyRow> all;
    for (const auto& row : measured_) {
      if (row) all.push_back(*row);
    }
    return all;
  }

 private:
  void work(const std::function<bool()>& goes_on) {
    const StopQuestion question(goes_on);
    try {
      for (std::size_t i = next_++; i < jobs_.size() && goes_on(); i = next_++) {
        const auto& [method, at_walls] = jobs_[i];
        PropertyRow row = at_walls ? measure_at_walls(method, *at_walls)
                                   : measure_method(method, given_.empty() ? default_regions(method) : given_);
        const std::lock_guard lock(mutex_);
        measured_[i] = std::move(row);
      }
    } catch (const MeasuringStopped&) {  // finished measurements are kept
    } catch (...) {
      next_ = jobs_.size();
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    if (working_threads_ > 0) --working_threads_;
    finished_.notify_all();
  }

  std::vector<Region> given_;
  std::vector<Job> jobs_;
  std::vector<std::optional<PropertyRow>> measured_;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> stopped_{false};
  std::size_t working_threads_ = 0;
  std::exception_ptr failure_;
  std::mutex mutex_;
  std::condition_variable finished_;
  std::vector<Thread> worker_threads_;  // last member, so that the threads end before the members that they use
};

Verification::Verification(const VerificationRequest& request) : impl_(std::make_unique<Impl>(request)) {}
Verification::~Verification() = default;
bool Verification::wait(const std::function<bool()>& goes_on) { return impl_->wait(goes_on); }
std::vector<PropertyRow> Verification::rows() { return impl_->rows(); }

std::string verification_json(const std::vector<PropertyRow>& rows, bool interrupted) {
  if (!interrupted) return property_json(rows);
  nlohmann::json all = nlohmann::json::parse(property_json(rows));
  all["status"] = "interrupted";
  return all.dump(2) + "\n";
}

}  // namespace hamflow
