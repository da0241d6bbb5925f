// N bodies under gravity, H = sum |p_i|^2/(2 m_i) - G sum_{i<j} m_i m_j/sqrt(r_ij^2 + softening^2), in the plane or in
// space: the pair system with the law `newton` and the strength G m_i m_j.   [HLW2006, (I.2.11)]
//
// A body of mass 0 feels the others and is felt by none. Its momentum is that per unit of mass, p = v. H and the
// invariants are those of the massive bodies; the forces on massless ones follow from no term of H.
#pragma once

#include "hamflow/detail/core/point_masses.hpp"
#include "hamflow/detail/problems/pair_system.hpp"
#include "hamflow/problems/pairs/newton.hpp"

namespace hamflow {

/// The functions of a pair at u = r^2 + softening^2, with one quotient each.
template <class R>
struct GravityModel : Particles<R> {
  using Particles<R>::masses;
  using Law = pairs::Newton<R>;
  static constexpr bool sums_by_rows = false;

  R constant{};  // G
  R softening_squared{};
  std::vector<std::size_t> massive;
  std::vector<std::size_t> massless;

  /// What divides the momentum of a body to give its velocity: its mass, 1 for a massless body.
  R inertia(std::size_t i) const { return R(0) < masses[i] ? masses[i] : R(1); }

  template <class S>
  S square(const S* d, std::size_t axes) const {
    S u(softening_squared);
    for (std::size_t k = 0; k < axes; ++k) u += d[k] * d[k];
    return u;
  }
  template <class S>
  static constexpr bool ends(const S& /*u*/) {
    return false;
  }
  R strength(std::size_t i, std::size_t j) const { return constant * masses[i] * masses[j]; }
  template <class S>
  S energy(const S& u, std::size_t i, std::size_t j) const {
    return Law::energy(strength(i, j), u);
  }
  template <class S>
  S pull(const S& u, std::size_t i, std::size_t j) const {
    return Law::pull(strength(i, j), u);
  }
  /// The strength of a kick is symmetric in i and j, bit for bit.
  template <class F>
  auto pull_times(const F& factor) const {
    return [this, s = F(factor * constant)](const F& u, std::size_t i, std::size_t j) {
      return Law::pull(F(s * (masses[i] * masses[j])), u);
    };
  }
  /// The pair i, j adds c (I - 3 d d^T/u), c = G m_i m_j u^(-3/2), to the blocks ii and jj and subtracts it from ij and
  /// ji.
  template <class S>
  auto pair_hessian(const S& u, std::size_t i, std::size_t j) const {
    return [u, c = pull(u, i, j)](const S* d, std::size_t k, std::size_t l) {
      return S((k == l ? c : S(0)) - R(3) * c * d[k] * d[l] / u);
    };
  }
  /// c, and a component of c (w - 3 d (d w)/u).
  template <class F>
  auto bend_along(const F& u, std::size_t i, std::size_t j, const F& dw) const {
    const F c = Law::pull(F(F(constant) * (masses[i] * masses[j])), u);
    return std::pair{c, [u, c, dw](const F& d, const F& w) { return F(c * (w - F(3) * d * dw / u)); }};
  }
  /// Returns the potential and its first two derivatives by r^2, computed with one quotient.
  template <class S>
  RadialLaw<S> radial_law(const S& square) const {
    const S inverse = R(1) / (square + softening_squared);
    const S root = sqrt(inverse);
    const S first = inverse * root / R(2);
    return {-root, first, R(-1.5) * first * inverse};
  }
  static constexpr bool turns_freely() { return true; }
  static constexpr bool moves_freely() { return true; }
};

template <class R>
class Gravity : public PairSystem<R, GravityModel<R>> {
  using Base = PairSystem<R, GravityModel<R>>;

 public:
  using Base::model;
  using Base::particles;
  using Base::size;
  using Base::space;

  /// @param dimensions the dimension of space, 2 or 3
  Gravity(const std::vector<R>& masses, const R& gravitational_constant, const R& softening, std::size_t dimensions)
      : Base(model_of(masses, gravitational_constant, softening, dimensions)) {}

  /// As GravitatingBodies.
  PointMasses<R> point_masses() const { return {space(), model().masses, model().constant, model().softening_squared}; }

  bool has_massless() const { return !model().massless.empty(); }

