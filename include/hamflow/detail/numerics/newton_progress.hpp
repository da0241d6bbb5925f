// The progress of an iteration that solves an implicit step: from the sizes of its corrections, one after the other, it
// decides whether the next one is wanted. Plain numbers go in, a decision comes out; nothing here knows equations.
// Newton's method in general (detail/methods/implicit/newton.hpp), its recorded iterations
// (src/engine/iteration_runner.hpp), those of members in lanes (src/lanes/iterated_pack.hpp) and the fast path in the
// plane (detail/methods/implicit/plane_road.hpp) all decide by it: equal corrections then end the iteration at the same
// place, with the same bits.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>

#include "hamflow/core/math.hpp"

namespace hamflow {

/// How corrections shrink: Newton's own, or those with a Jacobian of before, or with none.
enum class Convergence { quadratic, linear };

enum class NewtonDecision {
  go_on,      // apply the correction, and compute another one
  settled,    // what is left after this correction cannot be told from rounding
  stalled,    // corrections no longer shrink, but are larger than the estimate of rounding: look closer, or go on
  not_finite  // no solution can be reached from here
};

template <class Real>
class NewtonProgress {
 public:
  constexpr NewtonProgress() = default;
  constexpr explicit NewtonProgress(Convergence convergence) : convergence_(convergence) {}

  /// Judges a correction.
  /// @param size its size   @param noise what rounding makes of the corrected unknowns, in the same unit
  /// @param total of all that has to be finite, the size among it: a sum, in which NaN and infinity do not get lost
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

  /// The next correction is not to be compared with those before: it has another unit, or one before was cut short.
  [[gnu::always_inline]] constexpr void restart() { is_anew_ = true; }
  [[gnu::always_inline]] constexpr void restart(Convergence convergence) {
    convergence_ = convergence;
    is_anew_ = true;
  }
  /// The last correction settled, but at a place where the terms of the step round by as much as the unknowns are
  /// large. As long as the terms become smaller, that is no solution.
  /// @return whether to go on in spite of it; the next correction is then judged anew
  [[gnu::always_inline]] constexpr bool goes_on_with(const Real& terms) {
    const bool go_on = hidden_ < 2 || terms < hiding_terms_ / 2;
    if (go_on) {
      ++hidden_;
      is_anew_ = true;
    }
    hiding_terms_ = terms;
    return go_on;
  }

  /// Corrections in a row that did not shrink.
  [[gnu::always_inline]] constexpr int stalls() const { return stalls_; }
  /// Whether the first correction was larger than the terms of the step: the guess lay far from the solution.
  /// @param noise of the last correction
  [[gnu::always_inline]] constexpr bool began_far_away(const Real& noise) const {
    return std::numeric_limits<Real>::epsilon() * first_ > noise;
  }

 private:
  /// Whether Newton has come to where the rounding of the residual hides what is left. A correction below the noise is
  /// noise itself. With a rate theta of decrease, quadratic convergence predicts theta^2 |correction| for the next one.
  /// What is left undone has the same sign at the same phase of every orbit and adds up linearly, rounding only as a
  /// square root: it has to lie so far below the noise that 10^8 steps (a walk of 10^4 noises) do not show it, hence
  /// 1/16384. Where the noise is larger than its estimate, corrections stop to shrink: two in a row that do not, below
  /// 4096 estimates, are noise too. Larger ones are a cycle of Newton's, which has no solution to end at.
  /// Without always_inline the compiler optimises this by itself first: fewer branches, 3 % of a step of cg on Kepler.
  static constexpr bool settles_quadratically(const Real& size, const Real& before, bool is_anew, const Real& noise,
                                              int& stalls) {
    const Real rate = !is_anew && before > Real(0) ? size / before : Real(1);
    stalls = !is_anew && rate > Real(0.9) ? stalls + 1 : 0;
    return size <= noise || (!is_anew && rate * rate * size <= noise / 16384) ||
           (rate > Real(0.5) && size <= 64 * noise) || (stalls >= 2 && size <= Real(1 << 12) * noise);
  }

  /// The same for corrections that shrink by a factor theta each time. After a correction c the corrections that were
  /// left out would add up to theta/(1 - theta) c, with the sign of c. So that they do not add up to a drift over many
  /// steps, this sum has to be below noise/16384, or corrections no longer shrink, as where an iteration repeats a
  /// cycle of a few roundings. [HairerMcLachlanRazakarivony2008]  Corrections above the noise count as such a cycle
  /// only after twelve in a row that are no smaller than the least so far: corrections that turn while they shrink are
  /// sometimes larger than the one before.
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
  bool is_anew_ = true;  // there is no correction before this one, or none in the same unit
  int stalls_ = 0;
  int hidden_ = 0;  // how often goes_on_with() went on
  Real first_ = Real(0);
  Real previous_ = Real(0);
  Real least_ = Real(0);  // of all corrections before this one
  Real hiding_terms_ = Real(0);
};

/// After a first guess that lay far away, steps begin from the last state until so many extrapolated guesses in a row
/// would have been good: as many as are extrapolated from.
inline constexpr int good_guesses_needed = 3;
/// How many are wanted after another one. @param wanted before it
constexpr int good_guesses_needed_after(int wanted, bool is_good) { return is_good ? wanted - 1 : good_guesses_needed; }

/// Whether what counts as rounding is no less than a millionth of the unknowns themselves: at a guess so far off that
/// forces round by more than the whole step, any correction looks small. At the solution of a step that does not begin
/// at rest it is 10^-12 of them, of one of h omega = 1000 10^-10.
/// @param unit what the largest of them rounds by   @param unknown the largest of them
template <class Real>
constexpr bool hidden_by_rounding(const Real& unit, const Real& unknown) {
  return unit > unknown / (1 << 20);
}
/// The same of numbers that lie `stride` apart, as those of one lane do.
inline bool hidden_by_rounding(const double* units, const double* unknowns, std::size_t count, std::size_t stride) {
  double unit = 0;
  double unknown = 0;
  for (std::size_t i = 0; i < count * stride; i += stride) {
    unit = larger(unit, units[i]);
    unknown = larger(unknown, std::abs(unknowns[i]));
  }
  return hidden_by_rounding(unit, unknown);
}

/// The size of one entry of a correction in units of what rounding makes of it. An entry at 0 so far, without noise of
/// its own, has its own rounding for a unit.
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
