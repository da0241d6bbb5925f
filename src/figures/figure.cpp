#include "figure.hpp"

#include <algorithm>

#include "figure_kind.hpp"
#include "hamflow/core/error.hpp"
#include "hamflow/core/text.hpp"

namespace hamflow {

namespace {
/// Lists that belong together have to be equally long.
std::string inconsistency(const FigureData& data) {
  if (data.space == 0 && data.coordinates.size() != data.q.size()) {
    return "there are " + std::to_string(data.coordinates.size()) + " names of coordinates for " +
           std::to_string(data.q.size()) + " coordinates";
  }
  const auto differs = [&](const std::vector<double>& x) { return x.size() != data.t.size(); };
  if (std::any_of(data.q.begin(), data.q.end(), differs)) return "q and t have different numbers of samples";
  if (std::any_of(data.p.begin(), data.p.end(), differs)) return "p and t have different numbers of samples";
  if (!data.energy.empty() && differs(data.energy)) return "energy and t have different numbers of samples";
  if (data.curve_x.size() != data.curve_y.size()) return "the exact curve has more numbers on one axis than the other";
  return "";
}

std::string obstacle(const FigureData& data, const figures::FigureKind& kind) {
  const std::string wrong = inconsistency(data);
  return wrong.empty() ? kind.obstacle(data) : wrong;
}
}  // namespace

FigureFacts facts_of(const FigureData& data) {
  return {.degrees_of_freedom = data.q.size(),
          .bodies_in_space = data.space >= 2,
          .diagnostics = !data.diagnostics.empty(),
          .section = !data.section_coordinate.empty()};
}

std::string why_not(const FigureData& data, const std::string& kind) {
  const FigureFacts facts = facts_of(data);
  const std::string refused = refused_figure(kind, facts);
  if (!refused.empty()) return refused;
  const std::string reason = obstacle(data, *figures::find_kind(kind));
  if (reason.empty()) return "";
  std::vector<std::string> others = drawable_figures(facts);
  std::erase_if(others, [&](const std::string& name) { return !obstacle(data, *figures::find_kind(name)).empty(); });
  return "found \"" + kind + "\", but " + reason +
         (others.empty() ? "; no other figure can be drawn of these samples either" : "; allowed " + joined(others));
}

void write_figure(const FigureData& data, const std::string& kind, const std::filesystem::path& file) {
  const std::string wrong_file = refused_figure_file(file);
  const std::string reason = why_not(data, kind);
  if (!reason.empty()) throw Error(reason);
  if (!wrong_file.empty()) throw Error(wrong_file);
  figures::draw(figures::find_kind(kind)->page(data), file);
}

}  // namespace hamflow
