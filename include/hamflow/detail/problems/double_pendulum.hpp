// Double pendulum with general masses, rods and inertias, nonlinear and linear, in absolute and in relative angles.
// [Gross1999, ch. 3; the entries of M and V: support/double_pendulum_body.hpp]
//
// Nonlinear: H = p^T M(q)^-1 p/2 + V(q). M depends on q only through delta = q1 - q2 (absolute angles). With the
// angular velocities v = M^-1 p,
//     dT/d(delta) = -v^T M' v/2 = b sin(delta) v1 v2,   dv/d(delta) = -M^-1 M' v = M^-1 b sin(delta) (v2, v1)^T,
// from which gradient and Hessian follow. In relative angles delta = -q2, and M, p, v change as in pendulum_angles.hpp.
// Linear: M at rest and C = V'' at rest, exact in time by its modes (3.33).
#pragma once

#include <optional>

#include "hamflow/core/derivatives.hpp"
#include "hamflow/detail/problems/double_pendulum_body.hpp"
#include "hamflow/detail/problems/modal.hpp"
#include "hamflow/detail/problems/pendulum_angles.hpp"

namespace hamflow {

namespace detail {

/// M for a given cos(q1 - q2). (3.149), (3.175)
template <Angles angles, class R, class S>
Matrix<S, 2> pendulum_mass(const DoublePendulumBody<R>& body, const S& cosine) {
  const S coupling = cosine * body.b;
  if constexpr (angles == Angles::absolute) return {Vector<S, 2>{S(body.a), coupling}, {coupling, S(body.c)}};
  return {Vector<S, 2>{R(2) * coupling + (body.a + body.c), coupling + body.c}, {coupling + body.c, S(body.c)}};
}
/// M^-1 from M and its determinant, which is computed without cancellation. (3.151), (3.176)
template <class S>
Matrix<S, 2> pendulum_inverse(const Matrix<S, 2>& mass, const S& determinant) {
  return {Vector<S, 2>{mass[1][1] / determinant, -(mass[0][1] / determinant)},
          {-(mass[1][0] / determinant), mass[0][0] / determinant}};
}

/// The common declarations of the models. A period of the faster mode is 2 pi/sqrt(5.65 g/l) = 0.84 for unit rods.
inline ProblemInfo double_pendulum_info(const char* model, Angles angles, const char* formula,
                                        std::vector<ParameterInfo> parameters) {
  const bool absolute = angles == Angles::absolute;
  return {.name = "double-pendulum",
          .variant = {{"model", model}, {"angles", absolute ? "absolute" : "relative"}, {"coordinates", "generalised"}},
          .default_choices =
              absolute ? std::vector<std::string>{"coordinates", "angles"} : std::vector<std::string>{"coordinates"},
          .chart_key = "angles",
          .formula = formula,
          .reference = "Gross1999, ch. 3",
          .coordinates = {"q1", "q2"},
          .angles = {"q1", "q2"},
          .parameters = std::move(parameters),
          .region = {.centre =
                         absolute ? std::vector<double>{0.4, -0.3, 0.5, 0.2} : std::vector<double>{0.4, -0.7, 0.7, 0.2},
                     .step = 0.013,
                     .time = 0.7},
          .example = {.dt = 0.01}};
}

}  // namespace detail

template <class R, Angles angles>
class DoublePendulumNonlinear : public PendulumChart<R, angles> {
 public:
  using Real = R;
  static constexpr std::size_t dimension = 2;

  explicit DoublePendulumNonlinear(const Vector<R, 2>& masses = {R(1), R(1)},
                                   const Vector<R, 2>& half_lengths = {R(1), R(1)},
                                   const Vector<R, 2>& inertias = {R(0), R(0)}, R gravity = parse_decimal<R>("9.81"))
      : body_(masses, half_lengths, inertias, gravity) {}
  explicit DoublePendulumNonlinear(const Parameters<R>& given) : body_(given) {}
  /// Converts the problem from another number type.
  template <class Q>
  explicit DoublePendulumNonlinear(const DoublePendulumNonlinear<Q, angles>& other) : body_(other.body_) {}

  static ProblemInfo info() {
    ProblemInfo all = detail::double_pendulum_info("nonlinear", angles, "H = p^T M(q)^-1 p/2 + V(q)",
                                                   DoublePendulumBody<R>::parameters());
    all.default_choices.push_back("model");
    all.region.spread = 0.05;
    all.region.step = 0.008;
    return all;
  }
  static std::pair<std::string, std::string> refused_parameters(const Parameters<R>& given) {
    return {"", DoublePendulumBody<R>(given).allowed_instead()};
  }

  template <class S>
  Matrix<S, 2> mass_matrix(const Vector<S, 2>& q) const {
    return detail::pendulum_mass<angles>(body_, S(cos(difference(q))));
  }
  template <class S>
  Matrix<S, 2> inverse_mass_matrix(const Vector<S, 2>& q) const {
    return detail::pendulum_inverse(mass_matrix(q), body_.determinant(S(sin(difference(q)))));
  }

