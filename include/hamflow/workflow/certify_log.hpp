// Judges the energies in the log of any program by the rules of a run's certificate, for `hamflow certify`.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hamflow/verify/log_certificate.hpp"

namespace hamflow {

struct CertifiedLog {
  LogCertificate certificate;
  std::vector<std::string> notes;  // parts of the file that were not read
};

/// @param time, energy names of columns, or their numbers counted from 1; in HDF5 paths of datasets, "samples/q:2" for
/// a column
/// @param scale see certify_log
/// @throws FileError if the file cannot be read   @throws Rejection if it is not a log or has no such columns
CertifiedLog certify_file(const std::filesystem::path& file, const std::string& time, const std::string& energy,
                          std::optional<double> scale = {});

/// Returns {drift, energy_level, growth_exponent, reason, samples, periods, scale}; null if a value is unknown.
std::string log_certificate_json(const LogCertificate& certificate);
/// The same as text, one line for each entry.
std::string log_certificate_text(const LogCertificate& certificate);

}  // namespace hamflow
