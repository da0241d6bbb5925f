// What the page does without, to be small: figures for print and clients that compute forces. Stands in for src/figures
// and src/socket/force_server.cpp.
#include "figure_kinds.hpp"
#include "socket/force_server.hpp"

namespace hamflow {

std::string refused_address(const std::string&) { return "not in the laboratory; allowed in the command"; }
std::shared_ptr<ForceServer> ForceServer::at(const std::string&) { return nullptr; }
ForceServer::~ForceServer() = default;
void ForceServer::evaluate(const std::vector<double>&, const Cell&, double, WireForces&) {}
void ForceServer::restart() {}

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
