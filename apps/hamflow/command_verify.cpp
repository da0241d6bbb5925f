// hamflow verify METHOD...|--all [--problem P] [--json]: measures the table of properties.
#include <algorithm>
#include <cstdlib>
#include <iostream>

#include "commands.hpp"
#include "guarded.hpp"
#include "hamflow/core/complaint.hpp"
#include "hamflow/verify/verification.hpp"
#include "progress.hpp"

namespace hamflow::app {

namespace {
/// Prints the rows measured before Ctrl-C, in the usual format, and ends the process. Threads that are still measuring
/// have nothing to save, so nobody waits for them.
[[noreturn]] void end_interrupted(const std::vector<PropertyRow>& rows, bool json) {
  if (json) {
    std::cout << verification_json(rows, true);
  } else if (!rows.empty()) {
    std::cout << property_table(rows);
  }
  std::_Exit(written_out(exit_interrupted));
}
}  // namespace

int verify_command(const VerifyOptions& options) {
  return guarded(options.json, [&] {
    if (options.all && !options.methods.empty())
      throw Rejection("METHOD", "found METHOD together with --all; allowed one of them");
    if (!options.all && options.methods.empty()) throw Error("verify needs at least one METHOD, or --all");
    catch_interrupts();
    Verification verification({.methods = options.methods, .all = options.all, .problem = options.problem});
    if (!verification.wait([] { return !interrupted(); })) end_interrupted(verification.rows(), options.json);
    const std::vector<PropertyRow> rows = verification.rows();
    std::cout << (options.json ? verification_json(rows, false) : property_table(rows));
    const bool all_agree = std::all_of(rows.begin(), rows.end(), [](const PropertyRow& row) { return row.agrees(); });
    return all_agree ? exit_done : exit_failed;
  });
}

}  // namespace hamflow::app
