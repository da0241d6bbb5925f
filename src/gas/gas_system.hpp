// The gas, N particles in a container:
//   H = sum |p_i|^2/(2 m_i) + (1/S^2) sum_{i<j} phi(S r_ij) + V of the container,
// phi one of several pair laws, with or without a cut-off, S a scale of lengths.   [Sonnleitner2010, ch. 1.7, 3a] A
// pair law is a class with value(u), first(u) and second(u), phi and its derivatives by u = r^2 (problems/pairs). The
// law is chosen at run time: a well-predicted branch costs little compared with a quotient, while a template would
// compile every loop again for each law and number type. Pairs and container have separate functions, because bulk
// forces can compute the pairs.
#pragma once

#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include "container.hpp"
#include "cutoff.hpp"
#include "hamflow/detail/problems/pair_system.hpp"

namespace hamflow {

/// @tparam Laws a std::variant of pair laws with parameters of type R
template <class R, class Laws>
struct GasModel : Particles<R> {
  static constexpr bool sums_by_rows = true;

  Laws law;
  R scale{1};
  R scale_squared{1};
  Cutoff<R> cutoff{};
  ContainerKind container = ContainerKind::none;
  SoftWall<R> wall{};                 // for a circle
  std::vector<R> edges{};             // for a periodic box
  std::shared_ptr<NearPairs> near{};  // neighbour lists for a cut-off; null: all pairs

  explicit GasModel(Laws pairs) : law(std::move(pairs)) {}

  /// r^2; replaces d by the difference of the nearest images.
  template <class S>
  S square(S* d, std::size_t axes) const {
    S u(R(0));
    for (std::size_t k = 0; k < axes; ++k) {
      if (container == ContainerKind::periodic) to_nearest(k, d[k]);
      u += d[k] * d[k];
    }
    return u;
  }
  template <class S>
  bool ends(const S& u) const {
    return cutoff.ends(S(scale_squared * u));
  }
  template <class S>
  S energy(const S& u, std::size_t /*i*/, std::size_t /*j*/) const {
    return value(u);
  }
  template <class S>
  S pull(const S& u, std::size_t /*i*/, std::size_t /*j*/) const {
    return R(2) * first(u);
  }
  template <class F>
  auto pull_times(const F& factor) const {
    return [this, twice = F(R(2) * factor)](const F& u, std::size_t, std::size_t) { return F(twice * first(u)); };
  }
  /// 2 phi' I + 4 phi'' d d^T.
  template <class S>
  auto pair_hessian(const S& u, std::size_t /*i*/, std::size_t /*j*/) const {
    return [slope = S(R(2) * first(u)), outer = S(R(4) * second(u))](const S* d, std::size_t k, std::size_t l) {
      return S((k == l ? slope : S(R(0))) + outer * d[k] * d[l]);
    };
  }
  static R strength(std::size_t /*i*/, std::size_t /*j*/) { return R(1); }
  /// Valid only without a container; the caller checks this.
  template <class S>
  RadialLaw<S> radial_law(const S& u) const {
    return {value(u), first(u), second(u)};
  }
  bool turns_freely() const { return container == ContainerKind::none || container == ContainerKind::circle; }
  bool moves_freely() const { return container == ContainerKind::none || container == ContainerKind::periodic; }

  /// (1/S^2) phi(S r) as a function of u = r^2, with its derivatives by u.
  template <class S>
  S value(const S& u) const {
    const S w = scale_squared * u;
    if (cutoff.ends(w)) return S(R(0));
    return std::visit([&](const auto& phi) { return S(cutoff.value(w, S(phi.value(w)))); }, law) / scale_squared;
  }
  template <class S>
  S first(const S& u) const {
    const S w = scale_squared * u;
    if (cutoff.ends(w)) return S(R(0));
    return std::visit([&](const auto& phi) { return S(cutoff.first(w, S(phi.first(w)), phi)); }, law);
  }
  template <class S>
  S second(const S& u) const {
    const S w = scale_squared * u;
    if (cutoff.ends(w)) return S(R(0));
    return scale_squared * std::visit([&](const auto& phi) { return S(cutoff.second(w, S(phi.second(w)), phi)); }, law);
  }

