// The bodies of [problem].bodies of n-body as texts, which every arithmetic reads with all its digits.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hamflow/detail/core/option_info.hpp"
#include "hamflow/orbits/bodies.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow {

struct ListedBody {
  std::string name;
  std::string mass;
  Texts orbit{};  // formulas of numbers by the names of keys, angles in radians; empty: position and velocity
  std::vector<std::string> position{};
  std::vector<std::string> velocity{};
  Primary primary = Primary::jacobi;
  std::size_t of = 0;
};

struct BodyList {
  std::vector<ListedBody> bodies{};
  std::size_t space = 3;
  std::string gravitational_constant = "1";
};

/// An angle in radians as a formula of numbers, from "20 deg", "1.5 rad", "pi/3"; nullopt if it is none of these.
std::optional<std::string> angle_in_radians(const std::string& text);

/// An orbit in double.
Orbit<double> orbit_of(const Texts& orbit);

/// q, and p, as decimal texts with the digits of an arithmetic, and some more where it has those of double.
/// @throws Error with the name of a body whose position or velocity is not finite
StartSpec start_of(const BodyList& list, const std::string& arithmetic);

}  // namespace hamflow
