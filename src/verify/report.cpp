// Writes the property table as text and as JSON.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "aligned.hpp"
#include "hamflow/verify/measure.hpp"

namespace hamflow {

std::string aligned(const Lines& lines) {
  std::vector<std::size_t> width;
  const auto is_remark = [&](const std::vector<std::string>& line, std::size_t i) {
    return i + 1 == line.size() && line.size() < lines.front().size();
  };
  for (const auto& line : lines) {
    width.resize(std::max(width.size(), line.size()));
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (!is_remark(line, i)) width[i] = std::max(width[i], line[i].size());
    }
  }
  std::string out;
  for (const auto& line : lines) {
    std::string row;
    for (std::size_t i = 0; i < line.size(); ++i) row += fmt::format("{:<{}}  ", line[i], width[i]);
    row.erase(row.find_last_not_of(' ') + 1);
    out += row + '\n';
  }
  return out;
}

namespace {
std::string flag(Finding agrees) { return agrees == Finding::yes ? "" : agrees == Finding::no ? " !!" : " ??"; }

/// Writes a number, or a dash if it was not measured.
template <class Format>
std::string number(Format format, double x) {
  return std::isnan(x) ? "-" : fmt::format(format, x);
}
std::string units(const DefectMeasurement& d) {
  return number(FMT_STRING("{:.0e}"), d.defect) + fmt::format(" ({})", name(d.holds));
}
std::string_view name_of(const std::optional<DriftClass>& drift) { return drift ? name(*drift) : "undecided"; }

/// Adds the reason, if there is one.
nlohmann::json with_reason(nlohmann::json all, const std::string& reason) {
  if (!reason.empty()) all["reason"] = reason;
  return all;
}

nlohmann::json json_of(const DefectMeasurement& d) {
  return with_reason({{"defect", d.defect}, {"units_of_rounding", d.units}, {"holds", name(d.holds)}}, d.reason);
}

nlohmann::json json_of(Finding agrees) {
  return agrees == Finding::unclear ? nlohmann::json(nullptr) : nlohmann::json(agrees == Finding::yes);
}

/// Returns whether long runs were measured. They are not measured for steps that bounce off walls.
bool has_runs(const PropertyRow& row) { return row.has("energy conserving"); }

nlohmann::json json_of(const Measurement& m, bool with_runs) {
  const EnergyMeasurement& e = m.energy;
  nlohmann::json all{{"problem", m.problem},
                     {"order", with_reason({{"slope", m.order.slope},
                                            {"points", m.order.points},
                                            {"finest_step", m.order.finest_step},
                                            {"finest_error", m.order.finest_error}},
                                           m.order.reason)},
                     {"jacobian", json_of(m.jacobian)},
                     {"symplectic", json_of(m.symplectic)},
                     {"weakly_reversible", json_of(m.weakly_reversible)},
                     {"symmetric", json_of(m.symmetric)},
                     {"reversible", json_of(m.reversible)}};
  if (!with_runs) return all;
  all.update({{"energy", with_reason({{"step", e.step},
                                      {"level", e.level},
                                      {"rounding", e.rounding},
                                      {"fine_level", e.fine_level},
                                      {"fine_rounding", e.fine_rounding},
                                      {"step_exponent", e.step_exponent},
                                      {"drift", name_of(e.drift.drift)},
                                      {"growth_exponent", e.drift.growth_exponent},
                                      {"p_value", e.drift.p_value}},
                                     e.reason)},
              {"cost", with_reason({{"force", m.cost.force},
                                    {"gradient", m.cost.gradient},
                                    {"hessian", m.cost.hessian},
                                    {"linear_solves", m.cost.linear_solves},
                                    {"coarse_solves", m.cost.coarse_solves}},
                                   m.cost.reason)}});
  return all;
}
/// @param yes the word for an invariant that is conserved
const char* kept(const MethodCertificate::Map& m, const char* yes) {
  return !m.conserved ? "undecided" : *m.conserved ? yes : "not";
}
nlohmann::json json_of(const MethodCertificate& c) {
  nlohmann::json maps = nlohmann::json::array();
  for (const MethodCertificate::Map& m : c.momentum_maps) {
    maps.push_back(with_reason({{"problem", m.problem},
                                {"name", m.name},
                                {"steps", m.steps},
                                {"max_error", m.max_error},
                                {"relative", m.relative},
                                {"rounding", m.rounding},
                                {"conserved", kept(m, "to rounding")}},
                               m.reason));
  }
  nlohmann::json returns = nlohmann::json::array();
  for (const MethodCertificate::Return& r : c.reversals) {
    returns.push_back({{"problem", r.problem},
                       {"steps", r.steps},
                       {"relative", r.measured ? nlohmann::json(r.distance) : nlohmann::json(nullptr)},
                       {"proves", r.proves},
                       {"reason", r.reason}});
  }
  return {{"drift", name_of(c.drift)}, {"momentum_maps", maps}, {"reversal_distance", returns}};
}

/// One line for each method, one column for each momentum map and each reversal that any method has.
std::string certificates(std::span<const PropertyRow> rows) {
  Lines lines{{"method", "energy drift"}};
  const auto column = [&](const std::string& heading) {
    auto& headings = lines.front();
    const auto found = std::find(headings.begin(), headings.end(), heading);
    if (found != headings.end()) return static_cast<std::size_t>(found - headings.begin());
    headings.push_back(heading);
    return headings.size() - 1;
  };
  const auto map_heading = [](const auto& m) { return m.name + ", " + m.problem; };
  const auto return_heading = [](const auto& r) { return "back, " + r.problem; };
  for (const PropertyRow& row : rows) {
    for (const auto& m : row.certificate.momentum_maps) (void)column(map_heading(m));
  }
  for (const PropertyRow& row : rows) {
    for (const auto& r : row.certificate.reversals) (void)column(return_heading(r));
  }
  for (const PropertyRow& row : rows) {
    if (!has_runs(row)) continue;
    const MethodCertificate& c = row.certificate;
    std::vector<std::string> line(lines.front().size(), "-");
    line[0] = row.claims.name;
    line[1] = name_of(c.drift);
    for (const auto& m : c.momentum_maps) {
      line[column(map_heading(m))] =
          m.conserved ? fmt::format("{} ({:.0e})", kept(m, "kept"), m.relative) : kept(m, "kept");
    }
    for (const auto& r : c.reversals) {
      line[column(return_heading(r))] =
          !r.measured ? "failed" : fmt::format("distance {:.0e}: {}", r.distance, r.proves);
    }
    lines.push_back(line);
  }
  return aligned(lines);
}

std::string verdict(const PropertyRow& row) {
  std::string differs;
  std::string unclear;
  for (const PropertyCell& c : row.cells) {
    if (c.agrees == Finding::no) differs += (differs.empty() ? "DIFFERS: " : ", ") + c.property;
    if (c.agrees == Finding::unclear) unclear += (unclear.empty() ? "unclear: " : ", ") + c.property;
  }
  return row.agrees() ? "agrees" : differs + (differs.empty() || unclear.empty() ? "" : "; ") + unclear;
}

/// Lists what was not measured, one line each; empty if everything was.
std::string not_measured(std::span<const PropertyRow> rows) {
  Lines lines{{"method", "problem", "what", "why"}};
  for (const PropertyRow& row : rows) {
    const std::string& method = row.claims.name;
    for (const Measurement& m : row.on) {
      const auto add = [&](const char* what, const std::string& reason) {
        if (!reason.empty()) lines.push_back({method, m.problem, what, reason});
      };
      add("order", m.order.reason);
      add("symplectic", m.symplectic.reason);
      add("weakly reversible", m.weakly_reversible.reason);
      add("symmetric", m.symmetric.reason);
      add("reversible", m.reversible.reason);
      add("Jacobian is the step's", m.jacobian.reason);
      if (!has_runs(row)) continue;
      add("energy", m.energy.reason);
      add("evaluations per step", m.cost.reason);
    }
    if (!has_runs(row)) continue;
    for (const auto& m : row.certificate.momentum_maps) {
      if (!m.reason.empty()) lines.push_back({method, m.problem, m.name, m.reason});
    }
  }
  return lines.size() == 1 ? "" : "\nproperties that were not fully measured\n" + aligned(lines);
}

/// For a p-value below the smallest normal number, only a bound is written.
std::string p_value(double p) {
  if (p < std::numeric_limits<double>::min()) return "<2e-308";
  return number(FMT_STRING("{:.1g}"), p);
}
}  // namespace

