// output.observables: expressions of the user, averaged over every step; in a sweep three columns each.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "hamflow/core/text.hpp"
#include "hamflow/run/step_sums.hpp"
#include "measure.hpp"
#include "measure_list.hpp"
#include "number_text.hpp"
#include "run_keys.hpp"

namespace hamflow {

namespace {

using Json = nlohmann::ordered_json;

/// The values of one expression over a run.
struct Seen {
  double initial = 0;
  double final = 0;
};

class ObservablesMeasure final : public Measure, public Observer, public SummedSteps {
 public:
  explicit ObservablesMeasure(const std::vector<NamedExpression>& observables)
      : observables_(observables), seen_(observables.size()), sums_(observables.size()) {}

  Observer& observer() override { return *this; }
  std::int64_t next_due(std::int64_t step) const override { return step; }
  Verdict observe(const Frame& frame) override {
    if (frame.step <= steps_) return Verdict::go_on;  // a run that goes on shows its last state again
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      const double x = observables_[i].expression(frame);
      if (frame.step > 0) {
        seen_[i].final = x;
        sums_[i].add(x);
      } else {
        seen_[i].initial = seen_[i].final = x;
      }
    }
    steps_ = frame.step;
    return Verdict::go_on;
  }
  SummedSteps* summing() override { return this; }
  std::span<const NamedExpression> summed() const override { return observables_; }
  std::span<StepSum> sums() override { return sums_; }
  void reach(const Frame& last) override {
    for (std::size_t i = 0; i < seen_.size(); ++i) seen_[i].final = observables_[i].expression(last);
    steps_ = last.step;
  }
  void archive(Writer& ar) override { fields(ar); }
  void archive(Reader& ar) override { fields(ar); }

  /// {initial, mean, final} of each; without steps the mean is the initial value.
  std::vector<double> row() const override {
    std::vector<double> all;
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      const double mean = steps_ > 0 ? sums_[i].value() / static_cast<double>(steps_) : seen_[i].initial;
      all.insert(all.end(), {seen_[i].initial, mean, seen_[i].final});
    }
    return all;
  }
  Json summary() const override {
    Json all = Json::object();
    const std::vector<double> found = row();
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      all[observables_[i].name] = {{"initial", found[3 * i]}, {"mean", found[3 * i + 1]}, {"final", found[3 * i + 2]}};
    }
    return all;
  }

 private:
  template <class Archive>
  void fields(Archive& ar) {
    ar(steps_);
    for (std::size_t i = 0; i < seen_.size(); ++i) ar(seen_[i].initial, seen_[i].final, sums_[i]);
  }

  const std::vector<NamedExpression>& observables_;
  std::vector<Seen> seen_;
  std::vector<StepSum> sums_;
  std::int64_t steps_ = -1;  // the last that was seen
};

std::vector<std::string> columns_of_observables(const Scenario& first) {
  std::vector<std::string> all;
  for (const NamedExpression& each : first.observables) {
    for (const char* what : {"_initial", "_mean", "_final"}) all.push_back(each.name + what);
  }
  return all;
}

}  // namespace

MeasureKind measure_observables() {
  return {.key = output_keys().observables.name,
          .label = "observables",
          .requested = [](const Scenario& scenario) { return !scenario.observables.empty(); },
          .make = [](const Scenario& scenario) -> std::unique_ptr<Measure> {
            return std::make_unique<ObservablesMeasure>(scenario.observables);
          },
          .text =
              [](const Json& found) {
                std::vector<std::string> all;
                for (const auto& [name, seen] : found.items()) {
                  all.push_back(fmt::format("{} {} -> {}, mean {}", name, value_text(seen["initial"], "{:.6g}"),
                                            value_text(seen["final"], "{:.6g}"), value_text(seen["mean"], "{:.17g}")));
                }
                return joined(all, "; ");
              },
          .columns = columns_of_observables};
}

}  // namespace hamflow