  template <class S>
  S energy(const Vector<S, 2>& q, const Vector<S, 2>& p) const {
    const Vector<S, 2> absolute = to_absolute(q);
    const Vector<S, 2> v = motion(q, p).velocity;
    const Vector<S, 2> momenta = momenta_to_absolute(p);
    return (momenta[0] * v[0] + momenta[1] * v[1]) / R(2) - cos(absolute[0]) * body_.w1 - cos(absolute[1]) * body_.w2;
  }

  /// dq = dH/dq, dp = dH/dp = q'. (3.153), (3.155), (3.178), (3.180)
  template <class S>
  void gradient(const Vector<S, 2>& q, const Vector<S, 2>& p, Vector<S, 2>& dq, Vector<S, 2>& dp) const {
    const Motion<S> m = motion(q, p);
    const Vector<S, 2> absolute = to_absolute(q);
    const S turn = m.coupling * m.velocity[0] * m.velocity[1];
    const S torque1 = sin(absolute[0]) * body_.w1;
    const S torque2 = sin(absolute[1]) * body_.w2;
    dq[0] = is_relative ? torque1 + torque2 : torque1 + turn;
    dq[1] = torque2 - turn;
    dp = velocity_from_absolute(m.velocity);
  }

  /// The second derivatives; hqp[i][j] = d^2 H/dq_i dp_j.
  template <class S>
  void hessian(const Vector<S, 2>& q, const Vector<S, 2>& p, Matrix<S, 2>& hqq, Matrix<S, 2>& hqp,
               Matrix<S, 2>& hpp) const {
    const Motion<S> m = motion(q, p);
    const Vector<S, 2>& v = m.velocity;
    const S push1 = m.coupling * v[1];
    const S push2 = m.coupling * v[0];
    const S coupling = m.cosine * body_.b;
    const Vector<S, 2> change{(push1 * body_.c - push2 * coupling) / m.determinant,
                              (push2 * body_.a - push1 * coupling) / m.determinant};             // dv/d(delta)
    const S bend = coupling * v[0] * v[1] + m.coupling * (change[0] * v[1] + v[0] * change[1]);  // d^2T/d(delta)^2
    const Vector<S, 2> absolute = to_absolute(q);
    const S stiffness1 = cos(absolute[0]) * body_.w1;
    const S stiffness2 = cos(absolute[1]) * body_.w2;
    const Vector<S, 2> own_change = velocity_from_absolute(change);
    if constexpr (is_relative) {
      hqq = {Vector<S, 2>{stiffness1 + stiffness2, stiffness2}, {stiffness2, stiffness2 + bend}};
      hqp = {Vector<S, 2>{S(R(0)), S(R(0))}, {-own_change[0], -own_change[1]}};
    } else {
      hqq = {Vector<S, 2>{stiffness1 + bend, -bend}, {-bend, stiffness2 + bend}};
      hqp = {Vector<S, 2>{own_change[0], own_change[1]}, {-own_change[0], -own_change[1]}};
    }
    hpp = detail::pendulum_inverse(detail::pendulum_mass<angles>(body_, m.cosine), m.determinant);
  }

 private:
  static constexpr bool is_relative = angles == Angles::relative;

  /// Quantities for both derivatives, in absolute angles.
  template <class S>
  struct Motion {
    S cosine;  // cos(delta)
    S determinant;
    S coupling;  // b sin(delta)
    Vector<S, 2> velocity;
  };
  template <class S>
  Motion<S> motion(const Vector<S, 2>& q, const Vector<S, 2>& p) const {
    const S delta = difference(q);
    const S cosine = cos(delta);
    const S sine = sin(delta);
    const S determinant = body_.determinant(sine);
    const S coupling = cosine * body_.b;
    const Vector<S, 2> momenta = momenta_to_absolute(p);
    return {cosine,
            determinant,
            sine * body_.b,
            {(momenta[0] * body_.c - momenta[1] * coupling) / determinant,
             (momenta[1] * body_.a - momenta[0] * coupling) / determinant}};
  }

  template <class S>
  static S difference(const Vector<S, 2>& q) {
    if constexpr (is_relative)
      return -q[1];
    else
      return q[0] - q[1];
  }
  template <class S>
  static Vector<S, 2> to_absolute(const Vector<S, 2>& q) {
    if constexpr (is_relative)
      return absolute_angles(q);
    else
      return q;
  }
  template <class S>
  static Vector<S, 2> momenta_to_absolute(const Vector<S, 2>& p) {
    if constexpr (is_relative)
      return absolute_momenta(p);
    else
      return p;
  }
  template <class S>
  static Vector<S, 2> velocity_from_absolute(const Vector<S, 2>& v) {
    if constexpr (is_relative)
      return relative_angles(v);
    else
      return v;
  }

  template <class, Angles>
  friend class DoublePendulumNonlinear;
  DoublePendulumBody<R> body_;
};

template <class R, Angles angles>
class DoublePendulumLinear : public PendulumChart<R, angles> {
 public:
  using Real = R;
  static constexpr std::size_t dimension = 2;
  static constexpr bool quadratic_kinetic = true;

