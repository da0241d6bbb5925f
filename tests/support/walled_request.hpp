// Requests behind walls, for tests.
#pragma once

#include <cctype>
#include <ostream>

#include "hamflow/run/catalog.hpp"
#include "hamflow/run/walls.hpp"

namespace hamflow::test {

inline Request behind_walls(Request request, std::vector<Walls::Interval> intervals, WallRule rule) {
  Walls walls;
  walls.intervals = std::move(intervals);
  walls.rule = rule;
  request.walls = walls;
  return request;
}

/// The T-tube with masses 1 and 100.
inline Request t_tube(const std::string& method, WallRule rule, const std::string& dt, const std::string& eps = "-0.6",
                      std::vector<std::string> p = {"6", "100"}) {
  Request request{.problem = "t-tube", .variant = {}, .parameters = {{"eps", eps}}, .start = {}, .method = {}};
  request.start.q = {"0.01", "1.1"};
  request.start.p = std::move(p);
  request.method = parse_method(method);
  request.dt = dt;
  return behind_walls(request, {{"q1", 0, "-1", "1"}, {"q2", 1, "0.1", "2.1"}}, rule);
}

/// A case of a test, and its name.
struct MethodAtWalls {
  const char* method;
  WallRule rule;
};
inline std::ostream& operator<<(std::ostream& out, const MethodAtWalls& each) {
  return out << each.method << ", " << wall_rules()[static_cast<std::size_t>(each.rule)];
}
inline std::string name_of(const MethodAtWalls& each) {
  std::string name;
  for (const char* c = each.method; *c != '\0'; ++c)
    name += std::isalnum(static_cast<unsigned char>(*c)) != 0 ? *c : '_';
  return name + wall_rules()[static_cast<std::size_t>(each.rule)];
}

}  // namespace hamflow::test
