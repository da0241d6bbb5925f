#include "run_walls.hpp"

#include <algorithm>
#include <cmath>

#include "engine/recorded_walls.hpp"
#include "walled_functions.hpp"

namespace hamflow {

namespace {

/// Whether a bounce is only p_i -> -p_i: T is quadratic and row i of M^-1 is diagonal.
template <class R>
bool turn_single_momenta(const RunWalls<R>& walls, const ErasedFunctions<R>& functions) {
  if (!includes(functions.capability, Capability::separable | Capability::quadratic_kinetic)) return false;
  for (const WallSide<R>& wall : walls.sides) {
    for (std::size_t j = 0; j < functions.size; ++j) {
      auto p = zeros<R, dynamic>(functions.size);
      auto v = p;
      p[j] = R(1);
      functions.plain->velocity(p, v);
      if (j != wall.coordinate && v[wall.coordinate] != R(0)) return false;
    }
  }
  return true;
}

/// The effect on a result, to the last bit, if one input changes its sign: unchanged, sign changed, or unknown.
enum class Sign { stays, turns, unknown };

Sign product_of(Sign a, Sign b) {
  if (a == Sign::unknown || b == Sign::unknown) return Sign::unknown;
  return a == b ? Sign::stays : Sign::turns;
}

/// IEEE arithmetic rounds x and -x symmetrically, and so do the odd functions of the library.
Sign sign_of(const TapeNode& node, const std::vector<double>& constants, const std::vector<Sign>& all) {
  const auto at = [&](int i) { return i < 0 ? Sign::unknown : all[static_cast<std::size_t>(i)]; };
  const auto of_even_function = [&] { return at(node.a) == Sign::unknown ? Sign::unknown : Sign::stays; };
  const auto of_other_function = [&] { return at(node.a) == Sign::stays ? Sign::stays : Sign::unknown; };
  switch (node.operation) {
    case Operation::number:
      return Sign::stays;
    case Operation::add:
    case Operation::subtract:
      return at(node.a) == at(node.b) ? at(node.a) : Sign::unknown;
    case Operation::multiply:
    case Operation::divide:
      return product_of(at(node.a), at(node.b));
    case Operation::negate:
    case Operation::scale:
    case Operation::divide_constant:
    case Operation::invert:
      return at(node.a);
    case Operation::square:
      return of_even_function();
    case Operation::power_constant: {
      const double exponent = constants[static_cast<std::size_t>(node.constant)];
      if (at(node.a) != Sign::turns) return at(node.a);
      if (std::fmod(exponent, 2) == 0) return Sign::stays;
      return std::fmod(exponent, 1) == 0 ? Sign::turns : Sign::unknown;
    }
    case Operation::larger:
    case Operation::atan2:
    case Operation::power:
    case Operation::choose: {
      const bool third = node.operation != Operation::choose || at(node.c) == Sign::stays;
      return third && at(node.a) == Sign::stays && at(node.b) == Sign::stays ? Sign::stays : Sign::unknown;
    }
    default:
      switch (symmetry_of(node.operation)) {
        case Symmetry::odd:
          return at(node.a);
        case Symmetry::even:
          return of_even_function();
        case Symmetry::neither:
          return of_other_function();
      }
      return Sign::unknown;
  }
}

/// Whether replacing p_i by -p_i changes no bit of H for any q and p, decided from the recording of H. Terms that are
/// not written as squares may change bits.
bool keep_last_bits(const RunWalls<double>& walls, const Functions<Trace<double>>& functions,
                    const Vector<double, dynamic>& q, const Vector<double, dynamic>& p) {
  Recorder<double> recorder(Folding::exact);
  Vector<Trace<double>, dynamic> x(q.size());
  Vector<Trace<double>, dynamic> y(p.size());
  for (std::size_t i = 0; i < q.size(); ++i) x[i] = recorder.input(q[i]);
  for (std::size_t i = 0; i < p.size(); ++i) y[i] = recorder.input(p[i]);
  Tape<double> tape;
  try {
    tape = recorder.finish({functions.energy(x, y)});
  } catch (const CannotRecord&) {
    return false;
  }
  return std::all_of(walls.sides.begin(), walls.sides.end(), [&](const WallSide<double>& wall) {
    std::vector<Sign> all(tape.nodes.size(), Sign::unknown);
    for (std::size_t i = 0; i < tape.nodes.size(); ++i) {
      const bool is_input = i < tape.inputs;
      all[i] = is_input ? (i == q.size() + wall.coordinate ? Sign::turns : Sign::stays)
                        : sign_of(tape.nodes[i], tape.constants, all);
    }
    const auto stays = [&](int node) { return all[static_cast<std::size_t>(node)] == Sign::stays; };
    return stays(tape.outputs.front()) &&
           std::all_of(tape.guards.begin(), tape.guards.end(), [&](const auto& guard) { return stays(guard.node); });
  });
}

}  // namespace

template <class R>
std::shared_ptr<const RunWalls<R>> add_walls_to_run(ErasedRun<R>& run, const Request& request, const Walls& walls) {
  auto behind = std::make_shared<RunWalls<R>>();
  behind->rule = walls.rule;
  if (walls.hard()) behind->sides = wall_sides<R>(walls);
  if constexpr (std::is_same_v<R, double>) {
    if (request.arithmetic == "lattice" && walls.rule == WallRule::mirror) {
      for (auto& side : behind->sides) side.at = on_half_lattice(side.at, request.position_unit);
    }
  }
  for (const auto& interval : walls.intervals) {
    if (!interval.min.empty() || !walls.hard()) behind->names.push_back(interval.coordinate);
    if (!interval.max.empty() && walls.hard()) behind->names.push_back(interval.coordinate);
  }
  run.functions = functions_with_walls(run.functions, request, walls, behind->sides);
  behind->functions = run.functions.plain;
  if constexpr (std::is_same_v<R, double>) {
    if (walls.hard()) {
      const bool few = run.functions.size <= 64;  // longer steps are not recorded, or gain little
      const bool keep_energy =
          few && walls.rule == WallRule::reject && keep_last_bits(*behind, *run.functions.trace, run.q, run.p);
      run.walls = std::make_shared<const StepWalls>(StepWalls{behind->sides, walls.rule, keep_energy});
      behind->turns_single = (walls.rule == WallRule::reject || (few && walls.rule == WallRule::event)) &&
                             turn_single_momenta(*behind, run.functions);
      // Compensated positions are mirrored as sums of two numbers, but forces see only the first.
      behind->in_steps = (walls.rule == WallRule::reject && behind->turns_single) ||
                         (walls.rule == WallRule::mirror && request.arithmetic == "double");
    }
  }
  return behind;
}

#define HAMFLOW_RUN_WALLS(R) \
  template std::shared_ptr<const RunWalls<R>> add_walls_to_run<R>(ErasedRun<R>&, const Request&, const Walls&);
HAMFLOW_RUN_WALLS(double)
HAMFLOW_RUN_WALLS(DoubleDouble)
HAMFLOW_RUN_WALLS(Quad)
HAMFLOW_RUN_WALLS(Mp)
#undef HAMFLOW_RUN_WALLS

}  // namespace hamflow
