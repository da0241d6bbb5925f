#include "certificate_json.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace hamflow {

namespace {
using Json = nlohmann::ordered_json;
}  // namespace

Json certificate_json(const RunCertificate& c) {
  const RunDrift& d = c.drift;
  Json all;
  all["drift"] = d.drift ? Json(std::string(name(*d.drift))) : Json(nullptr);
  all["reason"] = d.reason;
  const auto known = [&](double x) { return d.drift ? Json(x) : Json(nullptr); };
  all["p_value"] = known(d.p_value);
  all["sign_p_value"] = known(d.sign_p_value);
  all["growth_exponent"] = known(d.growth_exponent);
  all["growth_uncertainty"] = known(d.growth_uncertainty);
  all["blocks"] = d.blocks;
  all["mean_increment"] = known(d.mean_increment);
  all["mean_increment_error"] = known(d.mean_increment_error);
  all["energy_level"] = c.energy_level;
  all["momentum_maps"] = Json::object();
  for (const MomentumMap& map : c.momentum_maps) {
    const auto conserved = map.conserved();
    all["momentum_maps"][map.name] = {{"max_error", map.max_error},
                                      {"relative", map.relative},
                                      {"rounding", map.rounding ? Json(*map.rounding) : Json(nullptr)},
                                      {"conserved", !conserved   ? Json(nullptr)
                                                    : *conserved ? Json("to rounding")
                                                                 : Json("not")}};
  }
  all["reversal_distance"] = nullptr;
  if (c.reversal) {
    all["reversal_distance"] = {{"steps", c.reversal->steps},
                                {"distance", c.reversal->distance},
                                {"relative", c.reversal->relative_distance},
                                {"bit_exact", c.reversal->bit_exact}};
  }
  return all;
}

std::string certificate_text(const Json& c) {
  std::string text;
  if (c["drift"].is_null()) {
    text = "drift unknown: " + c["reason"].get<std::string>();
  } else {
    text = fmt::format("energy error {}: {}, over {} blocks", c["drift"].get<std::string>(),
                       c["reason"].get<std::string>(), c["blocks"].get<int>());
  }
  for (const auto& [key, map] : c["momentum_maps"].items()) {
    if (map["conserved"].is_null()) continue;
    text += fmt::format("; {} {}", key, map["conserved"] == "not" ? "not kept" : "kept to rounding");
  }
  const Json& back = c["reversal_distance"];
  if (!back.is_null()) {
    text += fmt::format(
        "; {} step{} there and back: {}", back["steps"].get<long long>(), back["steps"] == 1 ? "" : "s",
        back["bit_exact"].get<bool>() ? "every bit" : fmt::format("{:.1e} off", back["distance"].get<double>()));
  }
  return text;
}

}  // namespace hamflow
