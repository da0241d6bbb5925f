// Bit-exact reversal: a Kepler orbit forward, momenta negated, forward again, momenta negated.
// usage: example_exact_return [STEPS], default 10^6 each way
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "hamflow/hamflow.hpp"

static void print_bits(const char* when, const std::vector<std::byte>& bits) {
  std::uint64_t word[4];  // q1, q2, p1, p2 in lattice units
  std::memcpy(word, bits.data(), sizeof word);
  std::printf("%-8s %016llx %016llx %016llx %016llx\n", when, (unsigned long long)word[0], (unsigned long long)word[1],
              (unsigned long long)word[2], (unsigned long long)word[3]);
}

int main(int argc, char** argv) {
  const long long steps = argc > 1 ? std::atoll(argv[1]) : 1'000'000;
  const hamflow::CentralForce<double, hamflow::Kepler> kepler(2.0, hamflow::Kepler<double>(1.0));
  auto orbit = hamflow::simulate(kepler, hamflow::Composition<hamflow::compositions::stv4>{}, {1.0, 0.0},
                                 {0.0, std::sqrt(3.0)}, 0.1, hamflow::Lattice{});
  const auto before = orbit.bits();
  print_bits("before", before);
  for (const char* when : {"there", "back"}) {
    if (orbit.advance(steps) != hamflow::Outcome::done) return 1;
    orbit.negate_momenta();
    print_bits(when, orbit.bits());
  }
  const bool same = orbit.bits() == before;
  std::printf("%lld steps there and %lld back: %s\n", steps, steps, same ? "every bit as before" : "NOT the same");
  return same ? 0 : 1;
}
