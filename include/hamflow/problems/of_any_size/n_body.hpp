// N bodies of any masses under gravity, in the plane or in space.   [HLW2006, (I.2.11)]
#pragma once

#include "hamflow/detail/problems/body_keys.hpp"
#include "hamflow/detail/problems/gravity.hpp"

namespace hamflow {

template <class R = double>
class NBody : public Gravity<R> {
 public:
  /// @param size the number of all coordinates: two per body in the plane, three in space
  NBody(const Parameters<R>& given, std::size_t size)
      : Gravity<R>(given.list("masses"), given["gravitational_constant"], given["softening"],
                   size / given.list("masses").size()) {}

  static ProblemInfo info() {
    return {.name = "n-body",
            .formula = "H = sum |p_i|^2/(2 m_i) - G sum_{i<j} m_i m_j/sqrt(r_ij^2 + softening^2)",
            .reference = "HLW2006, (I.2.11)",
            .coordinates = {"x1", "y1", "(z1)", "x2", "..."},
            .parameters = n_body_parameters(),
            .keys = n_body_keys(),
            .invariants = Gravity<R>::gravity_invariants(),
            .frame = Gravity<R>::frame_key(StartFrames::given),
            // The softening is so large that close encounters are not faster than the motion at the start.
            .region = {.parameters = {{"masses", "[1, 0.3, 0.2]"}, {"softening", "0.5"}},
                       .centre = {0, 0, 1, 0, 0, -1.5, 0, -0.1, 0, 0.3, 0.16, 0},
                       .spread = 0.05,
                       .step = 0.02},
            // A sun with two planets; the bodies of the region would have close encounters.
            .example = {.parameters = {{"masses", "[1, 0.001, 0.0005]"}},
                        .q = {0, 0, 1, 0, 0, -1.7},
                        .p = {-0.00038, -0.001, 0, 0.001, 0.00038, 0},
                        .dt = 0.05,
                        .steps = 2000,
                        .keys = {{"masses", "[1, 0.001, 0.0005]"}, {"gravitational_constant", ""}, {"softening", ""}}}};
  }
  /// Why q cannot have that many numbers; empty if it can.
  static std::string refused_size(const Parameters<R>& given, std::size_t size) {
    const std::size_t bodies = given.list("masses").size();
    if (size == 2 * bodies || size == 3 * bodies) return {};
    return std::to_string(2 * bodies) + " numbers in the plane, " + std::to_string(3 * bodies) + " in space for " +
           std::to_string(bodies) + (bodies == 1 ? " body" : " bodies");
  }
  /// Names two bodies at the same point; empty if there are none. Without softening the force between them is
  /// undefined.
  static std::string refused_start(const Parameters<R>& given, const Vector<R, dynamic>& q) {
    if (given["softening"] > R(0)) return {};
    const std::size_t bodies = given.list("masses").size();
    const std::size_t space = q.size() / bodies;
    for (std::size_t i = 0; i < bodies; ++i) {
      for (std::size_t j = i + 1; j < bodies; ++j) {
        if (!(given.list("masses")[i] + given.list("masses")[j] > R(0))) continue;  // they do not feel each other
        bool apart = false;
        for (std::size_t k = 0; k < space; ++k) apart = apart || !(q[i * space + k] == q[j * space + k]);
        if (!apart) {
          return "bodies " + std::to_string(i + 1) + " and " + std::to_string(j + 1) +
                 " at one point; allowed different positions, or softening > 0";
        }
      }
    }
    return {};
  }
};

}  // namespace hamflow
