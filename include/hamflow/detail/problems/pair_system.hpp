// N particles with forces between all pairs, in the plane or in space: H = sum |p_i|^2/(2 m_i) + sum_{i<j} V_ij(r_ij).
// q = [x1, y1(, z1), x2, ...], particle by particle. The model computes the contribution of a pair: gravity.hpp,
// gas_system.hpp. The force of a pair is computed once and added to both particles with opposite signs, so that the
// total momentum is conserved to the rounding of the sums.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/problem_info.hpp"
#include "hamflow/detail/core/near_pairs.hpp"
#include "hamflow/detail/core/radial_forces.hpp"

namespace hamflow {

/// The particles of a model.
template <class R>
struct Particles {
  std::size_t space = 2;  // dimension of space, 2 or 3
  std::vector<R> masses;  // one for each particle
  std::vector<R> inverse_masses;
  R total_mass{};

  void set_masses(std::vector<R> given) {
    masses = std::move(given);
    inverse_masses.clear();
    total_mass = R(0);
    for (const R& mass : masses) {
      inverse_masses.push_back(R(1) / mass);
      total_mass += mass;
    }
  }
};

/// A system of particles with pair potentials. Copies share their model.
/// @tparam M derives from Particles<R> and has, for particles i and j,
///   square(d, axes)     returns u = r^2 from d = q_i - q_j, and may replace d by that of the nearest images
///   ends(u)             whether the particles are out of range
///   energy(u, i, j)     V_ij
///   pull(u, i, j)       c, for the force -c d on i and c d on j
///   pull_times(factor)  a function of (u, i, j): factor times c, for kicks on the lattice
///   pair_hessian(u, i, j)       a function of (d, k, l): the entry k, l of d^2 V_ij/dq_i^2
///   strength(i, j), radial_law(u)   see RadialForces
///   turns_freely(), moves_freely()  whether angular and linear momentum are conserved
///   sums_by_rows        whether V is added up row by row, or as a single sum
/// Optional are pair_hessian_times(factor, u, i, j), which is pair_hessian for kicks on the lattice, and near, a shared
/// NearPairs or null. Pairs that NearPairs leaves out have energy, pull and kick 0.
template <class R, class M>
class PairSystem {
 public:
  using Real = R;
  using Model = M;
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
    return space() == 2 ? potential_in<2>(q) : potential_in<3>(q);
  }
  template <class S>
  void force(const Vector<S, dynamic>& q, Vector<S, dynamic>& f) const {
    if (space() == 2) {
      forces_in<2>(q, f);
    } else {
      forces_in<3>(q, f);
    }
  }
  template <class S>
  void force_and_hessian(const Vector<S, dynamic>& q, Vector<S, dynamic>& f, Matrix<S, dynamic>& hessian) const {
    force(q, f);
    for (std::size_t i = 0; i < size(); ++i) {
      for (std::size_t j = 0; j < size(); ++j) hessian[i][j] = S(R(0));
    }
    for (std::size_t i = 0; i < particles(); ++i) {
      for (std::size_t j = i + 1; j < particles(); ++j) add_pair(q, i, j, hessian);
    }
  }

