// Interleaved rounds: in each round every contender of every workload runs one block, in an order that rotates from
// round to round. A ratio is taken within a round and the median over the rounds, so that a machine that changes its
// speed changes both sides.
#pragma once

#include "contender.hpp"

namespace bench {

struct Plan {
  int rounds = 21;
  double block_nanoseconds = 15e6;  // what a block is to take
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
  Spread ratio;  // all 0 without an opponent
  double forces_per_step = 0;
  double difference = 0;  // of the end state from that of the first contender, in the maximum norm
};

struct Table {
  std::string method;
  std::string h_text;
  std::int64_t steps = 0;  // in a block
  double bound = 0;        // of the differences that are not exact
  Spread limit;            // ns per step by latencies along the chain
  std::vector<Result> results;
};

struct Compared {
  Comparison comparison;
  std::string h_text;
  Spread ratio;
  /// Missed only beyond the spread: by the first quartile too.
  bool met() const { return ratio.low <= comparison.goal; }
};

struct Measured {
  std::vector<Table> tables;
  std::vector<Compared> compared;  // those whose two contenders both took part
};

Spread spread_of(std::vector<double> values);

/// @throws std::runtime_error when contenders do not end in the same state
Measured measure(const std::vector<Workload>& workloads, const std::vector<Comparison>& comparisons, const Plan& plan);

}  // namespace bench
