// Two masses on crossed rails, H = P1^2/(2 m1) + P2^2/(2 m2) - eps/sqrt(Q1^2 + Q2^2): one moves along x, the other
// along y, between walls.   [Sonnleitner2010, ch. 1.9, 3b] eps > 0 attracts, eps < 0 repels. The walls are those of the
// listing: Q1 in [-1, 1], Q2 in [0.1, 2.1].
#pragma once

#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/problem_info.hpp"

namespace hamflow {

template <class R = double>
class TTube {
 public:
  using Real = R;
  static constexpr std::size_t dimension = 2;
  static constexpr bool quadratic_kinetic = true;

  explicit TTube(R m1 = R(1), R m2 = R(100), R eps = R(0.6)) : m1_(m1), m2_(m2), eps_(eps) {}
  explicit TTube(const Parameters<R>& given)
      : TTube(given.list("masses").at(0), given.list("masses").at(1), given["eps"]) {}

  static ProblemInfo info() {
    return {.name = "t-tube",
            .variant = {{"coordinates", "generalised"}},
            .default_choices = {"coordinates"},
            .chart_key = "coordinates",
            .formula = "H = p1^2/(2 m1) + p2^2/(2 m2) - eps/sqrt(q1^2 + q2^2), q1 in [-1, 1], q2 in [0.1, 2.1]",
            .reference = "Sonnleitner2010, ch. 1.9",
            .coordinates = {"q1", "q2"},
            .parameters = {{.name = "masses",
                            .default_value = "[1, 100]",
                            .meaning = "masses of both bodies",
                            .range = Range::positive,
                            .type = OptionType::list,
                            .length = 2},
                           {"eps", "0.6", "strength of the force, which attracts where it is positive"}},
            .default_q = {"0.01", "1.1"},
            .velocities = {.name = "velocities",
                           .default_value = "[0, 1]",
                           .meaning = "velocities of both bodies at the default start, q = (0.01, 1.1)",
                           .type = OptionType::list,
                           .length = 2,
                           .example = "[6, 1]"},
            .walls = {{0, "-1", "1"}, {1, "0.1", "2.1"}},
            // Every step from there meets the wall of q1.
            .region_at_walls = {.parameters = {{"masses", "[1, 2]"}, {"eps", "-0.6"}},
                                .centre = {0.9, 1.1, 2, 0.5},
                                .spread = 0.03,
                                .step = 0.11,
                                .time = 1.7},
            .observables = {{"kinetic1", "p1^2/(2*masses[1])"}, {"kinetic2", "p2^2/(2*masses[2])"}},
            // Without walls: Kepler's motion, which masses that differ would lead through the centre.
            .region = {.parameters = {{"masses", "[1, 1]"}, {"eps", "1"}},
                       .centre = {1, 0.25, 0.1, 1.1},
                       .spread = 0.05,
                       .step = 0.11,
                       .time = 2.3},
            .example = {.parameters = {{"masses", "[1, 100]"}, {"eps", "0.6"}},
                        .q = {0.01, 1.1},
                        .p = {0, 100},
                        .dt = 0.01,
                        .steps = 20000}};
  }

  template <class S>
  S kinetic(const Vector<S, 2>& p) const {
    return p[0] * p[0] / (R(2) * m1_) + p[1] * p[1] / (R(2) * m2_);
  }
  template <class S>
  S potential(const Vector<S, 2>& q) const {
    return -(eps_ / sqrt(q[0] * q[0] + q[1] * q[1]));
  }
  template <class S>
  void velocity(const Vector<S, 2>& p, Vector<S, 2>& v) const {
    v[0] = p[0] / m1_;
    v[1] = p[1] / m2_;
  }
  template <class F, class S>
  void scaled_velocity(const F& factor, const Vector<S, 2>& p, Vector<S, 2>& v) const {
    v[0] = (factor / m1_) * p[0];
    v[1] = (factor / m2_) * p[1];
  }
  template <class S>
  void force(const Vector<S, 2>& q, Vector<S, 2>& f) const {
    scaled_force(R(1), q, f);
  }
  template <class F, class S>
  void scaled_force(const F& factor, const Vector<S, 2>& q, Vector<S, 2>& f) const {
    const S u = q[0] * q[0] + q[1] * q[1];
    const S pull = (-factor * eps_) / (u * sqrt(u));
    f[0] = pull * q[0];
    f[1] = pull * q[1];
  }
  template <class S>
  void potential_hessian(const Vector<S, 2>& q, Matrix<S, 2>& out) const {
    const S u = q[0] * q[0] + q[1] * q[1];
    const S cube = eps_ / (u * sqrt(u));
    const S fifth = R(3) * cube / u;
    out[0][0] = cube - fifth * q[0] * q[0];
    out[0][1] = out[1][0] = -fifth * q[0] * q[1];
    out[1][1] = cube - fifth * q[1] * q[1];
  }

 private:
  R m1_;
  R m2_;
  R eps_;
};

}  // namespace hamflow
