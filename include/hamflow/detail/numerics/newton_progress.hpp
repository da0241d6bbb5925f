// The convergence test of the iteration of an implicit step: from the sizes of successive corrections it decides
// whether another one is needed. It uses only plain numbers and does not know the equations. Newton's method in general
// (detail/methods/implicit/newton.hpp), its recorded iterations (src/engine/iteration_runner.hpp), those of members in
// lanes (src/lanes/iterated_pack.hpp) and the fast path in the plane
// (detail/methods/implicit/two_variable_fast_path.hpp) all use it, so that equal corrections end the iteration at the
// same place, with the same bits.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>

#include "hamflow/core/math.hpp"

namespace hamflow {

/// The order of convergence: quadratic for Newton, linear with a Jacobian from an earlier iteration or none.
enum class Convergence { quadratic, linear };

enum class NewtonDecision {
  go_on,      // apply the correction, and compute another one
  settled,    // the error after this correction is at rounding level
  stalled,    // corrections no longer decrease, but are larger than the estimated rounding: check further, or continue
  not_finite  // no solution can be reached from here
};

template <class Real>
class NewtonProgress {
 public:
  constexpr NewtonProgress() = default;
  constexpr explicit NewtonProgress(Convergence convergence) : convergence_(convergence) {}

  /// Judges a correction.
  /// @param size its size @param noise rounding of the corrected unknowns, in the same unit
  /// @param total sum of all numbers that must be finite, including the size, because a sum keeps NaN and infinity
  [[gnu::always_inline]] constexpr NewtonDecision judge(const Real& size, const Real& total, const Real& noise) {
    if (!(total <= std::numeric_limits<Real>::max())) return NewtonDecision::not_finite;
    if (!has_first_) first_ = size;
    has_first_ = true;
    const bool is_quadratic = convergence_ == Convergence::quadratic;
    const bool has_settled = is_quadratic ? settles_quadratically(size, previous_, is_anew_, noise, stalls_)
                                          : settles_linearly(size, previous_, is_anew_, noise, least_, stalls_);
    previous_ = size;
    is_anew_ = false;
    if (has_settled) return NewtonDecision::settled;
    return stalls_ >= (is_quadratic ? 4 : 12) ? NewtonDecision::stalled : NewtonDecision::go_on;
  }

  /// Restarts the comparison: the next correction has another unit, or the last one was damped.
  [[gnu::always_inline]] constexpr void restart() { is_anew_ = true; }
  [[gnu::always_inline]] constexpr void restart(Convergence convergence) {
    convergence_ = convergence;
    is_anew_ = true;
  }
  /// Call this if the last correction settled although the rounding of the terms is as large as the unknowns. As
  /// long as the terms decrease, this is not a solution.
  /// @return whether to continue; the next correction is then tested without comparison
  [[gnu::always_inline]] constexpr bool continues_with_terms(const Real& terms) {
    const bool go_on = hidden_ < 2 || terms < hiding_terms_ / 2;
    if (go_on) {
      ++hidden_;
      is_anew_ = true;
    }
    hiding_terms_ = terms;
    return go_on;
  }

  /// The number of successive corrections that did not decrease.
  [[gnu::always_inline]] constexpr int stalls() const { return stalls_; }
  /// Whether the first correction was larger than the terms of the step, that is, the guess was far from the solution.
  /// @param noise of the last correction
  [[gnu::always_inline]] constexpr bool began_far_away(const Real& noise) const {
    return std::numeric_limits<Real>::epsilon() * first_ > noise;
  }

 private:
  /// Whether the rounding of the residual hides the remaining error. A correction below the noise is noise. With a rate
  /// theta of decrease, quadratic convergence predicts theta^2 |correction| for the next one. The remaining error has
  /// the same sign at the same phase of every orbit and accumulates linearly, while rounding accumulates as a square
  /// root. It must therefore be so far below the noise that 10^8 steps (a random walk of 10^4 noises) do not show it,
  /// hence 1/16384. If the noise is larger than its estimate, corrections stop decreasing: two in a row below 4096
  /// estimates count as noise, too. Larger ones are a cycle of Newton's iteration without a solution. Without
  /// always_inline the compiler optimises this function separately first, which gives fewer branches and saves 3 % of a
  /// step of cg on Kepler.
  static constexpr bool settles_quadratically(const Real& size, const Real& before, bool is_anew, const Real& noise,
                                              int& stalls) {
    const Real rate = !is_anew && before > Real(0) ? size / before : Real(1);
    stalls = !is_anew && rate > Real(0.9) ? stalls + 1 : 0;
    return size <= noise || (!is_anew && rate * rate * size <= noise / 16384) ||
           (rate > Real(0.5) && size <= 64 * noise) || (stalls >= 2 && size <= Real(1 << 12) * noise);
  }

