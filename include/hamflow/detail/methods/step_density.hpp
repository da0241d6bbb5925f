// Reversible steps of varying size: explicit step density control.   [HairerSoederlind2005; HLW2006, Sect. VIII.3.2]
// rho is the density of steps, their number per time dt. With sigma(z), the wanted step size up to a factor, and G =
// -d/dt ln sigma along the motion,
//     rho_{n+1/2} = rho_{n-1/2} + dt G(z_n),   h = dt/rho_{n+1/2},   z_{n+1} = Psi_h(z_n),   t_{n+1} = t_n + h
// so that rho sigma is constant to second order in dt. The density is defined between two steps and changes at their
// common point, and there is no other memory: going back from z_{n+1} with the same rho, the step reaches z_n, and
// subtracting G(z_n) gives rho_{n-1/2}. With a symmetric Psi the map of (z, rho) is symmetric, and reversible if Psi is
// reversible and G is odd in p. A length computed from the start of a step has neither property, and energies would
// drift. Only ratios of steps matter: the density starts with 1, the first step with dt.
#pragma once

#include <functional>
#include <limits>
#include <string>

#include "hamflow/arithmetic/compensated.hpp"
#include "hamflow/core/concepts.hpp"
#include "hamflow/core/math.hpp"
#include "hamflow/detail/core/step_clock.hpp"

namespace hamflow {

/// The function that controls the step size.
template <class R, std::size_t N>
struct StepMonitor {
  std::string name;
  /// G = -d/dt ln sigma at (q, p), 1/time.
  std::function<R(const Vector<R, N>& q, const Vector<R, N>& p)> rate;
};

/// An arithmetic for recording steps of any length: the length is an input like the numbers of the state.
template <class A>
struct WithAnyLength : A {
  using Length = typename A::Real;
};

/// rho, stored like the state of a run, and the time. On the lattice rho is an integer, and the rounding of G is odd,
/// so that a reversed run has exactly the same lengths.
/// @tparam A the arithmetic of the run
template <Arithmetic A>
class StepDensity {
 public:
  using Real = typename A::Real;

  /// @param step the first step; negative: backwards in time @param start the time at which it begins
  explicit StepDensity(const Real& step, const Real& start = Real(0)) : step_(step) {
    if constexpr (requires { axis_.set_unit(lattice_unit); }) axis_.set_unit(lattice_unit);
    density_ = axis_.store(Real(1));
    time_ = Time::store(start);
  }

  /// Whether there is a next step. If G is large compared with 1/dt, the density may become 0 or infinite.
  bool is_usable() const {
    const Real rho = axis_.read(density_);
    return rho > Real(0) && rho <= Real(std::numeric_limits<Real>::max()) && !is_lost();
  }
  Real density() const { return axis_.read(density_); }
  /// The length of the next step.
  Real length() const { return step_ / Real(axis_.read(density_)); }
  Real time() const { return Time::read(time_); }
  TimeWords<Real> time_in_words() const { return {time_.high, time_.low}; }
  /// The time after a step of length h.
  TimeWords<Real> time_in_words_after(const Real& h) const {
    auto after = time_;
    Time::add(after, h);
    return {after.high, after.low};
  }

  /// Records a step of length h. @param rate G at its end
  void advance(const Real& h, const Real& rate) {
    Time::add(time_, h);
    axis_.add(density_, step_ * rate);
  }
  /// Call this after the momenta were reversed: the next step has the length of the last one. @param rate G of the
  /// new state
  void turn(const Real& rate) { axis_.add(density_, step_ * rate); }
  /// Reverses the time. @param rate G of the state
  void reverse_time(const Real& rate) {
    step_ = -step_;
    turn(rate);
  }
  template <class Archive>
  void archive(Archive& ar) {
    ar(step_, density_, time_);
  }

 private:
  /// On the lattice a step size has 12 digits and may be 2^22 times shorter than the first one.
  static constexpr double lattice_unit = 0x1p-40;
  using Time = typename Compensated<Real>::Axis;

  bool is_lost() const {
    if constexpr (requires { axis_.lost; }) {
      return axis_.lost;
    } else {
      return false;
    }
  }

  Real step_;
  [[no_unique_address]] typename A::Axis axis_{};
  typename A::Stored density_{};
  typename Compensated<Real>::Stored time_{};
};

}  // namespace hamflow
