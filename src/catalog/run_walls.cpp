#include "run_walls.hpp"

#include "hamflow/run/recorded_walls.hpp"
#include "walled_functions.hpp"

namespace hamflow {

namespace {

/// Whether a bounce is p_i -> -p_i and nothing else: T quadratic with an M^-1 that is diagonal there.
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

/// Whether -p_i in place of p_i leaves H as it is to the last bit, which terms that are written otherwise than as
/// squares need not do; of some momenta.
bool keep_last_bits(const RunWalls<double>& walls, const Functions<double>& functions,
                    const Vector<double, dynamic>& q) {
  std::uint32_t any = 1;
  for (int n = 0; n < 16; ++n) {
    auto p = zeros_like(q);
    for (double& x : p) x = 0x1p-31 * static_cast<double>(any = any * 1664525u + 1013904223u) - 1;
    const double energy = functions.energy(q, p);
    for (const WallSide<double>& wall : walls.sides) {
      auto turned = p;
      turned[wall.coordinate] = -p[wall.coordinate];
      if (!(functions.energy(q, turned) == energy)) return false;
    }
  }
  return true;
}

}  // namespace

template <class R>
std::shared_ptr<const RunWalls<R>> put_behind_walls(ErasedRun<R>& run, const Request& request, const Walls& walls) {
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
  run.functions = functions_behind_walls(run.functions, request, walls, behind->sides);
  behind->functions = run.functions.plain;
  if constexpr (std::is_same_v<R, double>) {
    if (walls.hard()) {
      const bool few = run.functions.size <= 64;  // steps of more are too long to be recorded, or gain little
      const bool keep_energy =
          few && walls.rule == WallRule::reject && keep_last_bits(*behind, *run.functions.plain, run.q);
      run.walls = std::make_shared<const StepWalls>(StepWalls{behind->sides, walls.rule, keep_energy});
      behind->turns_single = (walls.rule == WallRule::reject || (few && walls.rule == WallRule::event)) &&
                             turn_single_momenta(*behind, run.functions);
      // Compensated positions are mirrored as sums of two numbers, forces of the first alone.
      behind->in_steps = (walls.rule == WallRule::reject && behind->turns_single) ||
                         (walls.rule == WallRule::mirror && request.arithmetic == "double");
    }
  }
  return behind;
}

#define HAMFLOW_RUN_WALLS(R) \
  template std::shared_ptr<const RunWalls<R>> put_behind_walls<R>(ErasedRun<R>&, const Request&, const Walls&);
HAMFLOW_RUN_WALLS(double)
HAMFLOW_RUN_WALLS(DoubleDouble)
HAMFLOW_RUN_WALLS(Quad)
HAMFLOW_RUN_WALLS(Mp)
#undef HAMFLOW_RUN_WALLS

}  // namespace hamflow