  /// The test for corrections that decrease by a factor theta each time. After a correction c the omitted corrections
  /// sum to theta/(1 - theta) c, with the sign of c. To avoid a drift over many steps this sum must be below
  /// noise/16384, or corrections must no longer decrease, as in a cycle of a few roundings.
  /// [HairerMcLachlanRazakarivony2008] Corrections above the noise count as such a cycle only after twelve in a row
  /// that are not smaller than the smallest so far, because decreasing corrections that rotate are sometimes larger
  /// than the one before.
  static constexpr bool settles_linearly(const Real& size, const Real& before, bool is_anew, const Real& noise,
                                         Real& least, int& stalls) {
    const Real rate = !is_anew && before > Real(0) ? size / before : Real(1);
    stalls = !is_anew && !(size < least) ? stalls + 1 : 0;
    if (is_anew || size < least) least = size;
    return size <= noise / 16384 || (rate < Real(1) && rate * size <= (Real(1) - rate) * noise / 16384) ||
           (stalls >= 1 && size <= noise) || (stalls >= 2 && size <= Real(4) * noise) ||
           (stalls >= 12 && size <= Real(1 << 12) * noise);
  }

  Convergence convergence_ = Convergence::quadratic;
  bool has_first_ = false;
  bool is_anew_ = true;  // there is no earlier correction in the same unit
  int stalls_ = 0;
  int hidden_ = 0;  // number of times that continues_with_terms() returned true
  Real first_ = Real(0);
  Real previous_ = Real(0);
  Real least_ = Real(0);  // the smallest of all earlier corrections
  Real hiding_terms_ = Real(0);
};

/// After an initial guess far from the solution, steps begin from the last state until this number of extrapolated
/// guesses in a row would have been good: the number of points of the extrapolation.
inline constexpr int good_guesses_needed = 3;
/// The number needed after another guess. @param wanted the number before it
constexpr int good_guesses_needed_after(int wanted, bool is_good) { return is_good ? wanted - 1 : good_guesses_needed; }

/// Whether the estimated rounding is at least a millionth of the unknowns. At a guess so bad that forces round by more
/// than the whole step, any correction looks small. At the solution of a step that does not begin at rest the ratio is
/// 10^-12, with h omega = 1000 it is 10^-10.
/// @param unit rounding of the largest unknown @param unknown the largest unknown
template <class Real>
constexpr bool hidden_by_rounding(const Real& unit, const Real& unknown) {
  return unit > unknown / (1 << 20);
}
/// As above, for numbers at a distance of `stride`, such as those of one lane.
inline bool hidden_by_rounding(const double* units, const double* unknowns, std::size_t count, std::size_t stride) {
  double unit = 0;
  double unknown = 0;
  for (std::size_t i = 0; i < count * stride; i += stride) {
    unit = larger(unit, units[i]);
    unknown = larger(unknown, std::abs(unknowns[i]));
  }
  return hidden_by_rounding(unit, unknown);
}

/// The size of one entry of a correction in units of its rounding. The unit of an entry that was 0 and has no noise is
/// its own rounding.
/// @param size its absolute value
template <class Real>
[[gnu::always_inline]] constexpr Real in_units_of_noise(const Real& size, const Real& unit) {
  const Real own = std::numeric_limits<Real>::epsilon() * size;
  const Real known = !(unit > std::numeric_limits<Real>::epsilon() * own) ? own : unit;
  return size / larger(known, std::numeric_limits<Real>::min());
}
/// The larger of two sizes; NaN counts as larger than any number.
template <class Real>
[[gnu::always_inline]] constexpr Real larger_size(const Real& a, const Real& b) {
  return b <= a ? a : b;
}

/// Sizes of corrections in `width` lanes, and the totals that NewtonProgress::judge() takes.
/// @param corrections, units `count` rows of lanes
inline void measure_corrections(const double* corrections, const double* units, std::size_t count, std::size_t width,
                                double* sizes, double* totals) {
  for (std::size_t lane = 0; lane < width; ++lane) sizes[lane] = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double* const of_lanes = corrections + i * width;
    const double* const unit = units + i * width;
    for (std::size_t lane = 0; lane < width; ++lane) {
      sizes[lane] = larger_size(sizes[lane], in_units_of_noise(std::abs(of_lanes[lane]), unit[lane]));
    }
  }
  for (std::size_t lane = 0; lane < width; ++lane) totals[lane] = sizes[lane];
  for (std::size_t i = 0; i < count; ++i) {
    const double* const of_lanes = corrections + i * width;
    for (std::size_t lane = 0; lane < width; ++lane) totals[lane] += std::abs(of_lanes[lane]);
  }
}

}  // namespace hamflow
