#include "planes.hpp"

#include <algorithm>

namespace hamflow::figures {

std::vector<std::string> axes_of_space(std::size_t space) {
  std::vector<std::string> axes{"x", "y", "z"};
  axes.resize(space);
  return axes;
}

std::vector<Plane> chosen_planes(const FigureOptions& options, const std::vector<std::string>& names,
                                 bool first_alone) {
  const auto place = [&](const std::string& name) {
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  const std::string& x = options.x;
  std::vector<Plane> all;
  for (const std::string& y : options.y) all.emplace_back(x.empty() ? (place(y) == 0 ? 1 : 0) : place(x), place(y));
  if (!all.empty()) return all;
  if (!x.empty()) return {{place(x), place(x) == 0 ? 1 : 0}};
  if (first_alone) return {{0, 1}};
  return {{0, 1}, {0, 2}, {1, 2}};
}

}  // namespace hamflow::figures
