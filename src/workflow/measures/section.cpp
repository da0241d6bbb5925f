// run.section: locates the points of a Poincare section and records them.
#include <fmt/format.h>

#include "measure.hpp"
#include "measure_list.hpp"
#include "number_text.hpp"
#include "recorder.hpp"
#include "run_keys.hpp"
#include "summary_fields.hpp"

namespace hamflow {

namespace {

class SectionMeasure final : public Measure {
 public:
  SectionMeasure(const Scenario& scenario, const Simulation& simulation, Recorder* recorder)
      : finder_(simulation, *scenario.section, [recorder](const SectionPoint& point) {
          if (recorder != nullptr) recorder->append(point);
        }) {}
  Observer& observer() override { return finder_; }
  std::int64_t unseen_steps() const override { return finder_.unseen(); }
  void add_to(Summary& summary) const override {
    summary.section = {static_cast<std::int64_t>(finder_.points()), finder_.max_residual(), finder_.search().message()};
  }

 private:
  SectionFinder finder_;
};

std::string section_line(const SectionSummary& found) {
  std::string line = counted(static_cast<std::size_t>(found.points), "point");
  if (found.points > 0) line += fmt::format(", residual at most {}", number_text(found.max_residual, "{:.2g}"));
  return line + (found.message.empty() ? "" : "; " + found.message);
}

template <class Ar>
void section_entry(Ar& ar, Summary& summary) {
  ar.if_any(run_keys().section.name, summary.section);
}

}  // namespace

MeasureKind measure_section() {
  return {.key = run_keys().section.name,
          .label = "section",
          .requested = [](const Scenario& scenario) { return scenario.section.has_value(); },
          .make_of_run = [](const Scenario& scenario, const Simulation& simulation, Recorder* recorder)
              -> std::unique_ptr<Measure> { return std::make_unique<SectionMeasure>(scenario, simulation, recorder); },
          .write = section_entry,
          .read = section_entry,
          .text = [](const Summary& s) { return s.section ? section_line(*s.section) : std::string(); }};
}

}  // namespace hamflow
