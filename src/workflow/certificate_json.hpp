// Certificates and reversals as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "hamflow/verify/certificate.hpp"

namespace hamflow {

nlohmann::ordered_json certificate_json(const RunCertificate& certificate);
/// One line for people.
std::string certificate_text(const nlohmann::ordered_json& certificate);

}  // namespace hamflow
