// hamflow cite: the work from which a problem or a method is taken, by its key in docs/references.bib.
#include <algorithm>
#include <iostream>

#include "commands.hpp"
#include "guarded.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow::app {

int cite_command(const std::string& name) {
  return guarded(false, [&] {
    std::vector<std::string> names;
    std::vector<std::string> cited;  // the variants of a problem often share one
    for (const ProblemEntry& entry : problems()) {
      names.push_back(entry.info.name);
      if (entry.info.name != name || entry.info.reference.empty()) continue;
      if (std::find(cited.begin(), cited.end(), entry.info.reference) != cited.end()) continue;
      cited.push_back(entry.info.reference);
    }
    for (const MethodEntry& entry : methods()) names.push_back(entry.name);
    const std::string method = name.substr(0, name.find('('));
    if (std::find(names.begin(), names.end(), method) == names.end()) {
      throw Error("there is no problem or method '" + name + "'" + suggestion(method, names) +
                  " (hamflow list problems, hamflow list methods)");
    }
    if (cited.empty()) cited.push_back(describe(parse_method(name)).reference);
    for (const std::string& reference : cited) std::cout << reference << '\n';
    return exit_done;
  });
}

}  // namespace hamflow::app
