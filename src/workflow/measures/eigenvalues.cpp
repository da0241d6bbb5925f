// run.eigenvalues: of the derivative of all steps; on a periodic orbit the Floquet multipliers.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "hamflow/verify/monodromy.hpp"
#include "measure.hpp"
#include "measure_list.hpp"
#include "number_text.hpp"
#include "run_keys.hpp"

namespace hamflow {

namespace {

using Json = nlohmann::ordered_json;

class EigenvalueMeasure final : public Measure {
 public:
  explicit EigenvalueMeasure(const Scenario& scenario) : watch_(step_map_of(scenario), scenario.dt, scenario.steps) {}
  Observer& observer() override { return watch_; }
  Json summary() const override {
    Json all;
    try {
      if (!watch_.followed()) throw Error("a step could not be differentiated");
      const SymplecticEigenvalues found = symplectic_eigenvalues(watch_.rows());
      all["values"] = Json::array();
      for (const auto& value : found.values) all["values"].push_back({value.real(), value.imag()});
      all["pair_defect"] = found.pair_defect;
      all["symplectic_defect"] = found.symplectic_defect;
      all["norm"] = found.norm;
    } catch (const Error& error) {  // chaos overflows in the end: the run itself is none the worse
      all = {{"values", nullptr}, {"message", error.what()}};
    }
    all["steps"] = watch_.step();
    return all;
  }

 private:
  MonodromyWatch watch_;
};

std::string eigenvalues_text(const Json& found) {
  if (found["values"].is_null()) return found["message"].get<std::string>();
  constexpr std::size_t most_shown = 6;
  std::string line;
  for (std::size_t i = 0; i < std::min(found["values"].size(), most_shown); ++i) {
    const Json& imaginary = found["values"][i][1];
    line += (i > 0 ? ", " : "") + number_text(found["values"][i][0], "{:.6g}") +
            (imaginary != 0 ? number_text(imaginary, "{:+.6g}") + "i" : "");
  }
  if (found["values"].size() > most_shown) line += ", ...";
  return line + fmt::format("; products of pairs {} off 1, {} off symplectic",
                            number_text(found["pair_defect"], "{:.2g}"),
                            number_text(found["symplectic_defect"], "{:.2g}"));
}

}  // namespace

MeasureKind measure_eigenvalues() {
  return {.key = run_keys().eigenvalues.name,
          .label = "eigenvalues",
          .requested = [](const Scenario& scenario) { return scenario.eigenvalues; },
          .make = [](const Scenario& scenario, const Simulation&, Recorder*) -> std::unique_ptr<Measure> {
            return std::make_unique<EigenvalueMeasure>(scenario);
          },
          .text = eigenvalues_text};
}

}  // namespace hamflow
