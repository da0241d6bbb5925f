// What the page does without, to be small: figures for print, derivatives of steps, and arithmetics beyond double.
// Stands in for src/figures and files of src/steps.
#include "engine/erased.hpp"
#include "figure_kinds.hpp"

namespace hamflow {

std::unique_ptr<StepMap> erased_step_map(const ErasedProblem&, const Request&) { return nullptr; }

namespace {
[[noreturn]] void refuse(const std::string& arithmetic) {
  throw Error("found arithmetic " + arithmetic +
              "; the laboratory allows double, compensated and lattice; the command allows all");
}
}  // namespace
template <>
std::unique_ptr<Simulation> simulate_erased<DoubleDouble>(const ErasedRun<DoubleDouble>&, const Request& request) {
  refuse(request.arithmetic);
}
template <>
std::unique_ptr<Simulation> simulate_erased<Quad>(const ErasedRun<Quad>&, const Request& request) {
  refuse(request.arithmetic);
}

/// No kind is known, and any name is accepted: a scenario of the command keeps its figures.
std::span<const FigureKindInfo> figure_kinds() { return {}; }
const std::vector<std::string>& figure_names() {
  static const std::vector<std::string> none;
  return none;
}
std::vector<std::string> drawable_figures(const FigureFacts&) { return {}; }
std::string unknown_figure(const std::string&) { return {}; }
std::string refused_figure(const std::string&, const FigureFacts&) { return {}; }
std::string usual_figure(const FigureFacts&) { return {}; }

}  // namespace hamflow
