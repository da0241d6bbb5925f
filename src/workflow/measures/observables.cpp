// output.observables: expressions of the user, averaged over every step. A sweep has three columns for each.
#include <fmt/format.h>

#include "hamflow/core/text.hpp"
#include "hamflow/detail/run/step_sums.hpp"
#include "measure.hpp"
#include "measure_list.hpp"
#include "number_text.hpp"
#include "run_keys.hpp"
#include "summary_fields.hpp"

namespace hamflow {

namespace {

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
    if (frame.step <= steps_) return Verdict::go_on;  // a resumed run observes its last state a second time
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

  /// Returns {initial, mean, final} for each; without steps the mean is the initial value.
  std::vector<double> row() const override {
    std::vector<double> all;
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      const double mean = steps_ > 0 ? sums_[i].value() / static_cast<double>(steps_) : seen_[i].initial;
      all.insert(all.end(), {seen_[i].initial, mean, seen_[i].final});
    }
    return all;
  }
  void add_to(Summary& summary) const override {
    const std::vector<double> found = row();
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      summary.observables.push_back({observables_[i].name, found[3 * i], found[3 * i + 1], found[3 * i + 2]});
    }
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
  std::int64_t steps_ = -1;  // last observed step
};

std::vector<std::string> columns_of_observables(const Scenario& first) {
  std::vector<std::string> all;
  for (const NamedExpression& each : first.observables) {
    for (const char* what : {"_initial", "_mean", "_final"}) all.push_back(each.name + what);
  }
  return all;
}

template <class Ar>
void observables_entry(Ar& ar, Summary& summary) {
  if (Ar::reading || !summary.observables.empty()) {
    ar.by_name(output_keys().observables.name, summary.observables);
  }
}

}  // namespace

MeasureKind measure_observables() {
  return {.key = output_keys().observables.name,
          .label = "observables",
          .requested = [](const Scenario& scenario) { return !scenario.observables.empty(); },
          .make = [](const Scenario& scenario) -> std::unique_ptr<Measure> {
            return std::make_unique<ObservablesMeasure>(scenario.observables);
          },
          .write = observables_entry,
          .read = observables_entry,
          .text =
              [](const Summary& s) {
                return joined(
                    s.observables,
                    [](const ObservableSummary& seen) {
                      return fmt::format("{} {} -> {}, mean {}", seen.name, value_text(seen.initial, "{:.6g}"),
                                         value_text(seen.final, "{:.6g}"), value_text(seen.mean, "{:.17g}"));
                    },
                    "; ");
              },
          .columns = columns_of_observables};
}

}  // namespace hamflow
