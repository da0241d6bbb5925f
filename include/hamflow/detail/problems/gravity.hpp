// N bodies under gravity, H = sum |p_i|^2/(2 m_i) - G sum_{i<j} m_i m_j/sqrt(r_ij^2 + softening^2), in the plane or in
// space: the pair system with the law `newton` and the strength G m_i m_j.   [HLW2006, (I.2.11)]
#pragma once

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
  using Base::space;

  /// @param dimensions the dimension of space, 2 or 3
  Gravity(const std::vector<R>& masses, const R& gravitational_constant, const R& softening, std::size_t dimensions)
      : Base(model_of(masses, gravitational_constant, softening, dimensions)) {}

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
        .condition = "with initial the default is \"given\""};
  }

  /// The logarithmic rate of d = (sum_{i<j} u_ij^-3)^(-1/6), u = r^2 + softening^2. d approximates the distance of the
  /// closest two bodies and is smooth if another pair becomes the closest. The smallest distance is at most (N (N -
  /// 1)/2)^(1/6) d.
  template <class S>
  S distance_rate(const Vector<S, dynamic>& q, const Vector<S, dynamic>& v) const {
    S approach(0);
    S closeness(0);
    const std::size_t n = space();
    for (std::size_t i = 0; i < particles(); ++i) {
      for (std::size_t j = i + 1; j < particles(); ++j) {
        S d[3]{};
        const S u = this->square_of(q, i, j, d);
        S half_rate(0);  // half of du/dt
        for (std::size_t k = 0; k < n; ++k) half_rate += d[k] * (v[i * n + k] - v[j * n + k]);
        const S inverse = R(1) / u;
        const S weight = inverse * inverse * inverse;
        closeness += weight;
        approach += weight * inverse * half_rate;
      }
    }
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
        for (std::size_t i = 0; i < masses.size(); ++i) {
          moment += masses[i] * q[i * n + k];
          momentum += p[i * n + k];
        }
        for (std::size_t i = 0; i < masses.size(); ++i) {
          q[i * n + k] -= moment / total_mass;
          p[i * n + k] -= masses[i] * (momentum / total_mass);
        }
      }
    }
  }

 private:
  static auto model_of(const std::vector<R>& masses, const R& constant, const R& softening, std::size_t space) {
    auto model = std::make_shared<GravityModel<R>>();
    model->space = space;
    model->set_masses(masses);
    model->constant = constant;
    model->softening_squared = softening * softening;
    return model;
  }
};

}  // namespace hamflow
