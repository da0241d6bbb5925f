// N particles with forces between all pairs, in the plane or in space, in a container:
//   H = sum |p_i|^2/(2 m_i) + (1/S^2) sum_{i<j} phi(S r_ij) + V of the container,
// phi one of several pair laws, with or without a cut-off, S a scale of lengths. q = [x1, y1(, z1), x2, ...], particle
// by particle.   [Sonnleitner2010, ch. 1.7, 3a] A pair law is a class with value(u), first(u) and second(u), phi and
// its derivatives by u = r^2 (problems/pairs). Which one it is, is known at run time: a branch that is always taken the
// same way costs little beside a quotient, and each law more would have every loop compiled once more for each number
// type. What pairs give and what the container gives are separate functions: the first can be computed by others.
#pragma once

#include <array>
#include <memory>
#include <variant>
#include <vector>

#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/problem_info.hpp"
#include "hamflow/core/radial_forces.hpp"
#include "hamflow/problems/support/container.hpp"
#include "hamflow/problems/support/cutoff.hpp"

namespace hamflow {

/// What all functions of one pair system share.
template <class R, class Law>
struct PairModel {
  std::size_t space = 2;
  std::vector<R> inverse_masses;  // one for each particle
  std::vector<R> masses;
  R total_mass{};
  Law law;  // a variant of pair laws
  R scale{1};
  R scale_squared{1};
  Cutoff<R> cutoff;
  ContainerKind container = ContainerKind::none;
  SoftWall<R> wall;      // of a circle
  std::vector<R> edges;  // of a periodic box
  std::vector<R> half_edges;
};

/// Copies share their model.
/// @tparam Laws a std::variant of pair laws with parameters of type R
template <class R, class Laws>
class PairSystem {
 public:
  using Real = R;
  using Model = PairModel<R, Laws>;
  static constexpr std::size_t dimension = dynamic;
  static constexpr bool quadratic_kinetic = true;

  explicit PairSystem(std::shared_ptr<const Model> model) : model_(std::move(model)) {}

  const Model& model() const { return *model_; }
  std::size_t particles() const { return model_->masses.size(); }
  std::size_t space() const { return model_->space; }
  std::size_t size() const { return particles() * space(); }
  const R& total_mass() const { return model_->total_mass; }

  template <class S>
  S kinetic(const Vector<S, dynamic>& p) const {
    S sum(R(0));
    for (std::size_t i = 0; i < particles(); ++i) {
      S square(R(0));
      for (std::size_t k = 0; k < space(); ++k) square += p[i * space() + k] * p[i * space() + k];
      sum += square * (model_->inverse_masses[i] / R(2));
    }
    return sum;
  }
  template <class S>
  void velocity(const Vector<S, dynamic>& p, Vector<S, dynamic>& v) const {
    for (std::size_t i = 0; i < particles(); ++i) {
      for (std::size_t k = 0; k < space(); ++k) v[i * space() + k] = p[i * space() + k] * model_->inverse_masses[i];
    }
  }
  template <class S>
  S potential(const Vector<S, dynamic>& q) const {
    return pair_potential(q) + container_potential(q);
  }
  template <class S>
  void force(const Vector<S, dynamic>& q, Vector<S, dynamic>& f) const {
    pair_forces(q, f);
    add_container_forces(q, f);
  }
  template <class S>
  void force_and_hessian(const Vector<S, dynamic>& q, Vector<S, dynamic>& f, Matrix<S, dynamic>& h) const {
    force(q, f);
    for (std::size_t i = 0; i < size(); ++i) {
      for (std::size_t j = 0; j < size(); ++j) h[i][j] = S(R(0));
    }
    for (std::size_t i = 0; i < particles(); ++i) {
      for (std::size_t j = i + 1; j < particles(); ++j) add_pair(q, i, j, h);
    }
    if (model_->container != ContainerKind::circle) return;
    for (std::size_t i = 0; i < particles(); ++i) {
      const std::size_t at = i * space();
      const auto [first, second] = model_->wall.bend(q.begin() + at, space(), i);
      for (std::size_t k = 0; k < space(); ++k) {
        h[at + k][at + k] += first;
        for (std::size_t l = 0; l < space(); ++l) h[at + k][at + l] += second * q[at + k] * q[at + l];
      }
    }
  }

