// run.section: the points of a Poincare section, recorded beside the samples.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "measure.hpp"
#include "measure_list.hpp"
#include "number_text.hpp"
#include "recorder.hpp"
#include "run_keys.hpp"

namespace hamflow {

namespace {

using Json = nlohmann::ordered_json;

class SectionMeasure final : public Measure {
 public:
  SectionMeasure(const Scenario& scenario, const Simulation& simulation, Recorder* recorder)
      : finder_(simulation, *scenario.section, [recorder](const SectionPoint& point) {
          if (recorder != nullptr) recorder->append(point);
        }) {}
  Observer& observer() override { return finder_; }
  std::int64_t unseen_steps() const override { return finder_.unseen(); }
  Json summary() const override {
    Json all{{"points", finder_.points()}, {"max_residual", finder_.max_residual()}};
    if (const std::string message = finder_.search().message(); !message.empty()) all["message"] = message;
    return all;
  }

 private:
  SectionFinder finder_;
};

}  // namespace

MeasureKind measure_section() {
  return {.key = run_keys().section.name,
          .label = "section",
          .requested = [](const Scenario& scenario) { return scenario.section.has_value(); },
          .make_of_run = [](const Scenario& scenario, const Simulation& simulation, Recorder* recorder)
              -> std::unique_ptr<Measure> { return std::make_unique<SectionMeasure>(scenario, simulation, recorder); },
          .text =
              [](const Json& found) {
                const auto points = found["points"].get<std::size_t>();
                std::string line = counted(points, "point");
                if (points > 0)
                  line += fmt::format(", at most {} off it", number_text(found["max_residual"], "{:.2g}"));
                return line + (found.contains("message") ? "; " + found["message"].get<std::string>() : "");
              }};
}

}  // namespace hamflow