 private:
  /// d minus the nearest whole number of edges. The number and the roundings are the same for every number type,
  /// however far apart the particles are. A recording keeps the number of the recorded state; two comparisons guard the
  /// range in which it is valid.
  template <class S>
  void to_nearest(std::size_t k, S& d) const {
    const R& edge = edges[k];
    const R count = nearest_whole(R(plain_value(d) / edge));
    if constexpr (!std::is_same_v<S, R>) {
      const auto [first, last] = range_of_images(count, edge);
      (void)(S(first) <= d && d <= S(last));
    }
    d -= S(R(edge * count));
  }
  template <class S>
  static R plain_value(const S& x) {
    if constexpr (IsDual<S>::value || requires { x.recorder; }) {
      return plain_value(x.value);
    } else {
      return x;
    }
  }
  /// Ties go to even, as decided in double.
  static R nearest_whole(const R& x) {
    if constexpr (std::is_floating_point_v<R>) {
      return nearbyint(x);
    } else {
      R count(0);
      for (double more = 1; more != 0 && more - more == 0;) {
        more = std::nearbyint(static_cast<double>(R(x - count)));
        count += R(more);
      }
      return count;
    }
  }
  /// The smallest and the largest distance d for which nearest_whole(d/edge) is `count`.
  static std::pair<R, R> range_of_images(const R& count, const R& edge) {
    R first = (count - R(0.5)) * edge;
    R last = (count + R(0.5)) * edge;
    if constexpr (std::is_floating_point_v<R>) {
      constexpr R infinity = std::numeric_limits<R>::infinity();
      if (!(abs(count) < infinity)) return {first, last};
      while (nearbyint(first / edge) >= count) first = std::nextafter(first, -infinity);
      while (nearbyint(first / edge) < count) first = std::nextafter(first, infinity);
      while (nearbyint(last / edge) <= count) last = std::nextafter(last, infinity);
      while (nearbyint(last / edge) > count) last = std::nextafter(last, -infinity);
    }
    return {first, last};
  }
};

template <class R, class Laws>
class GasSystem : public PairSystem<R, GasModel<R, Laws>> {
  using Pairs = PairSystem<R, GasModel<R, Laws>>;

 public:
  using Pairs::model;
  using Pairs::Pairs;
  using Pairs::particles;
  using Pairs::space;

  template <class S>
  S potential(const Vector<S, dynamic>& q) const {
    return Pairs::potential(q) + container_potential(q);
  }
  template <class S>
  void force(const Vector<S, dynamic>& q, Vector<S, dynamic>& f) const {
    Pairs::force(q, f);
    add_container_forces(q, f);
  }
  template <class S>
  void force_and_hessian(const Vector<S, dynamic>& q, Vector<S, dynamic>& f, Matrix<S, dynamic>& h) const {
    Pairs::force_and_hessian(q, f, h);
    add_container_forces(q, f);
    if (!has_wall()) return;
    for (std::size_t i = 0; i < particles(); ++i) {
      const std::size_t at = i * space();
      const auto [first, second] = model().wall.hessian_factors(q.begin() + at, space(), i);
      for (std::size_t k = 0; k < space(); ++k) {
        h[at + k][at + k] += first;
        for (std::size_t l = 0; l < space(); ++l) h[at + k][at + l] += second * q[at + k] * q[at + l];
      }
    }
  }

  // The contribution of the container.
  template <class S>
  S container_potential(const Vector<S, dynamic>& q) const {
    S sum(R(0));
    if (!has_wall()) return sum;
    for (std::size_t i = 0; i < particles(); ++i) sum += model().wall.potential(q.begin() + i * space(), space(), i);
    return sum;
  }
  template <class S>
  void add_container_forces(const Vector<S, dynamic>& q, Vector<S, dynamic>& f) const {
    if (!has_wall()) return;
    for (std::size_t i = 0; i < particles(); ++i) {
      const std::size_t at = i * space();
      const S pull = model().wall.pull(q.begin() + at, space(), i);
      for (std::size_t k = 0; k < space(); ++k) f[at + k] += pull * q[at + k];
    }
  }
  /// The kicks of the wall, for the lattice.
  /// @param position the k-th coordinate   @param sink (k, r): adds r to the k-th momentum
  template <class F, class Position, class Sink>
  void single_kicks(const F& factor, const Position& position, const Sink& sink) const {
    if (!has_wall()) return;
    const std::size_t n = space();
    for (std::size_t i = 0; i < particles(); ++i) {
      F q[3]{};
      for (std::size_t k = 0; k < n; ++k) q[k] = position(i * n + k);
      const F pull = factor * model().wall.pull(q, n, i);
      for (std::size_t k = 0; k < n; ++k) sink(i * n + k, pull * q[k]);
    }
  }

 private:
  bool has_wall() const { return model().container == ContainerKind::circle; }
};

}  // namespace hamflow
