#include "column_names.hpp"

#include <algorithm>

#include "hamflow/run/state_names.hpp"

namespace hamflow {

std::vector<std::string> columns_of_every_run(const ProblemEntry& problem, const Texts& parameters, std::size_t size) {
  std::vector<std::string> all{"t", "step", "energy", "energy-error"};
  // numbered names are used in trajectory.csv
  for (const StateNames& names : {state_names(problem, parameters, size), numbered_names(size)}) {
    all.insert(all.end(), names.q.begin(), names.q.end());
    all.insert(all.end(), names.p.begin(), names.p.end());
  }
  return all;
}

std::string refused_column(const std::string& name, const std::vector<std::string>& taken) {
  constexpr const char* letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789";
  const bool begins_with_digit = !name.empty() && name[0] >= '0' && name[0] <= '9';
  if (name.empty() || begins_with_digit || name.find_first_not_of(letters) != std::string::npos) {
    return "found the name \"" + name + "\"; allowed letters, digits and _" +
           (begins_with_digit ? ", a letter or _ first" : "");
  }
  if (std::find(taken.begin(), taken.end(), name) == taken.end()) return {};
  return "found the name " + name + ", which every run uses for a column; allowed another name";
}

}  // namespace hamflow
