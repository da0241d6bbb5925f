#include "comparison_jobs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "hamflow/arithmetic/mp.hpp"
#include "hamflow/core/number.hpp"

namespace hamflow {

namespace {

constexpr std::int64_t adaptive_steps = 32;  // few, because each step cuts a sub-step short

/// Returns the tolerance of an adaptive method in place of the k-th dt. Tolerances go in equal ratios from 1e-3 to a
/// value three digits above rounding. If there is only one, it is the default of the methods.
double usual_tolerance(std::size_t k, std::size_t count, int digits) {
  const int beyond = std::clamp(digits, 8, 300);
  if (count < 2) return std::pow(10.0, digits > 16 ? 4 - beyond : -12);
  return std::pow(10.0, -3.0 - (beyond - 6) * static_cast<double>(k) / static_cast<double>(count - 1));
}

/// Returns the expected work of a run relative to the first run of its method, from the number of steps or from how the
/// tolerance shortens sub-steps.
double relative_work(const ComparisonPoint& first, const ComparisonPoint& point) {
  if (!first.tolerance || !point.tolerance) {
    return static_cast<double>(point.steps) / static_cast<double>(first.steps);
  }
  // a series takes the same number of steps, and its work grows with the square of the order
  if (first.order != point.order) {
    return static_cast<double>(point.order * point.order) / static_cast<double>(first.order * first.order);
  }
  return std::pow(*first.tolerance / *point.tolerance, 1.0 / point.order);
}

/// Returns a number in its shortest spelling, and a word unchanged.
std::string same_spelling(const OptionInfo& option, const std::string& text) {
  const bool is_word = text.empty() || option.type != OptionType::number ||
                       std::find(option.words.begin(), option.words.end(), text) != option.words.end();
  return is_word ? text : shortest(number_value(text));
}

/// Returns the value of an option. An option that is not given has its default, if canonical names contain it, as in
/// cg(1,auto). For other options the result is empty: their default may depend on other options, so it never equals a
/// given value.
std::string value_of(const MethodSpec& method, const OptionInfo& option) {
  const auto given = method.options.find(option.name);
  if (given != method.options.end()) return same_spelling(option, given->second);
  return option.position > 0 ? same_spelling(option, option.default_value) : "";
}

bool contains_option(const std::string& name, const OptionInfo& option) {
  const std::size_t at = name.find(option.name + "=");
  return at != std::string::npos && at > 0 && (name[at - 1] == '(' || name[at - 1] == ',');
}

/// @param alike all methods with the same canonical name, including this one
std::string unique_name(const MethodSpec& method, const std::vector<const MethodSpec*>& alike) {
  const std::string shared = describe(method).name;
  const std::size_t open = shared.find('(');
  std::string inside = open == std::string::npos ? "" : shared.substr(open + 1, shared.size() - open - 2);
  for (const OptionInfo& option : find_method(method.name).family->options) {
    const std::string own = value_of(method, option);
    const bool differs = std::any_of(alike.begin(), alike.end(),
                                     [&](const MethodSpec* other) { return value_of(*other, option) != own; });
    const auto given = method.options.find(option.name);
    if (!differs || given == method.options.end()) continue;
    const std::string assignment = option.name + "=" + given->second;
    if (contains_option(shared, option)) {  // the canonical name shows fewer digits than those in which they differ
      const std::size_t at = inside.find(option.name + "=");
      inside.replace(at, std::min(inside.find(',', at), inside.size()) - at, assignment);
    } else {
      inside += (inside.empty() ? "" : ",") + assignment;
    }
  }
  return shared.substr(0, open) + (inside.empty() ? "" : "(" + inside + ")");
}

}  // namespace

bool divides_exactly(const std::string& dt, std::int64_t steps, const std::string& t_end,
                     const std::string& arithmetic) {
  const int digits = digits_of(arithmetic);
  const MpDigits scope(digits + 30);
  const Mp end = evaluate_number<Mp>(t_end);
  const Mp tolerance = abs(end) * evaluate_number<Mp>("1e-" + std::to_string(digits + 10));
  return abs(evaluate_number<Mp>("(" + dt + ")*" + std::to_string(steps)) - end) <= tolerance;
}

std::vector<std::string> comparison_names(const std::vector<MethodSpec>& methods) {
  std::map<std::string, std::vector<const MethodSpec*>> alike;
  for (const MethodSpec& method : methods) alike[describe(method).name].push_back(&method);
  std::vector<std::string> names;
  for (const MethodSpec& method : methods) names.push_back(unique_name(method, alike.at(describe(method).name)));
  return names;
}

bool has_own_tolerance(const MethodSpec& method) {
  return describe(method).own_substeps && method.options.contains(tolerance_option);
}

std::vector<ComparisonJob> comparison_jobs(const ComparisonRequest& asked) {
  std::vector<ComparisonJob> jobs;
  const int digits = digits_of(asked.request.arithmetic);
  const std::string t_end = asked.t_end_text.empty() ? shortest(asked.t_end) : asked.t_end_text;
  const std::vector<std::string> names = comparison_names(asked.methods);
  for (std::size_t m = 0; m < asked.methods.size(); ++m) {
    const std::size_t first = jobs.size();
    const bool own_tolerance = has_own_tolerance(asked.methods[m]);
    for (std::size_t k = 0; k < (own_tolerance ? 1 : asked.steps.size()); ++k) {
      ComparisonJob job{m, asked.request, {}};
      job.request.method = asked.methods[m];
      job.request.watch = true;
      ComparisonPoint& point = job.point;
      point.steps = asked.steps[k];
      point.method = names[m];  // the name as requested, because the tolerance varies like dt
      if (describe(asked.methods[m]).own_substeps) {
        if (!own_tolerance) {
          job.request.method.options[tolerance_option] = shortest(usual_tolerance(k, asked.steps.size(), digits));
        }
        point.tolerance = number_value(job.request.method.options[tolerance_option]);
        point.steps = adaptive_steps;
      }
      point.dt = asked.t_end / static_cast<double>(point.steps);
      if (const auto typed = asked.dts.find(point.steps); typed != asked.dts.end()) {
        job.request.dt = typed->second;
        point.dt = evaluate_number<double>(typed->second);
      } else {
        job.request.dt = digits_beyond_double(asked.request.arithmetic) > 0
                             ? "(" + t_end + ")/" + std::to_string(point.steps)
                             : shortest(point.dt);
      }
      const MethodInfo info = describe(job.request.method);
      point.order = info.order;
      point.explicit_step = info.explicit_step;
      jobs.push_back(std::move(job));
      jobs.back().work = relative_work(jobs[first].point, jobs.back().point);
    }
  }
  return jobs;
}

double seconds_of_timing(double seconds, bool beyond_double) {
  const double repeats = std::max(0.02, std::min(7 * seconds, std::max(seconds, 0.25)));
  return beyond_double && seconds > 0.02 ? seconds : seconds + repeats;
}

void ComparisonClock::reference_spent(double seconds, double part) {
  reference_seconds_ += seconds;
  reference_part_ = part;
}

/// Estimates from the last finished run of the method.
std::optional<double> ComparisonClock::expected(const ComparisonJob& job) const {
  const ComparisonJob* known = nullptr;
  for (const ComparisonJob& other : jobs_) {
    if (other.method == job.method && other.finished) known = &other;
  }
  if (known == nullptr) return std::nullopt;
  return seconds_of_timing(known->seconds * job.work / known->work, beyond_double_);
}

ComparisonProgress ComparisonClock::look(const ComparisonJob* running, double part) {
  ComparisonProgress now;
  now.runs = jobs_.size();
  now.part = shown_;
  double left = 0;
  bool known = reference_part_ > 0;
  if (known) left += reference_seconds_ / reference_part_ * (1 - reference_part_);
  for (const ComparisonJob& job : jobs_) {
    if (job.finished) {
      ++now.done;
      continue;
    }
    const std::optional<double> seconds = expected(job);
    known = known && seconds;
    if (seconds) left += *seconds * (&job == running ? 1 - part : 1);
  }
  if (!known) return now;
  const double spent = std::chrono::duration<double>(Clock::now() - begin_).count();
  // if the estimate of the remaining time grows, the shown progress stays
  shown_ = std::max(shown_, spent > 0 ? spent / (spent + left) : 0);
  now.part = shown_;
  now.seconds_left = left;
  return now;
}

std::vector<std::string> comparison_notes(const ComparisonRequest& asked) {
  std::vector<std::string> notes;
  const std::vector<std::string> names = comparison_names(asked.methods);
  for (std::size_t m = 0; m < asked.methods.size(); ++m) {
    const MethodSpec& method = asked.methods[m];
    if (!describe(method).own_substeps) continue;
    const std::string why = names[m] + " chooses its sub-steps by its tolerance and not by dt, so ";
    if (has_own_tolerance(method)) {
      notes.push_back(why + "it has one row, with the given tolerance");
    } else if (asked.steps.size() > 1) {
      notes.push_back(why + "its rows have different tolerances");
    } else {
      notes.push_back(why + "its row has the default tolerance");
    }
  }
  // With many coordinates the reference takes longer than all runs of the comparison, and shows no progress.
  constexpr std::size_t many = 1000;
  const std::size_t coordinates = asked.request.start.q.size();
  if (coordinates >= many && !find_problem(asked.request)->exact) {
    notes.push_back("the reference, " + std::to_string(coordinates) + " coordinates in " +
                    reference_arithmetic(asked.request.arithmetic) +
                    ", takes most of the time; a smaller run.steps or run.t_end, or fewer particles, make it faster");
  }
  return notes;
}

}  // namespace hamflow
