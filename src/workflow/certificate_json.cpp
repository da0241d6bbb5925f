#include "certificate_json.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "number_text.hpp"

namespace hamflow {

namespace {
using Json = nlohmann::ordered_json;

Json reversal_json(const ReversalEvidence& back) {
  const auto known = [](const std::optional<LongNumber>& x) { return x ? json_of(*x) : Json(nullptr); };
  return {{"steps", back.steps},
          {"share", back.share},
          {"bounces", back.bounces},
          {"distance", known(back.distance)},
          {"relative", known(back.relative)},
          {"bit_exact", back.bit_exact},
          {"proves", std::string(name(back.proves))},
          {"reason", back.reason}};
}
}  // namespace

Json certificate_json(const RunCertificate& c) {
  const RunDrift& d = c.drift;
  const bool measured = d.blocks >= RunDrift::fewest_blocks;
  const auto known = [&](const LongNumber& x) { return measured ? json_of(x) : Json(nullptr); };
  Json all;
  all["drift"] = d.drift ? std::string(name(*d.drift)) : "undecided";
  all["reason"] = d.reason;
  all["p_value"] = known(d.p_value);
  all["sign_p_value"] = known(d.sign_p_value);
  all["growth_exponent"] = known(d.growth_exponent);
  all["growth_uncertainty"] = known(d.growth_uncertainty);
  all["mean_increment"] = known(c.mean_increment);
  all["mean_increment_error"] = known(c.mean_increment_error);
  all["trend_not_excluded"] = known(c.trend_not_excluded);
  all["blocks"] = d.blocks;
  all["periods"] = d.periods ? Json(*d.periods) : Json(nullptr);
  all["energy_level"] = json_of(c.energy_level);
  all["momentum_maps"] = Json::object();
  for (const MomentumMap& map : c.momentum_maps) {
    const auto conserved = map.conserved();
    all["momentum_maps"][map.name] = {{"max_error", json_of(map.max_error)},
                                      {"relative", json_of(map.relative)},
                                      {"rounding", map.rounding ? json_of(*map.rounding) : Json(nullptr)},
                                      {"conserved", !map.rounding ? Json(nullptr)
                                                    : !conserved  ? Json("undecided")
                                                    : *conserved  ? Json("to rounding")
                                                                  : Json("not")}};
  }
  all["reversal_distance"] = c.reversal ? reversal_json(*c.reversal) : Json(nullptr);
  return all;
}

/// In two digits: "0.25", "6.3", "100".
std::string percent_of(double share) {
  const double percent = 100 * share;
  return percent < 99.5 ? fmt::format("{:.2g}", percent) : fmt::format("{:.0f}", percent);
}

std::string certificate_text(const Json& c) {
  std::string text = fmt::format("energy error {}: {}", c["drift"].get<std::string>(), c["reason"].get<std::string>());
  for (const auto& [key, map] : c["momentum_maps"].items()) {
    if (map["conserved"].is_null()) continue;
    const auto kept = map["conserved"].get<std::string>();
    text += fmt::format("; {} {}", key,
                        kept == "not"         ? "not kept"
                        : kept == "undecided" ? "kept or not: its error may be of rounding or of the method"
                                              : "kept to rounding");
  }
  const Json& back = c["reversal_distance"];
  if (!back.is_null()) {
    const auto steps = back["steps"].get<long long>();
    const auto proves = back["proves"].get<std::string>();
    text += fmt::format("; {} step{} ({} % of the run) there and back{}: {}", steps, steps == 1 ? "" : "s",
                        percent_of(back["share"].get<double>()), proves == "nothing" ? " prove nothing" : ": " + proves,
                        back["reason"].get<std::string>());
  }
  return text;
}

}  // namespace hamflow
