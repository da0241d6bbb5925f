// hamflow cite RUN|SCENARIO|METHOD|PROBLEM: the works behind it, as BibTeX.
#include <filesystem>
#include <iostream>

#include "commands.hpp"
#include "guarded.hpp"
#include "hamflow/scenario/rejection.hpp"
#include "hamflow/workflow/catalogue_text.hpp"
#include "hamflow/workflow/cite.hpp"
#include "hamflow/workflow/open_run.hpp"

namespace hamflow::app {

int cite_command(const std::string& name) {
  return guarded(false, [&] {
    if (name.ends_with(".toml")) {
      std::cout << bibtex_of(accepted(read_scenario(name, {})));
      return exit_done;
    }
    if (const std::string found = bibtex_of(name); !found.empty()) {
      std::cout << found;
      return exit_done;
    }
    if (!std::filesystem::exists(name)) {
      throw Error(not_in_catalogue(name) + "; nor a run or a scenario file of that name");
    }
    std::cout << bibtex_of(open_run(name).scenario);
    return exit_done;
  });
}

}  // namespace hamflow::app