  // With massless bodies these functions replace those of the pair system. Massive bodies come first, in the same order
  // of sums, so that massless bodies change no bit of their motion.
  template <class S>
  S kinetic(const Vector<S, dynamic>& p) const {
    if (!has_massless()) return Base::kinetic(p);
    const std::size_t n = space();
    S sum(R(0));
    for (const std::size_t i : model().massive) {
      S square(R(0));
      for (std::size_t k = 0; k < n; ++k) square += p[i * n + k] * p[i * n + k];
      sum += square * (model().inverse_masses[i] / R(2));
    }
    return sum;
  }
  template <class S>
  S potential(const Vector<S, dynamic>& q) const {
    if (!has_massless()) return Base::potential(q);
    S sum(R(0));
    for_massive_pairs(q, [&](std::size_t i, std::size_t j, const S*, const S& u) { sum += model().energy(u, i, j); });
    return sum;
  }
  template <class S>
  void force(const Vector<S, dynamic>& q, Vector<S, dynamic>& f) const {
    if (!has_massless()) return Base::force(q, f);
    if (space() == 2) {
      forces_with_massless<2>(q, f);
    } else {
      forces_with_massless<3>(q, f);
    }
  }
  /// Minus the derivative of the force: not symmetric with massless bodies.
  template <class S>
  void force_and_hessian(const Vector<S, dynamic>& q, Vector<S, dynamic>& f, Matrix<S, dynamic>& hessian) const {
    if (!has_massless()) return Base::force_and_hessian(q, f, hessian);
    force(q, f);
    const std::size_t n = space();
    for (std::size_t i = 0; i < size(); ++i) {
      for (std::size_t j = 0; j < size(); ++j) hessian[i][j] = S(R(0));
    }
    const auto add = [&](std::size_t i, std::size_t j, const S* d, const auto& entry) {
      for (std::size_t k = 0; k < n; ++k) {
        for (std::size_t l = 0; l < n; ++l) {
          const S part = entry(d, k, l);
          hessian[i * n + k][i * n + l] += part;
          hessian[i * n + k][j * n + l] -= part;
        }
      }
    };
    for_massive_pairs(q, [&](std::size_t i, std::size_t j, const S* d, const S& u) {
      const auto entry = model().pair_hessian(u, i, j);
      add(i, j, d, entry);
      add(j, i, d, entry);
    });
    for_massless_pairs(q, [&](std::size_t i, std::size_t j, const S* d, const S& u) {
      const S c = massless_pull(u, j);
      add(i, j, d, [&](const S* at, std::size_t k, std::size_t l) {
        return S((k == l ? c : S(R(0))) - R(3) * c * at[k] * at[l] / u);
      });
    });
  }
  template <class S>
  Vector<S, dynamic> invariants(const Vector<S, dynamic>& q, const Vector<S, dynamic>& p, const S& t) const {
    if (!has_massless()) return Base::invariants(q, p, t);
    const std::size_t n = space();
    const std::size_t rotations = n == 2 ? 1 : 3;
    Vector<S, dynamic> all(rotations + 2 * n);
    for (const std::size_t i : model().massive) {
      const std::size_t at = i * n;
      for (std::size_t k = 0; k < rotations; ++k) {
        const std::size_t a = at + (n == 2 ? 0 : (k + 1) % 3);
        const std::size_t b = at + (n == 2 ? 1 : (k + 2) % 3);
        all[k] += q[a] * p[b] - q[b] * p[a];
      }
      for (std::size_t k = 0; k < n; ++k) {
        all[rotations + k] += p[at + k];
        all[rotations + n + k] += q[at + k] * model().masses[i];
      }
    }
    for (std::size_t k = 0; k < n; ++k) {
      S& centre = all[rotations + n + k];
      centre = (centre - all[rotations + k] * t) / model().total_mass;
    }
    return all;
  }

  static std::vector<InvariantInfo> gravity_invariants() {
    return {{"angular_momentum", "sum x_i x p_i", Components::rotations, Terms::moments},
            {"linear_momentum", "P = sum p_i", Components::space, Terms::momenta},
            {"centre_of_mass", "sum m_i x_i/M - P t/M", Components::space, Terms::centre_of_mass}};
  }
  /// @param usual the frame of a start that is not given by the scenario
  static OptionInfo frame_key(const char* usual) {
    return {
        .name = "frame",
        .default_value = usual,
        .meaning =
            "barycentric: move the centre of mass of the start to the origin, at rest; given: leave the start as it is",
        .type = OptionType::word,
        .words = {StartFrames::given, StartFrames::barycentric},
        .condition = "with initial the default is \"given\", with bodies \"barycentric\""};
  }