std::string property_table(std::span<const PropertyRow> rows) {
  // The cells contain claimed/measured. Full names of the columns follow below the table.
  Lines table{{"method", "order", "explicit", "symplectic", "weakly rev.", "symmetric", "reversible",
               "energy conserving", "forces/step", "Newton", "verdict"}};
  const std::vector<std::string> properties{
      "order",      "explicit",          "symplectic",      "weakly reversible", "symmetric",
      "reversible", "energy conserving", "forces per step", "Newton corrections"};
  for (const PropertyRow& row : rows) {
    std::vector<std::string> line{row.claims.name};
    for (const std::string& property : properties) {
      const auto c = std::find_if(row.cells.begin(), row.cells.end(),
                                  [&](const PropertyCell& x) { return x.property == property; });
      line.push_back(c == row.cells.end() ? "" : c->claimed + " / " + c->measured + flag(c->agrees));
    }
    line.push_back(verdict(row));
    table.push_back(line);
  }
  Lines structure{{"method", "problem", "order", "(points)", "symplectic", "weakly rev.", "symmetric", "reversible"}};
  Lines energy{{"method", "problem", "level", "rounding", "~ h^c", "fine level", "drift", "~ t^e", "p", "force",
                "Hessian", "solves"}};
  for (const PropertyRow& row : rows) {
    for (const Measurement& m : row.on) {
      const EnergyMeasurement& e = m.energy;
      structure.push_back({row.claims.name, m.problem, number(FMT_STRING("{:.3f}"), m.order.slope),
                           std::to_string(m.order.points), units(m.symplectic), units(m.weakly_reversible),
                           units(m.symmetric), units(m.reversible)});
      if (!has_runs(row)) continue;
      energy.push_back({row.claims.name, m.problem, number(FMT_STRING("{:.1e}"), e.level),
                        fmt::format("{:.1e}", e.rounding), number(FMT_STRING("{:.1f}"), e.step_exponent),
                        number(FMT_STRING("{:.1e}"), e.fine_level), std::string(name_of(e.drift.drift)),
                        number(FMT_STRING("{:.2f}"), e.drift.growth_exponent), p_value(e.drift.p_value),
                        number(FMT_STRING("{:.4g}"), m.cost.force), number(FMT_STRING("{:.4g}"), m.cost.hessian),
                        number(FMT_STRING("{:.4g}"), m.cost.linear_solves)});
    }
  }
  std::string notes;
  for (const PropertyRow& row : rows) {
    if (row.measured_as.empty()) continue;
    notes += row.claims.name + " was measured as " + row.measured_as + ", because adaptive sub-steps have no order\n";
  }
  return "claimed / measured   (!! differs, ?? unclear)\n" + aligned(table) + notes +
         "\norder and structure: defects\n" + aligned(structure) +
         "\nenergy, largest |H - H0|/scale, and evaluations per step\n" + aligned(energy) +
         "\ncertificates: conservation in long runs\n" + certificates(rows) + not_measured(rows);
}

std::string property_json(std::span<const PropertyRow> rows) {
  nlohmann::json all = nlohmann::json::array();
  for (const PropertyRow& row : rows) {
    nlohmann::json properties = nlohmann::json::array();
    for (const PropertyCell& c : row.cells) {
      properties.push_back(with_reason(
          {{"property", c.property}, {"claimed", c.claimed}, {"measured", c.measured}, {"agrees", json_of(c.agrees)}},
          c.reason));
    }
    nlohmann::json on = nlohmann::json::array();
    for (const Measurement& m : row.on) on.push_back(json_of(m, has_runs(row)));
    all.push_back({{"method", row.claims.name},
                   {"reference", row.claims.reference},
                   {"agrees", json_of(row.verdict())},
                   {"properties", properties},
                   {"certificate", has_runs(row) ? json_of(row.certificate) : nlohmann::json(nullptr)},
                   {"measurements", on}});
    if (!row.measured_as.empty()) all.back()["measured_as"] = row.measured_as;
  }
  return nlohmann::json{{"methods", all}}.dump(2) + "\n";
}

}  // namespace hamflow
