// The program for the gas that [Sonnleitner2010], pages 72 to 75, lists. It shares no code with hamflow's gas, and like
// the listing it does not notice a particle beyond the wall.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace hamflow::reproduction {

class ListedGas {
 public:
  /// @param scale S, `SkalierFaktor` in the listing   @param q, p x and y of each particle
  /// @param power the power of the wall potential (page 80), 1 in the listing; the factor S^-4 of the listing is kept
  ListedGas(double scale, double dt, std::vector<double> q, std::vector<double> p, int power = 1);

  void step();
  void negate_momenta();
  /// Moves particles beyond the wall to the origin, and returns their number. Page 77: "border crossers set to 0,0 by
  /// hand".
  int put_crossers_at_the_origin();

  int outside() const;  // number of particles on the soft wall or beyond it, or at NaN
  double energy() const;
  double scale() const { return scale_; }
  const std::vector<double>& q() const { return q_; }
  const std::vector<double>& p() const { return p_; }

 private:
  void evaluate();

  double scale_, dt_;
  std::vector<double> q_, p_, force_;
  int power_;
};

/// The output of the listed program after a reversal: `steps` steps forward and as many back.
struct ListedReturn {
  double position = 0;  // sqrt(sum |difference|^2)/N, page 72
  double momentum = 0;
  std::int64_t first_outside = 0;  // the first forward step after which a particle is outside; 0: none
  int outside_at_turn = 0;
  int put_to_origin = 0;
  int nowhere = 0;          // particles at NaN at the end: the force between two at one place is NaN
  double energy_error = 0;  // after the forward steps, divided by |H| of the start
  std::vector<double> turn, end;
};
/// @param by_hand whether particles beyond the wall are moved to (0, 0) after each step
/// @param breathe called between steps; it throws to stop
ListedReturn listed_return(ListedGas gas, std::int64_t steps, bool by_hand, const std::function<void()>& breathe);

/// Returns the first step after which a particle is outside, or 0 if there is none within `steps` steps.
std::int64_t first_outside(ListedGas gas, std::int64_t steps, const std::function<void()>& breathe);

/// How a particle left the wall.
struct Passage {
  std::int64_t step = 0;  // the first step after which a particle is outside; 0: none
  /// Whether the step size was too long for two particles that met ("Durchdringung", page 80): one became more than
  /// twice as fast as any at the start, and had another within a length of the potential before that step. Such a
  /// particle crosses any wall, so it tells nothing about the wall.
  bool is_after_collision = false;
};
Passage passage(ListedGas gas, std::int64_t steps, const std::function<void()>& breathe);

}  // namespace hamflow::reproduction
