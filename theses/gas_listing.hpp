// The gas as [Sonnleitner2010], pages 72 to 75, lists it: a second implementation, which shares nothing with hamflow's,
// and does not notice a particle beyond the wall.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace hamflow::reproduction {

class ListedGas {
 public:
  /// @param scale S, `SkalierFaktor`   @param q, p x, y of each particle   @param power of the wall, page 80: 1 as
  /// listed; the listing's factor S^-4 stays
  ListedGas(double scale, double dt, std::vector<double> q, std::vector<double> p, int power = 1);

  void step();
  void negate_momenta();
  /// Page 77: "border crossers set to 0,0 by hand". Returns how many.
  int put_crossers_at_the_origin();

  int outside() const;  // particles on the soft wall or beyond it, or nowhere
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

/// What the listed program prints after `steps` steps there and as many back.
struct ListedReturn {
  double position = 0;  // sqrt(sum |difference|^2)/N, page 72
  double momentum = 0;
  std::int64_t first_outside = 0;  // the first step there after which a particle is outside; 0: none
  int outside_at_turn = 0;
  int put_to_origin = 0;
  int nowhere = 0;          // particles whose place is no number at the end: two at one place have no force
  double energy_error = 0;  // at the turn, of |H| of the start
  std::vector<double> turn, end;
};
/// @param by_hand border crossers are set to (0, 0) after each step   @param breathe called between steps
ListedReturn listed_return(ListedGas gas, std::int64_t steps, bool by_hand, const std::function<void()>& breathe);

/// The first step after which a particle is outside; 0 where none is in `steps` steps.
std::int64_t first_outside(ListedGas gas, std::int64_t steps, const std::function<void()>& breathe);

/// How a particle comes to be outside.
struct Passage {
  std::int64_t step = 0;  // the first after which one is; 0: none is
  /// The step was too long for two that met ("Durchdringung", page 80): a particle became more than twice as fast as
  /// any at the start, and the first that did had another within a length of the potential before the step. What it
  /// then does to a wall says nothing of the wall.
  bool is_after_collision = false;
};
Passage passage(ListedGas gas, std::int64_t steps, const std::function<void()>& breathe);

}  // namespace hamflow::reproduction