  // The part of the pairs.
  template <class S>
  S pair_potential(const Vector<S, dynamic>& q) const {
    S sum(R(0));
    for (std::size_t i = 0; i < particles(); ++i) {
      S row(R(0));
      for (std::size_t j = i + 1; j < particles(); ++j) {
        S d[3]{};
        row += value(square_of(q, i, j, d));
      }
      sum += row;
    }
    return sum;
  }
  template <class S>
  void pair_forces(const Vector<S, dynamic>& q, Vector<S, dynamic>& f) const {
    for (S& x : f) x = S(R(0));
    const std::size_t n = space();
    for (std::size_t i = 0; i < particles(); ++i) {
      S total[3]{};
      for (std::size_t j = i + 1; j < particles(); ++j) {
        S d[3]{};
        const S c = R(-2) * first(square_of(q, i, j, d));
        for (std::size_t k = 0; k < n; ++k) {
          const S push = c * d[k];
          total[k] += push;
          f[j * n + k] -= push;
        }
      }
      for (std::size_t k = 0; k < n; ++k) f[i * n + k] += total[k];
    }
  }
  // And that of the container.
  template <class S>
  S container_potential(const Vector<S, dynamic>& q) const {
    S sum(R(0));
    if (model_->container != ContainerKind::circle) return sum;
    for (std::size_t i = 0; i < particles(); ++i) sum += model_->wall.potential(q.begin() + i * space(), space(), i);
    return sum;
  }
  template <class S>
  void add_container_forces(const Vector<S, dynamic>& q, Vector<S, dynamic>& f) const {
    if (model_->container != ContainerKind::circle) return;
    for (std::size_t i = 0; i < particles(); ++i) {
      const std::size_t at = i * space();
      const S pull = model_->wall.pull(q.begin() + at, space(), i);
      for (std::size_t k = 0; k < space(); ++k) f[at + k] += pull * q[at + k];
    }
  }

