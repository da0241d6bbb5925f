// What is compared: a workload (method and step length on one Kepler orbit) and the contenders that run it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "hamflow/core/vector.hpp"
#include "latency.hpp"

namespace bench {

/// (q, p) in the plane.
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
  std::string h_text;  // the same step length as a scenario gives it
};
Task kepler_task(const std::string& h_text);
/// The same with r = 0.4 .. 1.6 (e = 0.6, a = 1), unit mass and k, period 2 pi.
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
  std::string against;    // the contender whose time divides this one's; empty: none
  double goal = 0;        // the ratio wanted; 0: none, for information
  bool same_bits = true;  // the end state has the bits of the first contender's; else it lies within the bound
  double slack = 1;       // times the bound
  std::string bits_of{};  // beside that: it ends in the bits of this contender
};

/// A method of another library, or of hamflow by type: any task, any number of steps.
using Runner = std::function<Run(const Task&, std::int64_t steps)>;

/// Contenders of one method at one step length; the first is the hand-written loop.
struct Workload {
  std::string method;
  std::string h_text;
  Chain chain;  // of one step of the hand-written loop
  std::vector<Contender> contenders;
  /// How far two end states of contenders without the same arithmetic may lie apart after so many steps.
  std::function<double(std::int64_t steps)> bound;
};

/// A ratio of two contenders of different workloads, or against a peer, with the goal that it be at most so large.
struct Comparison {
  std::string method, contender;
  std::string peer_method, peer;
  bool per_force = false;  // else per step
  double goal = 1;
};

std::vector<Workload> explicit_workloads(const Task& task);
std::vector<Workload> element_workloads(const Task& task);
/// The method of order 8 with 17 stages, on this orbit and in the Henon-Heiles potential.
std::vector<Workload> order_eight_workloads(const Task& task);
/// N bodies of run-time size; of a task of their own.
std::vector<Workload> body_workloads();
/// Masses on crossed rails between walls.
std::vector<Workload> tube_workloads();
/// For stv4 and kahan-li8, after the plain contenders.
void add_compensated_contenders(Workload& workload, const Task& task);
void add_lane_contenders(Workload& workload, const Task& task);

}  // namespace bench
