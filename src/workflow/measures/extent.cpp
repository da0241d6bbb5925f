// run.extent: the largest |q|, the Euclidean length of all positions together, over every step.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "measure.hpp"
#include "measure_list.hpp"
#include "run_keys.hpp"

namespace hamflow {

namespace {

using Json = nlohmann::ordered_json;

/// Looks at every step, the start included.
class ExtentWatch final : public Observer {
 public:
  std::int64_t next_due(std::int64_t step) const override { return step; }
  Verdict observe(const Frame& frame) override {
    double square = 0;
    for (const double x : frame.q) square += x * x;
    if (square > square_) {
      square_ = square;
      time_ = frame.time;
    }
    return Verdict::go_on;
  }
  void archive(Writer& ar) override { fields(ar); }
  void archive(Reader& ar) override { fields(ar); }
  Json summary() const { return {{"largest", std::sqrt(square_)}, {"time", time_}}; }

 private:
  template <class Archive>
  void fields(Archive& ar) {
    ar(square_, time_);
  }
  double square_ = 0;
  double time_ = 0;
};

class ExtentMeasure final : public Measure {
 public:
  Observer& observer() override { return watch_; }
  Json summary() const override { return watch_.summary(); }

 private:
  ExtentWatch watch_;
};

}  // namespace

MeasureKind measure_extent() {
  return {.key = run_keys().extent.name,
          .label = "largest |q|",
          .requested = [](const Scenario& scenario) { return scenario.extent; },
          .make = [](const Scenario&, const Simulation&, Recorder*) -> std::unique_ptr<Measure> {
            return std::make_unique<ExtentMeasure>();
          },
          .text =
              [](const Json& found) {
                return fmt::format("{:.9g} at t = {:.6g}", found["largest"].get<double>(), found["time"].get<double>());
              }};
}

}  // namespace hamflow