  /// The logarithmic rate of d = (sum_{i<j} u_ij^-3)^(-1/6), u = r^2 + softening^2. d approximates the distance of the
  /// closest two bodies and is smooth if another pair becomes the closest. The smallest distance is at most (N (N -
  /// 1)/2)^(1/6) d.
  template <class S>
  S distance_rate(const Vector<S, dynamic>& q, const Vector<S, dynamic>& v) const {
    S approach(0);
    S closeness(0);
    const std::size_t n = space();
    const auto add = [&](std::size_t i, std::size_t j, const S* d, const S& u) {
      S half_rate(0);  // half of du/dt
      for (std::size_t k = 0; k < n; ++k) half_rate += d[k] * (v[i * n + k] - v[j * n + k]);
      const S inverse = R(1) / u;
      const S weight = inverse * inverse * inverse;
      closeness += weight;
      approach += weight * inverse * half_rate;
    };
    for_massive_pairs(q, add);
    for_massless_pairs(q, add);
    return particles() > 1 ? S(approach / closeness) : S(0);
  }

  /// q_i <- q_i - sum m q/M, p_i <- p_i - m_i P/M. This is done twice: the second pass removes the rounding errors of
  /// the first.
  void to_barycentre(Vector<R, dynamic>& q, Vector<R, dynamic>& p) const {
    const std::vector<R>& masses = model().masses;
    const R& total_mass = model().total_mass;
    const std::size_t n = space();
    for (int pass = 0; pass < 2; ++pass) {
      for (std::size_t k = 0; k < n; ++k) {
        R moment(0);
        R momentum(0);
        for (const std::size_t i : model().massive) {
          moment += masses[i] * q[i * n + k];
          momentum += p[i * n + k];
        }
        for (std::size_t i = 0; i < masses.size(); ++i) {
          q[i * n + k] -= moment / total_mass;
          p[i * n + k] -= model().inertia(i) * (momentum / total_mass);
        }
      }
    }
  }

 private:
  /// action(i, j, q_i - q_j, u) for pairs of massive bodies, i < j.
  template <class S, class Action>
  void for_massive_pairs(const Vector<S, dynamic>& q, const Action& action) const {
    const std::vector<std::size_t>& massive = model().massive;
    for (std::size_t a = 0; a < massive.size(); ++a) {
      for (std::size_t b = a + 1; b < massive.size(); ++b) {
        S d[3]{};
        const S u = this->square_of(q, massive[a], massive[b], d);
        action(massive[a], massive[b], d, u);
      }
    }
  }
  /// The same for a massless body i and a massive one j.
  template <class S, class Action>
  void for_massless_pairs(const Vector<S, dynamic>& q, const Action& action) const {
    for (const std::size_t i : model().massless) {
      for (const std::size_t j : model().massive) {
        S d[3]{};
        const S u = this->square_of(q, i, j, d);
        action(i, j, d, u);
      }
    }
  }
  /// c of the acceleration -c d of a massless body, d from the massive body j to it.
  template <class S>
  S massless_pull(const S& u, std::size_t j) const {
    return GravityModel<R>::Law::pull(R(model().constant * model().masses[j]), u);
  }
  template <std::size_t Space, class S>
  void forces_with_massless(const Vector<S, dynamic>& q, Vector<S, dynamic>& f) const {
    const std::vector<std::size_t>& massive = model().massive;
    for (S& x : f) x = S(R(0));
    for (std::size_t a = 0; a < massive.size(); ++a) {
      const std::size_t i = massive[a];
      S total[Space]{};
      for (std::size_t b = a + 1; b < massive.size(); ++b) {
        const std::size_t j = massive[b];
        S d[Space];
        for (std::size_t k = 0; k < Space; ++k) d[k] = q[i * Space + k] - q[j * Space + k];
        const S c = model().pull(model().square(d, Space), i, j);
        for (std::size_t k = 0; k < Space; ++k) {
          const S pull = c * d[k];
          total[k] += pull;
          f[j * Space + k] += pull;
        }
      }
      for (std::size_t k = 0; k < Space; ++k) f[i * Space + k] -= total[k];
    }
    for (const std::size_t i : model().massless) {
      S total[Space]{};
      for (const std::size_t j : massive) {
        S d[Space];
        for (std::size_t k = 0; k < Space; ++k) d[k] = q[i * Space + k] - q[j * Space + k];
        const S c = massless_pull(model().square(d, Space), j);
        for (std::size_t k = 0; k < Space; ++k) total[k] += c * d[k];
      }
      for (std::size_t k = 0; k < Space; ++k) f[i * Space + k] -= total[k];
    }
  }

  static auto model_of(const std::vector<R>& masses, const R& constant, const R& softening, std::size_t space) {
    auto model = std::make_shared<GravityModel<R>>();
    model->space = space;
    model->set_masses(masses);
    for (std::size_t i = 0; i < masses.size(); ++i) {
      const bool is_massive = R(0) < masses[i];
      (is_massive ? model->massive : model->massless).push_back(i);
      if (!is_massive) model->inverse_masses[i] = R(1);
    }
    model->constant = constant;
    model->softening_squared = softening * softening;
    return model;
  }
};

}  // namespace hamflow
