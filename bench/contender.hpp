// Workloads (a method and a step size on one Kepler orbit) and the contenders that run them.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "hamflow/core/vector.hpp"
#include "latency.hpp"

namespace bench {

/// A state (q, p) in the plane.
struct Orbit {
  hamflow::Vector<double, 2> q{};
  hamflow::Vector<double, 2> p{};
  friend bool operator==(const Orbit&, const Orbit&) = default;
};

/// The problem: H = |p|^2/(2 mass) - k/|q|, from pericentre 1 to apocentre 3.
struct Task {
  double mass = 2;
  double k = 1;
  Orbit start{};
  double h = 0;
  std::string h_text;  // the step size as text, for scenarios
};
Task kepler_task(const std::string& h_text);
/// The Kepler orbit with r = 0.4 .. 1.6 (e = 0.6, a = 1), mass = k = 1 and period 2 pi.
Task unit_task(double h);

/// One timed block of steps from the start of the task.
struct Run {
  double nanoseconds = 0;
  Orbit end;
  double forces = 0;  // evaluations of -dV/dq
};

struct Contender {
  std::string name;
  std::function<Run(std::int64_t steps)> run;
  std::string against;    // ratios divide by the time of this contender; empty: no ratio
  double goal = 0;        // the largest ratio that is allowed; 0: no goal
  bool same_bits = true;  // whether the end state has to equal that of the first contender; else bound and slack apply
  double slack = 1;       // multiplies the bound
  std::string bits_of{};  // another contender whose end state has to have the same bits; empty: none
};

/// Runs a method of another library, or of hamflow by type, on any task for any number of steps.
using Runner = std::function<Run(const Task&, std::int64_t steps)>;

/// The contenders for one method and step size. The first one is the hand-written loop.
struct Workload {
  std::string method;
  std::string h_text;
  Chain chain;  // the longest chain of one step of the hand-written loop
  std::vector<Contender> contenders;
  /// The largest allowed distance of end states after `steps` steps, if contenders round differently.
  std::function<double(std::int64_t steps)> bound;
};

/// The ratio of two contenders of different workloads, or of a contender and another library, with a goal.
struct Comparison {
  std::string method, contender;
  std::string peer_method, peer;
  bool per_force = false;  // whether times are per force evaluation, else per step
  double goal = 1;
};

std::vector<Workload> explicit_workloads(const Task& task);
std::vector<Workload> element_workloads(const Task& task);
/// The composition of order 8 with 17 stages, on this orbit and in the Henon-Heiles potential.
std::vector<Workload> order_eight_workloads(const Task& task);
/// N bodies, with N known at run time. They have their own tasks.
std::vector<Workload> body_workloads();
/// The T-tube: masses on crossed rails between walls.
std::vector<Workload> tube_workloads();
/// Adds contenders with compensated sums, for stv4 and kahan-li8. Call this after the plain contenders were added.
void add_compensated_contenders(Workload& workload, const Task& task);
void add_lane_contenders(Workload& workload, const Task& task);

}  // namespace bench
