// What `hamflow certify` does: the energies of a log, by any program, judged by the rules of a run's certificate.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hamflow/verify/log_certificate.hpp"

namespace hamflow {

struct CertifiedLog {
  LogCertificate certificate;
  std::vector<std::string> notes;  // what of the file was not read
};

/// @param time, energy names or numbers of columns, from 1; of HDF5 paths of datasets, "samples/q:2" for a column
/// @param scale see certify_log
/// @throws FileError where the file cannot be read, Rejection where it is no log or the columns are none
CertifiedLog certify_file(const std::filesystem::path& file, const std::string& time, const std::string& energy,
                          std::optional<double> scale = {});

/// {drift, energy_level, growth_exponent, reason, samples, periods, scale}; null where it is unknown.
std::string log_certificate_json(const LogCertificate& certificate);
/// The same for people, a line each.
std::string log_certificate_text(const LogCertificate& certificate);

}  // namespace hamflow
