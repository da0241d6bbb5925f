// Ensembles: one trajectory in each SIMD lane, timed per trajectory and step against the hand-written scalar loop. Lane
// 0 starts like the other contenders and must end in their state; the others start a little faster. The kernels are
// those of `hamflow sweep` but without the energy computed in every step, which the scalar loop does not have
// either; "lanes, watched" has it.
#include "hamflow/methods/compositions/stv4.hpp"
#include "hamflow/methods/compositions/verlet.hpp"
#include "hamflow/run/ensemble_of.hpp"
#include "library.hpp"

namespace bench {

namespace {

template <class R>
using Exact = hamflow::CentralForce<R, hamflow::Kepler>;
template <class R>
using Fast = hamflow::FastKernel<Exact<R>>;

template <template <class> class Family, class Set, bool watch>
Run run_lanes(const Task& task, const hamflow::CompositionTable& table, std::int64_t steps) {
  using Block = hamflow::EnsembleBlockOf<Family, Set, watch>;
  Block block(hamflow::sequence_of<double>(table, hamflow::StartsWith::kick), hamflow::detail::describe_kick_first,
              &table);
  std::vector<hamflow::MemberStart> members;
  for (std::size_t lane = 0; lane < block.lanes(); ++lane) {
    const double faster = 1 + 1e-3 * static_cast<double>(lane);
    members.push_back({{task.start.q[0], task.start.q[1]},
                       {task.start.p[0] * faster, task.start.p[1] * faster},
                       {task.k, task.mass},
                       task.h});
  }
  if (!block.load({{"k", 1}, {"mass", 1}}, members)) throw std::runtime_error("lanes refuse the members");
  Run run;
  run.nanoseconds = timed([&] { block.advance(steps); }) / static_cast<double>(block.lanes());
  const hamflow::MemberEnd end = block.look(0);
  run.end = {{end.q[0], end.q[1]}, {end.p[0], end.p[1]}};
  run.forces = static_cast<double>(table.stages() * steps);
  return run;
}

/// In the widest lanes of this machine.
template <template <class> class Family, bool watch>
Run run_widest(const Task& task, const hamflow::CompositionTable& table, std::int64_t steps) {
#if defined(__x86_64__) && defined(__GNUC__)
  if (hamflow::fast_kernel_available()) return run_lanes<Family, hamflow::Avx512Lanes, watch>(task, table, steps);
  if (__builtin_cpu_supports("avx2")) return run_lanes<Exact, hamflow::Avx2Lanes, watch>(task, table, steps);
#endif
  return run_lanes<Exact, hamflow::GenericLanes, watch>(task, table, steps);
}

}  // namespace

void add_lane_contenders(Workload& workload, const Task& task) {
  const bool is_stv4 = workload.method == "stv4";
  if (!is_stv4 && workload.method != "verlet") return;
  const hamflow::CompositionTable& table = is_stv4 ? hamflow::compositions::stv4 : hamflow::compositions::verlet;
  const bool wide = hamflow::fast_kernel_available();
  // The goals are for AVX-512, stated for stv4.
  const double exact_goal = is_stv4 && wide ? 1.0 / 8 : 0;
  const double fast_goal = is_stv4 && wide ? 1.0 / 15 : 0;
  workload.contenders.push_back(
      {"lanes", [=, &table](std::int64_t steps) { return run_widest<Exact, false>(task, table, steps); }, "hand",
       exact_goal});
  workload.contenders.push_back(
      {"lanes, watched", [=, &table](std::int64_t steps) { return run_widest<Exact, true>(task, table, steps); },
       "hand"});
  if (!wide) return;  // the fast kernel is the exact one there
  workload.contenders.push_back(
      {"lanes, fast", [=, &table](std::int64_t steps) { return run_widest<Fast, false>(task, table, steps); }, "hand",
       fast_goal, false});
  workload.contenders.push_back({"lanes, fast bits",
                                 [=, &table](std::int64_t steps) { return run_widest<Fast, true>(task, table, steps); },
                                 "typed, fast", 0, false, 1, "typed, fast"});
}

}  // namespace bench