  // The functions of PairwiseForces, for the lattice. Each contribution is rounded, and integers are summed. Row i
  // contains the pairs i, j > i. Every operation is symmetric or antisymmetric in i and j, so that another numbering of
  // the particles does not change a bit of a contribution.
  std::size_t pair_rows() const { return particles(); }
  std::size_t pairs_in_row(std::size_t i) const { return particles() - 1 - i; }
  template <class F, class Difference, class Sink>
  void pair_kicks(const F& factor, const Difference& difference, std::size_t first, std::size_t last,
                  Sink& sink) const {
    pair_kicks(factor, difference, first, last, sink, AllPairs{particles()});
  }
  /// As above, without the pairs that `near` omits.
  template <class F, class Difference, class Sink, class Near>
  void pair_kicks(const F& factor, const Difference& difference, std::size_t first, std::size_t last, Sink& sink,
                  const Near& near) const {
    if (space() == 2) {
      pair_kicks_in<2>(factor, difference, first, last, sink, near);
    } else {
      pair_kicks_in<3>(factor, difference, first, last, sink, near);
    }
  }
  /// Required by HasNearPairs (detail/methods/pair_sums.hpp).
  template <class Position>
  NearPairs::Turn near_pairs(const Position& position, ThreadTeam* team = nullptr) const requires
      requires(const Model& model) {
    model.near;
  }
  { return model_->near ? model_->near->at(position, team) : NearPairs::Turn(particles()); }
  /// As above, with -third V''(q) v added.
  template <class F, class Difference, class Sink>
  void pair_gradient_kicks(const F& factor, const F& third, const Vector<F, dynamic>& v, const Difference& difference,
                           std::size_t first, std::size_t last, Sink& sink) const requires
      requires(const Model& model, const F& u) {
    model.bend_along(u, 0, 0, u);
  }
  {
    const std::size_t n = space();
    for (std::size_t i = first; i < last; ++i) {
      for (std::size_t j = i + 1; j < particles(); ++j) {
        F d[3]{};
        F w[3]{};  // v_i - v_j
        F dw(0);
        for (std::size_t k = 0; k < n; ++k) {
          d[k] = difference(i * n + k, j * n + k);
          w[k] = v[i * n + k] - v[j * n + k];
          dw += d[k] * w[k];
        }
        const F u = model_->square(d, n);
        const auto [pull, along] = model_->bend_along(u, i, j, dw);
        for (std::size_t k = 0; k < n; ++k) {
          sink(j * n + k, i * n + k, factor * (pull * d[k]) + third * along(d[k], w[k]));
        }
      }
    }
  }

  // The functions of RadialForces.
  std::size_t radial_space() const { return space(); }
  std::vector<RadialTerm<R>> radial_terms() const {
    std::vector<RadialTerm<R>> terms;
    for (std::size_t i = 0; i < particles(); ++i) {
      for (std::size_t j = i + 1; j < particles(); ++j) {
        terms.push_back({i * space(), j * space(), model_->strength(i, j)});
      }
    }
    return terms;
  }
  template <class S>
  RadialLaw<S> radial_law(const S& u) const {
    return model_->radial_law(u);
  }

