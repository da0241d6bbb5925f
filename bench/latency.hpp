// The lower limit for the time of a loop in which every step needs the result of the one before. It is the sum of the
// latencies along the longest chain of dependent operations. The operations are counted by hand, the latencies
// measured.
#pragma once

namespace bench {

/// The operations on the longest chain of one step.
struct Chain {
  int additions = 0;  // and subtractions
  int multiplications = 0;
  int divisions = 0;
  int square_roots = 0;
};

/// Latencies in nanoseconds, in double.
struct Latencies {
  double addition = 0;
  double multiplication = 0;
  double division = 0;
  double square_root = 0;

  double of(const Chain& chain) const {
    return chain.additions * addition + chain.multiplications * multiplication + chain.divisions * division +
           chain.square_roots * square_root;
  }
};

Latencies measure_latencies();

}  // namespace bench
