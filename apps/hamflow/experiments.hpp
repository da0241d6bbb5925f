// What list and show tell of experiments.
#pragma once

#include <string>
#include <vector>

namespace hamflow::app {

void list_experiments(bool json);
/// False where there is no experiment of that ID.
bool show_experiment(const std::string& id);
std::vector<std::string> experiment_ids();

}  // namespace hamflow::app
