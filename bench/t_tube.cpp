// The T-tube, two masses on crossed rails between walls, with stv4 from the start of Sim-0.6III of the second thesis.
// The hand-written loop has the rule "reject", keeps the kick of the old position, and tests all walls in one well
// predicted branch. Times of lanes are per tube. The first lane starts like the other contenders and has to end in
// their state.
#include "hamflow/run/ensemble.hpp"
#include "hamflow/run/walls.hpp"
#include "plane.hpp"
#ifdef __x86_64__
#include <immintrin.h>
#endif

namespace bench {

namespace {

constexpr double mass_1 = 1, mass_2 = 100, eps = -0.6;
constexpr double wall_1[] = {-1, 1}, wall_2[] = {0.1, 2.1};
const Orbit tube_start{{0.01, 1.1}, {6, 100}};

/// The state of the hand-written loop.
struct Tube {
  double x, y, px, py;
  double kick_x = 0, kick_y = 0;
};
inline Tube load_tube(const Orbit& z) { return {z.q[0], z.q[1], z.p[0], z.p[1]}; }

struct TubeFactors {
  explicit TubeFactors(double h) {
    constexpr double g1 = stv4_weights[0], g2 = stv4_weights[1];
    const double c[] = {h * (g1 / 2), h * ((g1 + g2) / 2)};
    const double d[] = {h * g1, h * g2};
    for (int i = 0; i < 2; ++i) {
      strength[i] = -c[i] * eps;
      drift_1[i] = d[i] / mass_1;
      drift_2[i] = d[i] / mass_2;
    }
  }
  double strength[2], drift_1[2], drift_2[2];
};

/// This is a macro, because a function for one instruction set cannot be inlined into a template for all.
#define BENCH_TUBE_LOOP(find)                               \
  Tube s = load_tube(z);                                    \
  const TubeFactors f(h);                                   \
  find(s, f.strength[0]);                                   \
  for (std::int64_t i = 0; i < steps; ++i) {                \
    const Tube old = s;                                     \
    s.px += s.kick_x;                                       \
    s.py += s.kick_y;                                       \
    for (int j = 0; j < 3; ++j) {                           \
      const int k = j == 1 ? 1 : 0;                         \
      s.x += f.drift_1[k] * s.px;                           \
      s.y += f.drift_2[k] * s.py;                           \
      find(s, f.strength[j == 2 ? 0 : 1]);                  \
      s.px += s.kick_x;                                     \
      s.py += s.kick_y;                                     \
    }                                                       \
    const bool first = s.x < wall_1[0] || wall_1[1] < s.x;  \
    const bool second = s.y < wall_2[0] || wall_2[1] < s.y; \
    if (first || second) [[unlikely]] {                     \
      s = old;                                              \
      (second ? s.py : s.px) = -(second ? s.py : s.px);     \
    }                                                       \
  }                                                         \
  z = {{s.x, s.y}, {s.px, s.py}};

inline void find_tube_kick(Tube& s, double strength) {
  const double u = s.x * s.x + s.y * s.y;
  const double pull = strength / (u * std::sqrt(u));
  s.kick_x = pull * s.x;
  s.kick_y = pull * s.y;
}
[[gnu::noinline]] void hand_reject(Orbit& z, double h, std::int64_t steps){BENCH_TUBE_LOOP(find_tube_kick)}

Run run_tube_by_hand(void (*loop)(Orbit&, double, std::int64_t), double h, std::int64_t steps) {
  Run run;
  run.end = tube_start;
  run.nanoseconds = timed([&] { loop(run.end, h, steps); });
  run.forces = 3 * static_cast<double>(steps);
  return run;
}

hamflow::Request tube_request(hamflow::WallRule rule, const std::string& h_text, bool watch) {
  hamflow::Request request;
  request.problem = "t-tube";
  request.parameters = {{"masses", "[1, 100]"}, {"eps", "-0.6"}};
  request.start.q = {"0.01", "1.1"};
  request.start.p = {"6", "100"};
  request.method = hamflow::parse_method("stv4");
  request.dt = h_text;
  request.watch = watch;
  hamflow::Walls walls;
  walls.intervals = {{"q1", 0, "-1", "1"}, {"q2", 1, "0.1", "2.1"}};
  walls.rule = rule;
  request.walls = walls;
  return request;
}

Run run_tubes(const hamflow::Request& request, hamflow::LaneSet set, double h, std::int64_t steps) {
  const auto block = hamflow::make_ensemble_block(request, set);
  std::vector<hamflow::MemberStart> members;
  for (std::size_t lane = 0; lane < (set == hamflow::LaneSet::avx512 ? 32 : 16); ++lane) {
    const double faster = 1 + 1e-3 * static_cast<double>(lane);
    members.push_back({{tube_start.q[0], tube_start.q[1]},
                       {tube_start.p[0] * faster, tube_start.p[1] * faster},
                       {mass_1, mass_2, eps},
                       h});
  }
  if (!block || !block->load({{"masses", 2}, {"eps", 1}}, members) || block->lanes() != members.size()) {
    throw std::runtime_error("lanes refuse the tubes");
  }
  block->advance(1);
  Run run;
  run.nanoseconds = timed([&] { block->advance(steps - 1); }) / static_cast<double>(members.size());
  const hamflow::MemberEnd end = block->look(0);
  run.end = {{end.q[0], end.q[1]}, {end.p[0], end.p[1]}};
  run.forces = 3 * static_cast<double>(steps);
  return run;
}

Workload tube_workload(const std::string& h_text) {
  using hamflow::LaneSet;
  using hamflow::WallRule;
  const double h = std::stod(h_text);
  Workload w{"t-tube", h_text, {}, {}, {}};
  w.bound = [](std::int64_t) {
    return std::numeric_limits<double>::infinity();
  };  // other rules give other trajectories
  const auto by_hand = [&](const std::string& name, auto loop, const std::string& against, bool same) {
    w.contenders.push_back(
        {name, [=](std::int64_t steps) { return run_tube_by_hand(loop, h, steps); }, against, 0, same});
  };
  const auto named = [&](const std::string& name, WallRule rule, const std::string& against, double goal,
                         const std::string& bits_of) {
    const hamflow::Request request = tube_request(rule, h_text, false);
    // Partial steps are recorded after some 70 bounces, within the first 40000 steps.
    w.contenders.push_back({name, [=](std::int64_t steps) { return run_recorded(request, steps, 40000); }, against,
                            goal, bits_of == "hand", 1, bits_of == "hand" ? "" : bits_of});
  };
  const auto lanes = [&](const std::string& name, WallRule rule, LaneSet set, bool watch, const std::string& against,
                         double goal, const std::string& bits_of) {
    const hamflow::Request request = tube_request(rule, h_text, watch);
    w.contenders.push_back({name, [=](std::int64_t steps) { return run_tubes(request, set, h, steps); }, against, goal,
                            bits_of == "hand", 1, bits_of == "hand" ? "" : bits_of});
  };
  by_hand("hand", hand_reject, "", true);
  named("reject", WallRule::reject, "hand", 1.05, "hand");
  named("mirror", WallRule::mirror, "reject", 0, "");
  named("event", WallRule::event, "reject", h < 0.005 ? 1.1 : 0, "");
  const LaneSet widest = hamflow::widest_lanes();
  if (widest < LaneSet::avx2) return w;
  lanes("lanes, avx2", WallRule::reject, LaneSet::avx2, false, "hand", 1.0 / 6, "hand");
  lanes("lanes, avx2 watched", WallRule::reject, LaneSet::avx2, true, "lanes, avx2", 1.2, "hand");
  lanes("lanes, avx2 mirror", WallRule::mirror, LaneSet::avx2, false, "hand", 0, "mirror");
  lanes("lanes, avx2 event", WallRule::event, LaneSet::avx2, false, "hand", 0, "event");
  if (widest < LaneSet::avx512) return w;
  lanes("lanes", WallRule::reject, widest, false, "hand", 1.0 / 8, "hand");
  lanes("lanes, watched", WallRule::reject, widest, true, "lanes", 1.2, "hand");
  lanes("lanes, mirror", WallRule::mirror, widest, false, "hand", 0, "mirror");
  lanes("lanes, event", WallRule::event, widest, false, "hand", 0, "event");
  return w;
}

}  // namespace

std::vector<Workload> tube_workloads() { return {tube_workload("0.001"), tube_workload("0.01")}; }

}  // namespace bench
