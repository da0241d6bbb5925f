// What list and show tell of experiments.
#pragma once

#include <string>
#include <vector>

namespace hamflow::app {

void list_experiments(bool json);
/// With its claims as they were judged in a folder, that of `reproduce` where it is empty. False where there is no
/// experiment of that ID.   @throws FileError where a folder that was named is none of a reproduction
bool show_experiment(const std::string& id, const std::string& folder);
std::vector<std::string> experiment_ids();

}  // namespace hamflow::app