  explicit DoublePendulumLinear(const Vector<R, 2>& masses = {R(1), R(1)},
                                const Vector<R, 2>& half_lengths = {R(1), R(1)},
                                const Vector<R, 2>& inertias = {R(0), R(0)}, R gravity = parse_decimal<R>("9.81"))
      : DoublePendulumLinear(DoublePendulumBody<R>(masses, half_lengths, inertias, gravity)) {}
  explicit DoublePendulumLinear(const Parameters<R>& given) : DoublePendulumLinear(DoublePendulumBody<R>(given)) {}
  /// Converts the problem from another number type.
  template <class Q>
  explicit DoublePendulumLinear(const DoublePendulumLinear<Q, angles>& other) {
    for (std::size_t i = 0; i < 2; ++i) {
      mass_[i] = cast<R>(other.mass_[i]);
      inverse_mass_[i] = cast<R>(other.inverse_mass_[i]);
      stiffness_[i] = cast<R>(other.stiffness_[i]);
    }
  }

  static ProblemInfo info() {
    return detail::double_pendulum_info("linear", angles, "H = p^T M^-1 p/2 + q^T C q/2, M and C = V'' at rest",
                                        DoublePendulumBody<R>::parameters());
  }
  static std::pair<std::string, std::string> refused_parameters(const Parameters<R>& given) {
    return {"", DoublePendulumBody<R>(given).allowed_instead()};
  }

  const Matrix<R, 2>& mass_matrix() const { return mass_; }
  const Matrix<R, 2>& inverse_mass_matrix() const { return inverse_mass_; }
  const Matrix<R, 2>& stiffness_matrix() const { return stiffness_; }

  template <class S>
  S kinetic(const Vector<S, 2>& p) const {
    return half_form(inverse_mass_, p);
  }
  template <class S>
  S potential(const Vector<S, 2>& q) const {
    return half_form(stiffness_, q);
  }
  template <class S>
  void velocity(const Vector<S, 2>& p, Vector<S, 2>& v) const {
    v[0] = p[0] * inverse_mass_[0][0] + p[1] * inverse_mass_[0][1];
    v[1] = p[0] * inverse_mass_[1][0] + p[1] * inverse_mass_[1][1];
  }
  template <class S>
  void force(const Vector<S, 2>& q, Vector<S, 2>& f) const {
    f[0] = -(q[0] * stiffness_[0][0] + q[1] * stiffness_[0][1]);
    f[1] = -(q[0] * stiffness_[1][0] + q[1] * stiffness_[1][1]);
  }
  template <class S>
  void potential_hessian(const Vector<S, 2>&, Matrix<S, 2>& out) const {
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t j = 0; j < 2; ++j) out[i][j] = S(stiffness_[i][j]);
    }
  }

  /// The modes of the Hamiltonian with its stored, rounded M^-1. M is computed from M^-1, so that the exact and the
  /// computed motion have the same rounding of M^-1.
  ModalSolution<2> modes() const {
    Matrix<long double, 2> inverse{};
    Matrix<long double, 2> stiffness{};
    for (std::size_t i = 0; i < 2; ++i) {
      inverse[i] = cast<long double>(inverse_mass_[i]);
      stiffness[i] = cast<long double>(stiffness_[i]);
    }
    const long double determinant = inverse[0][0] * inverse[1][1] - inverse[0][1] * inverse[1][0];
    return {detail::pendulum_inverse(inverse, determinant), stiffness};
  }
  /// The exact state at time t. (3.33)
  std::optional<Start<long double, 2>> exact(const Vector<long double, 2>& q, const Vector<long double, 2>& p,
                                             long double t) const {
    // If one mass is negligible, the modes have the rounding errors of the heavy one.
    const R first = inverse_mass_[0][0];
    const R second = inverse_mass_[1][1];
    if (!(first <= R(0x1p30) * second && second <= R(0x1p30) * first)) return std::nullopt;
    const ModalSolution<2> solution = modes();
    if (!solution.solved()) return std::nullopt;
    return solution.at(q, p, t);
  }

 private:
  explicit DoublePendulumLinear(const DoublePendulumBody<R>& body)
      : mass_(detail::pendulum_mass<angles>(body, R(1))),
        inverse_mass_(detail::pendulum_inverse(mass_, body.least_determinant)) {
    // (3.59), (3.94)
    if constexpr (angles == Angles::relative) {
      stiffness_ = {Vector<R, 2>{body.w1 + body.w2, body.w2}, {body.w2, body.w2}};
    } else {
      stiffness_ = {Vector<R, 2>{body.w1, R(0)}, {R(0), body.w2}};
    }
  }

  /// x^T m x/2.
  template <class S>
  static S half_form(const Matrix<R, 2>& m, const Vector<S, 2>& x) {
    return (x[0] * x[0] * m[0][0] + x[0] * x[1] * (R(2) * m[0][1]) + x[1] * x[1] * m[1][1]) / R(2);
  }

  template <class, Angles>
  friend class DoublePendulumLinear;
  Matrix<R, 2> mass_;
  Matrix<R, 2> inverse_mass_;
  Matrix<R, 2> stiffness_{};
};

}  // namespace hamflow