  /// The numbers of components of angular momentum, linear momentum and centre of mass; 0 if the model does not
  /// conserve the quantity. They are stored in place, because they are needed at every step.
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
    if (model_->turns_freely()) sizes.entry[sizes.count++] = space() == 2 ? 1 : 3;
    for (int i = 0; model_->moves_freely() && i < 2; ++i) sizes.entry[sizes.count++] = space();
    return sizes;
  }
  template <class S>
  Vector<S, dynamic> invariants(const Vector<S, dynamic>& q, const Vector<S, dynamic>& p, const S& t) const {
    const std::size_t n = space();
    const bool moves = model_->moves_freely();
    const std::size_t rotations = model_->turns_freely() ? (n == 2 ? 1 : 3) : 0;
    Vector<S, dynamic> all(rotations + (moves ? 2 * n : 0));
    for (std::size_t i = 0; i < particles(); ++i) {
      const std::size_t at = i * n;
      if (rotations == 1) all[0] += q[at] * p[at + 1] - q[at + 1] * p[at];
      for (std::size_t k = 0; rotations == 3 && k < 3; ++k) {
        const std::size_t a = at + (k + 1) % 3;
        const std::size_t b = at + (k + 2) % 3;
        all[k] += q[a] * p[b] - q[b] * p[a];
      }
      for (std::size_t k = 0; moves && k < n; ++k) {
        all[rotations + k] += p[at + k];
        all[rotations + n + k] += q[at + k] * model_->masses[i];
      }
    }
    for (std::size_t k = 0; moves && k < n; ++k) {
      S& centre = all[rotations + n + k];
      centre = (centre - all[rotations + k] * t) / total_mass();
    }
    return all;
  }

 protected:
  /// Returns u of a pair, and sets d.
  template <class S>
  S square_of(const Vector<S, dynamic>& q, std::size_t i, std::size_t j, S* d) const {
    const std::size_t n = space();
    for (std::size_t k = 0; k < n; ++k) d[k] = q[i * n + k] - q[j * n + k];
    return model_->square(d, n);
  }

 private:
  /// Returns all pairs for dual numbers and recordings; neighbour lists are used only for plain numbers.
  template <class S>
  auto pairs_at([[maybe_unused]] const Vector<S, dynamic>& q) const {
    if constexpr (std::is_same_v<S, R> && requires { model_->near; }) {
      return near_pairs([&](std::size_t k) -> const S& { return q[k]; });
    } else {
      return AllPairs{particles()};
    }
  }
  template <std::size_t Space, class S>
  S potential_in(const Vector<S, dynamic>& q) const {
    S sum(R(0));
    const auto near = pairs_at(q);
    for (std::size_t i = 0; i < particles(); ++i) {
      S row(R(0));
      const auto partners = near[i];
      for (std::size_t at = 0; at < partners.size(); ++at) {
        const std::size_t j = partners[at];
        S d[Space];
        for (std::size_t k = 0; k < Space; ++k) d[k] = q[i * Space + k] - q[j * Space + k];
        const S u = model_->square(d, Space);
        (Model::sums_by_rows ? row : sum) += model_->energy(u, i, j);
      }
      if constexpr (Model::sums_by_rows) sum += row;
    }
    return sum;
  }
  template <std::size_t Space, class S>
  void forces_in(const Vector<S, dynamic>& q, Vector<S, dynamic>& f) const {
    for (S& x : f) x = S(R(0));
    const auto near = pairs_at(q);
    for (std::size_t i = 0; i < particles(); ++i) {
      const S* const a = q.begin() + i * Space;
      S* const on_a = f.begin() + i * Space;
      S total[Space]{};
      const auto partners = near[i];
      for (std::size_t at = 0; at < partners.size(); ++at) {
        const std::size_t j = partners[at];
        const S* const b = q.begin() + j * Space;
        S* const on_b = f.begin() + j * Space;
        S d[Space];
        for (std::size_t k = 0; k < Space; ++k) d[k] = a[k] - b[k];
        const S u = model_->square(d, Space);
        const S c = model_->pull(u, i, j);
        for (std::size_t k = 0; k < Space; ++k) {
          const S pull = c * d[k];
          total[k] += pull;
          on_b[k] += pull;
        }
      }
      for (std::size_t k = 0; k < Space; ++k) on_a[k] -= total[k];
    }
  }
  template <std::size_t Space, class F, class Difference, class Sink, class Near>
  void pair_kicks_in(const F& factor, const Difference& difference, std::size_t first, std::size_t last, Sink& sink,
                     const Near& near) const {
    const auto pull = model_->pull_times(factor);
    for (std::size_t i = first; i < last; ++i) {
      const auto partners = near[i];
      for (std::size_t at = 0; at < partners.size(); ++at) {
        const std::size_t j = partners[at];
        F d[Space];
        for (std::size_t k = 0; k < Space; ++k) d[k] = difference(i * Space + k, j * Space + k);
        const F u = model_->square(d, Space);
        if (model_->ends(u)) continue;
        const F c = pull(u, i, j);
        for (std::size_t k = 0; k < Space; ++k) sink(j * Space + k, i * Space + k, c * d[k]);
      }
    }
  }
  /// Adds d^2 V_ij/dq_i^2 to the blocks ii and jj, and subtracts it from ij and ji.
  template <class S>
  void add_pair(const Vector<S, dynamic>& q, std::size_t i, std::size_t j, Matrix<S, dynamic>& h) const {
    const std::size_t n = space();
    S d[3]{};
    const S u = square_of(q, i, j, d);
    const auto pair_hessian = model_->pair_hessian(u, i, j);
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t l = 0; l < n; ++l) {
        const S entry = pair_hessian(d, k, l);
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
