// hamflow list, hamflow show: print the declarations of the catalogue.
#include <algorithm>
#include <iostream>

#include "commands.hpp"
#include "experiments.hpp"
#include "guarded.hpp"
#include "hamflow/scenario/rejection.hpp"
#include "hamflow/workflow/catalogue_text.hpp"

namespace hamflow::app {

int list_command(const std::string& what, bool all, bool json) {
  return guarded(json, [&] {
    if (what == "experiments")
      become_reproduce(json ? std::vector<std::string>{"--list", "--json"} : std::vector<std::string>{"--list"});
    if (what == "methods") {
      std::cout << (json ? methods_json() : methods_text(all));
    } else {
      std::cout << (json ? problems_json() : problems_text());
    }
    return exit_done;
  });
}

int show_command(const std::string& name, const std::string& folder) {
  return guarded(false, [&] {
    if (!folder.empty()) {
      const std::vector<std::string> ids = experiment_ids();
      if (ids.empty() || std::find(ids.begin(), ids.end(), name) != ids.end())
        become_reproduce({"--show", name, "--out", folder});
      throw Rejection("--out", "found --out with " + name + "; allowed with an experiment (hamflow list experiments)");
    }
    if (name.ends_with(".toml")) {
      std::cout << description_of(accepted(read_scenario(name, {}))).text;
      return exit_done;
    }
    const std::optional<CatalogueText> found = catalogue_text(name);
    if (!found) {
      const std::vector<std::string> ids = experiment_ids();
      if (std::find(ids.begin(), ids.end(), name) != ids.end()) become_reproduce({"--show", name});
      throw Error(not_in_catalogue(name, &ids) +
                  (ids.empty() ? "; experiments are listed only after ./dev theses has built hamflow-reproduce" : ""));
    }
    std::cout << found->text;
    return exit_done;
  });
}

}  // namespace hamflow::app
