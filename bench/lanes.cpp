// Ensembles, by name as `hamflow sweep` runs them, with one trajectory in each SIMD lane. The time per trajectory and
// step is compared with the hand-written scalar loop. Lane 0 starts like the other contenders and has to end in their
// state; the other lanes have faster starts and other masses. "watched" computes the energy in every step, as sweeps
// do.
#include "hamflow/run/ensemble.hpp"
#include "library.hpp"

namespace bench {

namespace {

Run run_lanes(const Task& task, const std::string& method, hamflow::LaneSet set, bool watch, std::int64_t steps) {
  hamflow::Request request = kepler_request(task, "double");
  request.method = hamflow::parse_method(method);
  request.watch = watch;
  const auto block = hamflow::make_ensemble_block(request, set);
  std::vector<hamflow::MemberStart> members;
  for (std::size_t lane = 0; lane < (set == hamflow::LaneSet::avx512 ? 32 : 16); ++lane) {
    const double faster = 1 + 1e-3 * static_cast<double>(lane);
    members.push_back({{task.start.q[0], task.start.q[1]},
                       {task.start.p[0] * faster, task.start.p[1] * faster},
                       {task.k, task.mass * faster},
                       task.h});
  }
  if (!block || !block->load({{"k", 1}, {"mass", 1}}, members) || block->lanes() != members.size()) {
    throw std::runtime_error("lanes refuse the members");
  }
  block->advance(1);  // the first step is not recorded; a sweep has so many steps that it does not matter
  Run run;
  run.nanoseconds = timed([&] { block->advance(steps - 1); }) / static_cast<double>(members.size());
  const hamflow::MemberEnd end = block->look(0);
  run.end = {{end.q[0], end.q[1]}, {end.p[0], end.p[1]}};
  run.forces = static_cast<double>(hamflow::describe(request.method).forces_per_step) * static_cast<double>(steps);
  return run;
}

}  // namespace

void add_lane_contenders(Workload& workload, const Task& task) {
  using hamflow::LaneSet;
  const bool is_stv4 = workload.method == "stv4";
  const LaneSet widest = hamflow::widest_lanes();
  if ((!is_stv4 && workload.method != "verlet" && workload.method != "kahan-li8") || widest < LaneSet::avx2) return;
  const auto put = [&](const std::string& text, LaneSet set, bool watch, double goal) {
    workload.contenders.push_back(
        {text, [=, method = workload.method](std::int64_t steps) { return run_lanes(task, method, set, watch, steps); },
         "hand", goal, true});
  };
  put("lanes, avx2", LaneSet::avx2, false, 0);
  if (widest < LaneSet::avx512) return;
  // The goal is for stv4 with AVX-512.
  put("lanes", widest, false, is_stv4 ? 1.0 / 8 : 0);
  put("lanes, watched", widest, true, 0);
}

}  // namespace bench
