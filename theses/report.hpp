// The reports of a reproduction: verdicts.json, a text for the terminal, and the page index.html.
#pragma once

#include <filesystem>
#include <string>

#include "reproduce.hpp"

namespace hamflow::reproduction {

/// Returns {status, claims, verdicts {VERDICT: n}, experiments [{id, size, status, message}]}. It contains no times, so
/// that equal results give equal files.
std::string verdicts_json(const ReproduceReport& report);
/// Returns the number of claims with each verdict, and every claim that does not hold.
std::string verdicts_text(const ReproduceReport& report);
/// Returns the page, which shows the figures in the folder.   @param folder the folder of the reproduction
std::string page_of(const ReproduceReport& report, const std::filesystem::path& folder);

}  // namespace hamflow::reproduction
