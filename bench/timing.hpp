// Interleaved rounds. In each round every contender of every workload runs one block, in an order that rotates from
// round to round. Ratios are taken within a round, and their median over all rounds is reported. A change of the speed
// of the machine then affects both sides of a ratio.
#pragma once

#include "contender.hpp"

namespace bench {

struct Plan {
  int rounds = 21;
  double block_nanoseconds = 15e6;  // the intended time of a block
};

/// Median and quartiles.
struct Spread {
  double median = 0;
  double low = 0;   // first quartile
  double high = 0;  // third quartile
};

struct Result {
  std::string contender;
  std::string against;
  double goal = 0;
  Spread ns_per_step;
  Spread ns_per_force;
  Spread ratio;  // 0 if the contender is not compared
  double forces_per_step = 0;
  double difference = 0;  // maximum norm of the difference from the end state of the first contender
};

struct Table {
  std::string method;
  std::string h_text;
  std::int64_t steps = 0;  // steps of a block
  double bound = 0;        // the bound for differences of contenders that round differently
  Spread limit;            // ns per step, from the latencies along the chain
  std::vector<Result> results;
};

struct Compared {
  Comparison comparison;
  std::string h_text;
  Spread ratio;
  /// A goal is missed only if the first quartile misses it, too.
  bool met() const { return ratio.low <= comparison.goal; }
};

struct Measured {
  std::vector<Table> tables;
  std::vector<Compared> compared;  // comparisons whose two contenders were both measured
};

Spread spread_of(std::vector<double> values);

/// @throws std::runtime_error if contenders do not end in the same state
Measured measure(const std::vector<Workload>& workloads, const std::vector<Comparison>& comparisons, const Plan& plan);

}  // namespace bench
