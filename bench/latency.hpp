// The limit of a loop whose every step needs the result of the one before: the latencies along the longest chain of
// dependent operations, counted by hand, times the latencies of this machine, measured.
#pragma once

namespace bench {

/// Operations that follow one another on the longest chain of one step.
struct Chain {
  int additions = 0;  // and subtractions
  int multiplications = 0;
  int divisions = 0;
  int square_roots = 0;
};

/// Nanoseconds from operands to result, in double.
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