  // As PairwiseForces, for the lattice: each contribution is rounded, and integers are summed. Row i holds the pairs i,
  // j > i; numbering the particles otherwise changes no bit of a contribution. The wall's are those of single
  // particles.
  std::size_t pair_rows() const { return particles(); }
  std::size_t pairs_in_row(std::size_t i) const { return particles() - 1 - i; }
  template <class F, class Difference, class Sink>
  void pair_kicks(const F& factor, const Difference& difference, std::size_t begin, std::size_t end, Sink& sink) const {
    const std::size_t n = space();
    const F twice = R(2) * factor;
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t j = i + 1; j < particles(); ++j) {
        F d[3]{};
        F u(R(0));
        for (std::size_t k = 0; k < n; ++k) {
          d[k] = difference(i * n + k, j * n + k);
          if (model_->container == ContainerKind::periodic) to_nearest(k, d[k]);
          u += d[k] * d[k];
        }
        if (model_->cutoff.ends(F(model_->scale_squared * u))) continue;
        const F c = twice * first(u);
        for (std::size_t k = 0; k < n; ++k) sink(j * n + k, i * n + k, c * d[k]);
      }
    }
  }
  /// @param position the k-th coordinate   @param sink (k, r): adds r to the k-th momentum
  template <class F, class Position, class Sink>
  void single_kicks(const F& factor, const Position& position, const Sink& sink) const {
    if (model_->container != ContainerKind::circle) return;
    const std::size_t n = space();
    for (std::size_t i = 0; i < particles(); ++i) {
      F q[3]{};
      for (std::size_t k = 0; k < n; ++k) q[k] = position(i * n + k);
      const F pull = factor * model_->wall.pull(q, n, i);
      for (std::size_t k = 0; k < n; ++k) sink(i * n + k, pull * q[k]);
    }
  }

  /// (1/S^2) phi(S r) as a function of u = r^2, and its derivatives by u.
  template <class S>
  S value(const S& u) const {
    const S w = model_->scale_squared * u;
    if (model_->cutoff.ends(w)) return S(R(0));
    return std::visit([&](const auto& law) { return S(model_->cutoff.value(w, S(law.value(w)))); }, model_->law) /
           model_->scale_squared;
  }
  template <class S>
  S first(const S& u) const {
    const S w = model_->scale_squared * u;
    if (model_->cutoff.ends(w)) return S(R(0));
    return std::visit([&](const auto& law) { return S(model_->cutoff.first(w, S(law.first(w)), law)); }, model_->law);
  }
  template <class S>
  S second(const S& u) const {
    const S w = model_->scale_squared * u;
    if (model_->cutoff.ends(w)) return S(R(0));
    return model_->scale_squared *
           std::visit([&](const auto& law) { return S(model_->cutoff.second(w, S(law.second(w)), law)); }, model_->law);
  }

  // As RadialForces, without a container: who offers it looks.
  std::size_t radial_space() const { return space(); }
  std::vector<RadialTerm<R>> radial_terms() const {
    std::vector<RadialTerm<R>> terms;
    for (std::size_t i = 0; i < particles(); ++i) {
      for (std::size_t j = i + 1; j < particles(); ++j) terms.push_back({i * space(), j * space(), R(1)});
    }
    return terms;
  }
  template <class S>
  RadialLaw<S> radial_law(const S& u) const {
    return {value(u), first(u), second(u)};
  }

  /// Angular momentum, linear momentum and centre of mass, as far as the container leaves them.
  bool turns_freely() const {
    return model_->container == ContainerKind::none || model_->container == ContainerKind::circle;
  }
  bool moves_freely() const {
    return model_->container == ContainerKind::none || model_->container == ContainerKind::periodic;
  }
  /// In place: they are asked for at every step.
  struct Sizes {
    std::array<std::size_t, 3> entry{};
    std::size_t count = 0;
    const std::size_t* begin() const { return entry.data(); }
    const std::size_t* end() const { return entry.data() + count; }
    std::size_t size() const { return count; }
    std::size_t operator[](std::size_t i) const { return entry[i]; }
  };
  Sizes invariant_sizes() const {
    Sizes sizes;
    if (turns_freely()) sizes.entry[sizes.count++] = space() == 2 ? 1 : 3;
    for (int i = 0; moves_freely() && i < 2; ++i) sizes.entry[sizes.count++] = space();
    return sizes;
  }
  template <class S>
  Vector<S, dynamic> invariants(const Vector<S, dynamic>& q, const Vector<S, dynamic>& p, const S& t) const {
    const std::size_t n = space();
    const std::size_t rotations = turns_freely() ? (n == 2 ? 1 : 3) : 0;
    Vector<S, dynamic> all(rotations + (moves_freely() ? 2 * n : 0));
    for (std::size_t i = 0; i < particles(); ++i) {
      const std::size_t at = i * n;
      if (rotations == 1) all[0] += q[at] * p[at + 1] - q[at + 1] * p[at];
      for (std::size_t k = 0; rotations == 3 && k < 3; ++k) {
        const std::size_t a = at + (k + 1) % 3;
        const std::size_t b = at + (k + 2) % 3;
        all[k] += q[a] * p[b] - q[b] * p[a];
      }
      for (std::size_t k = 0; moves_freely() && k < n; ++k) {
        all[rotations + k] += p[at + k];
        all[rotations + n + k] += q[at + k] * model_->masses[i];
      }
    }
    for (std::size_t k = 0; moves_freely() && k < n; ++k) {
      S& centre = all[rotations + n + k];
      centre = (centre - all[rotations + k] * t) / total_mass();
    }
    return all;
  }

 private:
  /// r^2 of a pair, and d = q_i - q_j, in a periodic box that of the nearest images.
  template <class S>
  S square_of(const Vector<S, dynamic>& q, std::size_t i, std::size_t j, S* d) const {
    const std::size_t n = space();
    S u(R(0));
    for (std::size_t k = 0; k < n; ++k) {
      d[k] = q[i * n + k] - q[j * n + k];
      if (model_->container == ContainerKind::periodic) to_nearest(k, d[k]);
      u += d[k] * d[k];
    }
    return u;
  }
  /// Edge by edge: particles that have gone far are many edges apart, but each comparison is one that recordings know.
  template <class S>
  void to_nearest(std::size_t k, S& d) const {
    const R& edge = model_->edges[k];
    const S half(model_->half_edges[k]);
    if constexpr (std::is_same_v<S, double>) {
      d -= edge * std::nearbyint(d / edge);
    } else {
      if (!(d <= S(R(1e6) * edge) && S(R(-1e6) * edge) <= d)) return;  // no number, or as good as none
      while (half < d) d -= edge;
      while (d < -half) d += edge;
    }
  }
  /// -F of the pair by q: 2 phi' I + 4 phi'' d d^T in the blocks ii and jj, its negative in ij and ji.
  template <class S>
  void add_pair(const Vector<S, dynamic>& q, std::size_t i, std::size_t j, Matrix<S, dynamic>& h) const {
    const std::size_t n = space();
    S d[3]{};
    const S u = square_of(q, i, j, d);
    const S slope = R(2) * first(u);
    const S bend = R(4) * second(u);
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t l = 0; l < n; ++l) {
        const S entry = (k == l ? slope : S(R(0))) + bend * d[k] * d[l];
        h[i * n + k][i * n + l] += entry;
        h[j * n + k][j * n + l] += entry;
        h[i * n + k][j * n + l] -= entry;
        h[j * n + k][i * n + l] -= entry;
      }
    }
  }

  std::shared_ptr<const Model> model_;
};

}  // namespace hamflow
