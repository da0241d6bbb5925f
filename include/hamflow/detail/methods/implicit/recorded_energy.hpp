// H as a recording, to compute its differences without cancellation (detail/numerics/slope.hpp).
#pragma once

#include <memory>

#include "hamflow/detail/methods/tape_of_motion.hpp"
#include "hamflow/detail/numerics/tape_replay.hpp"

namespace hamflow {

namespace detail {
template <std::size_t N, class S>
std::pair<Vector<S, N>, Vector<S, N>> coordinates_and_momenta(const Vector<S, dynamic>& z) {
  const std::size_t size = z.size() / 2;
  std::pair<Vector<S, N>, Vector<S, N>> parts{zeros<S, N>(size), zeros<S, N>(size)};
  for (std::size_t i = 0; i < size; ++i) {
    parts.first[i] = z[i];
    parts.second[i] = z[size + i];
  }
  return parts;
}
template <class S>
Vector<base_scalar<S>, dynamic> values_of(const Vector<S, dynamic>& z) {
  Vector<base_scalar<S>, dynamic> values(z.size());
  for (std::size_t i = 0; i < z.size(); ++i) values[i] = value_of(z[i]);
  return values;
}
}  // namespace detail

/// Functions of z = (q, p) on a tape, which is recorded again if a branch changes.
template <class P, class R>
class RecordedFunctions {
 public:
  static constexpr std::size_t n = P::dimension;
  /// @param record(problem, q, p) makes the tape
  template <class Record>
  RecordedFunctions(const P& problem, const Record& record) : record_(record) {
    const auto [q, p] = detail::any_state<R, n>(problem);
    tape_ = std::make_shared<const Tape<R>>(record(problem, q, p));
  }

  /// Calls take(k, slope) with the slopes (f_k(z + t s) - f_k(z))/t of all functions; for t = 0 these are derivatives
  /// along s.
  /// @return false if z and z + t s lie on different sides of a branch
  template <class S, class Take>
  bool slopes(const P& problem, const Vector<S, dynamic>& z, const Vector<S, dynamic>& s, const S& t,
              const Take& take) const {
    for (int attempt = 0; attempt < 2; ++attempt) {
      Vector<Slope<S>, dynamic> nodes(tape_->nodes.size());
      for (std::size_t i = 0; i < z.size(); ++i) nodes[i] = Slope<S>(z[i], z[i] + t * s[i], s[i]);
      if (replay(*tape_, nodes)) {
        for (std::size_t k = 0; k < tape_->outputs.size(); ++k) {
          take(k, nodes[static_cast<std::size_t>(tape_->outputs[k])].slope);
        }
        return true;
      }
      if (attempt > 0) break;
      const auto [q, p] = detail::coordinates_and_momenta<n>(detail::values_of(z));
      tape_ = std::make_shared<const Tape<R>>(record_(problem, q, p));
    }
    return false;
  }

 private:
  Tape<R> (*record_)(const P&, const Vector<R, n>&, const Vector<R, n>&);
  mutable std::shared_ptr<const Tape<R>> tape_;  // follows from the state and is not part of the state of a run
};

/// H.
template <class P, class R>
class RecordedEnergy {
 public:
  explicit RecordedEnergy(const P& problem) : functions_(problem, &tape_of_energy<R, P, P::dimension>) {}

  /// (H(z + t s) - H(z))/t.
  template <class S>
  S slope(const P& problem, const Vector<S, dynamic>& z, const Vector<S, dynamic>& s, const S& t) const {
    S found{};
    if (slope_on_tape(problem, z, s, t, found)) return found;
    Vector<S, dynamic> end = z;
    for (std::size_t i = 0; i < z.size(); ++i) end[i] = z[i] + t * s[i];
    const auto [q0, p0] = detail::coordinates_and_momenta<P::dimension>(z);
    const auto [q1, p1] = detail::coordinates_and_momenta<P::dimension>(end);
    return (energy(problem, q1, p1) - energy(problem, q0, p0)) / t;
  }
  /// As above, for number types that the problem does not support. @return false if a branch lies in between
  template <class S>
  bool slope_on_tape(const P& problem, const Vector<S, dynamic>& z, const Vector<S, dynamic>& s, const S& t,
                     S& found) const {
    return functions_.slopes(problem, z, s, t, [&](std::size_t, const S& slope) { found = slope; });
  }

 private:
  RecordedFunctions<P, R> functions_;
};

}  // namespace hamflow
