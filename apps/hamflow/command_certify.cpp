// hamflow certify: finds the drift class of energies in the log of any program.
#include <iostream>
#include <optional>

#include "commands.hpp"
#include "guarded.hpp"
#include "hamflow/core/complaint.hpp"
#include "hamflow/core/number.hpp"
#include "hamflow/workflow/certify_log.hpp"

namespace hamflow::app {

int certify_command(const CertifyOptions& options) {
  return guarded(options.json, [&] {
    std::optional<double> scale;
    if (!options.scale.empty()) {
      try {
        scale = evaluate_number<double>(options.scale);
      } catch (const Error&) {
      }
      if (!scale || !(*scale > 0)) {
        throw Rejection("--scale", "found '" + options.scale + "'; allowed a positive number");
      }
    }
    const CertifiedLog found = certify_file(options.file, options.time, options.energy, scale);
    print_notes(found.notes, options.json);
    std::cout << (options.json ? log_certificate_json(found.certificate) : log_certificate_text(found.certificate));
    return exit_done;
  });
}

}  // namespace hamflow::app
