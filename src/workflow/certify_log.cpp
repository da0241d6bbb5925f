#include "hamflow/workflow/certify_log.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "hamflow/core/complaint.hpp"
#include "json_text.hpp"
#include "log_columns.hpp"

namespace hamflow {

namespace {
using Json = nlohmann::ordered_json;
}

CertifiedLog certify_file(const std::filesystem::path& file, const std::string& time, const std::string& energy,
                          std::optional<double> scale) {
  const LogColumns columns = read_log_columns(file, time, energy);
  if (const auto at = first_time_that_does_not_rise(columns.time); at && !columns.lines.empty()) {
    throw Rejection({{.file = file.string(),
                      .line = static_cast<int>(columns.lines[*at]),
                      .column = 1,
                      .message = fmt::format("found the time {} after {}; allowed strictly increasing times",
                                             columns.time[*at], columns.time[*at - 1])}});
  }
  CertifiedLog found{certify_log(columns.time, columns.energy, scale), {}};
  if (columns.tables > 1) {
    found.notes.push_back(fmt::format("{} has {} tables; only the last one is read ({} rows)", file.string(),
                                      columns.tables, columns.time.size()));
  }
  if (columns.cut_line > 0) {
    found.notes.push_back(fmt::format("{}:{}: the last line has no line end, so it may be incomplete; it is left out",
                                      file.string(), columns.cut_line));
  }
  return found;
}

std::string log_certificate_json(const LogCertificate& certificate) {
  const RunDrift& drift = certificate.drift;
  const auto or_null = [](const auto& x) { return x ? Json(*x) : Json(nullptr); };
  return json_text({{"drift", drift.drift ? name(*drift.drift) : "undecided"},
                    {"energy_level", or_null(certificate.energy_level)},
                    {"growth_exponent", or_null(certificate.growth_exponent())},
                    {"reason", drift.reason},
                    {"samples", certificate.samples},
                    {"periods", or_null(drift.periods)},
                    {"scale", or_null(certificate.scale)}});
}

std::string log_certificate_text(const LogCertificate& certificate) {
  const RunDrift& drift = certificate.drift;
  std::string text =
      fmt::format("drift            {}: {}\n", drift.drift ? name(*drift.drift) : "undecided", drift.reason);
  if (certificate.energy_level) {
    text += fmt::format("energy error     {:.3g} of the scale {:.6g}\n", *certificate.energy_level, *certificate.scale);
  } else {
    text += "energy error     unknown: the first energy is 0; give the energy to divide by with --scale\n";
  }
  const auto exponent = certificate.growth_exponent();
  text += exponent ? fmt::format("growth exponent  {:.2f} +- {:.2f}\n", *exponent, drift.growth_uncertainty)
                   : "growth exponent  unknown\n";
  text += fmt::format("samples          {}\n", certificate.samples);
  return text + (drift.periods ? fmt::format("oscillations     {:.3g} seen in the energy\n", *drift.periods)
                               : "oscillations     none seen in the energy\n");
}

}  // namespace hamflow
