// Recorded steps at hard walls (docs/design/walls.md). With rules that locate a bounce, the loop ends before a step
// that may hit a wall, so that the simulation can take it. With other rules, the step itself selects the state after
// the bounce, and counts it.
#pragma once

#include <utility>
#include <vector>

#include "carried.hpp"
#include "hamflow/core/derivatives.hpp"
#include "hamflow/run/walls.hpp"

namespace hamflow {

/// The hard walls of a recorded step.
struct StepWalls {
  std::vector<WallSide<double>> sides;
  WallRule rule = WallRule::event;
  bool keep_energy = false;  // whether a bounce changes no bit of H
};

/// The treatment of a recorded step that may hit a wall.
enum class AtWalls { stop, bounce };

/// One number (word) counts the bounces off up to `sides` sides, each in its own bits. A loop runs only for so many
/// steps that no count can overflow.
struct BounceWord {
  static constexpr std::size_t sides = 4;
  static constexpr std::int64_t base = std::int64_t{1} << 13;
  static constexpr std::int64_t most_steps = base - 1;
  /// Returns the increment of a word for a bounce off its k-th side.
  static double unit(std::size_t k) { return static_cast<double>(std::int64_t{1} << (13 * k)); }
  static std::int64_t count(double word, std::size_t k) {
    return (static_cast<std::int64_t>(word) >> (13 * k)) & (base - 1);
  }
  static std::size_t words(std::size_t sides_of_all) { return (sides_of_all + sides - 1) / sides; }
};

/// Returns the distance beyond a wall at the end of a step of length h from (q0, p0) to (q1, p1). With `and_turns` it
/// is also positive if the trajectory may have been beyond a wall within the step (WallSide::beyond_between), provided
/// that the coordinate turns at most once.
template <class P, class S>
S beyond_walls(const P& problem, const std::vector<WallSide<double>>& sides, bool and_turns, double h,
               const Vector<S, dynamic>& q0, const Vector<S, dynamic>& p0, const Vector<S, dynamic>& q1,
               const Vector<S, dynamic>& p1) {
  const auto two_steps = [&](const Vector<S, dynamic>& q, const Vector<S, dynamic>& p) {
    Vector<S, dynamic> far = zeros_like(p);
    if (!and_turns) return far;
    if constexpr (Separable<P> && requires { problem.scaled_velocity(2 * h, p, far); }) {
      if (problem.has_scaled_velocity()) {
        problem.scaled_velocity(2 * h, p, far);
        return far;
      }
    }
    if constexpr (Separable<P>) {
      velocity(problem, p, far);
    } else {
      Vector<S, dynamic> by_q = zeros_like(q);
      gradient(problem, q, p, by_q, far);
    }
    for (S& x : far) x = S(2 * h) * x;
    return far;
  };
  const Vector<S, dynamic> ahead = two_steps(q0, p0);
  const Vector<S, dynamic> behind = two_steps(q1, p1);
  S furthest(-1);
  for (const WallSide<double>& wall : sides) {
    const std::size_t i = wall.coordinate;
    furthest = larger(wall.beyond(q1[i]), furthest);
    if (and_turns) furthest = larger(wall.beyond_between(q0[i], ahead[i], q1[i], behind[i]), furthest);
  }
  return furthest;
}

namespace detail {
/// Replaces every number of the objects `to` by that of `from` if flag > 0.
template <class S, class Objects, class Others>
void choose_all(const S& flag, Objects& from, Others& to) {
  std::vector<S> numbers;
  for_each_carried(
      [&]<class T>(T& x) {
        if constexpr (std::is_same_v<T, S>) numbers.push_back(x);
      },
      from);
  std::size_t at = 0;
  for_each_carried(
      [&]<class T>(T& x) {
        if constexpr (std::is_same_v<T, S>) x = choose(flag, numbers[at++], x);
      },
      to);
}
}  // namespace detail

/// Applies the rule "reject" within a recorded step, see WalledSimulation. A rejected step replaces the state `z` and
/// the data of `method` by those before the step.
/// @param any set to a positive number if the step is rejected
/// @return the increments of the words that count bounces
template <class S, class State, class M>
std::vector<S> reject_within(const std::vector<WallSide<double>>& sides, State& before, M& method_before, State& z,
                             M& method, S& any) {
  using Axis = typename decltype(State::arithmetic)::Axis;
  const auto q1 = z.positions();
  std::vector<S> words(BounceWord::words(sides.size()), S(0));
  any = S(0);
  S met_here(0);  // a step meets at most one of the two walls of a coordinate
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const std::size_t i = sides[k].coordinate;
    const S beyond = sides[k].beyond(S(q1[i]));
    const S met = choose(beyond, S(BounceWord::unit(k % BounceWord::sides)), S(0));
    words[k / BounceWord::sides] = words[k / BounceWord::sides] + met;
    met_here = met_here + met;
    if (k + 1 < sides.size() && sides[k + 1].coordinate == i) continue;
    auto turned = before.p;  // if several coordinates meet walls, only the last momentum is reversed
    turned[i] = Axis::negated(turned[i]);
    detail::choose_all(met_here, turned, z.p);
    any = any + std::exchange(met_here, S(0));
  }
  detail::choose_all(any, before.q, z.q);
  detail::choose_all(any, method_before, method);
  return words;
}

/// Applies the rule "mirror" within a recorded step: a state beyond a wall and the data of the method are mirrored.
/// Each wall is applied at most once; the caller checks whether the state is inside afterwards.
template <class S, class State, class M>
std::vector<S> mirror_within(const std::vector<WallSide<double>>& sides, State& z, M& method) {
  using Axis = typename decltype(State::arithmetic)::Axis;
  std::vector<S> words(BounceWord::words(sides.size()), S(0));
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const std::size_t i = sides[k].coordinate;
    const S beyond = sides[k].beyond(S(z.positions()[i]));
    words[k / BounceWord::sides] += choose(beyond, S(BounceWord::unit(k % BounceWord::sides)), S(0));
    State turned = z;
    turned.q[i] = Axis::negated(turned.q[i]);
    turned.arithmetic.position.add(turned.q[i], S(2 * sides[k].at));
    turned.p[i] = Axis::negated(turned.p[i]);
    detail::choose_all(beyond, turned, z);
    M other = method;
    other.mirror_kept(i);
    detail::choose_all(beyond, other, method);
  }
  return words;
}

}  // namespace hamflow
