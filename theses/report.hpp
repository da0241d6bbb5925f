// What is told of a reproduction: verdicts.json, a table for people, and the page index.html.
#pragma once

#include <filesystem>
#include <string>

#include "reproduce.hpp"

namespace hamflow::reproduction {

/// {status, claims, verdicts {VERDICT: n}, experiments [{id, size, status, message}]}: no times, so that it does not
/// change.
std::string verdicts_json(const ReproduceReport& report);
/// How many of each verdict, and every claim that does not hold.
std::string verdicts_text(const ReproduceReport& report);
/// It shows the figures that stand beside it in the folder.   @param folder in which the experiments are
std::string page_of(const ReproduceReport& report, const std::filesystem::path& folder);

}  // namespace hamflow::reproduction
