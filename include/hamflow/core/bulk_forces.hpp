// Forces and potential energy of all particles of a pair system in one call, with neighbour lists, registers and
// threads. The bits are a function of the positions alone: the neighbours of a particle in range are taken in the order
// of particle numbers, the k-th is added to the (k mod 8)-th of eight partial sums, whatever the width of a register,
// and no operations are fused. The bits therefore depend neither on threads, nor on the instruction set, nor on the
// time at which lists were made.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "hamflow/core/vector.hpp"

namespace hamflow {

/// V = prefactor sum_{i<j} w_i w_j phi(S r_ij), S = length_scale. Lengths below are in the units of the potential, S r;
/// `edges` are in the units of the coordinates.
struct BulkPairSystem {
  enum class Law : unsigned char {
    lennard_jones,  // phi = factor ((sigma/r)^12 - attraction (sigma/r)^6)
    newton          // phi = -factor/sqrt(r^2 + softening^2)
  };
  enum class Cutoff : unsigned char {
    none,
    shifted,        // phi - phi(R)
    force_shifted,  // phi - phi(R) - (r - R) phi'(R)
    smooth          // phi s(x), x = (r^2 - inner^2)/(R^2 - inner^2), s = 1 up to x = 0, and then 0 at 1, of class C^4:
                    // 1 - x^5 (126 - 420 x + 540 x^2 - 315 x^3 + 70 x^4)
  };
  std::size_t space = 2;  // 2 or 3
  std::size_t particles = 0;
  Law law = Law::lennard_jones;
  double prefactor = 1;
  double length_scale = 1;
  double factor = 1;
  double sigma = 1;
  double attraction = 2;
  double softening = 0;
  std::vector<double> strengths{};  // w of each particle; empty: 1
  Cutoff cutoff = Cutoff::none;
  double radius = 0;                // R
  double inner = 0;                 // of smooth
  std::array<double, 3> edges{};    // of the periodic box, centred at the origin; 0: not periodic
  double skin = 0.3;                // of neighbour lists; does not change a bit
  bool rebuild_every_time = false;  // makes neighbour lists for every call, for tests
};

/// Instruction sets that the kernels are compiled for; `best` is the widest that this machine has.
enum class BulkSet : unsigned char { sse2, avx2, avx512, best };

/// Forces and potential of a BulkPairSystem. Copies share lists, scratch memory and threads and take turns, so that
/// copying is cheap. After the first list is made, a call allocates only if a later list needs more room.
class BulkForces {
 public:
  /// @throws Error if a number is out of its range (the message names it) or the machine lacks the instruction set
  explicit BulkForces(const BulkPairSystem& system, BulkSet set = BulkSet::best);

  /// Whether this machine has the instructions of a set.
  static bool has(BulkSet set);

  /// f <- -dV/dq. @param q, f space x particles numbers, particle by particle
  void force(const double* q, double* f) const;
  /// Computes forces as force(), and returns V.
  double force_and_potential(const double* q, double* f) const;
  /// V. If the last force was evaluated at the same q and has computed V too, there is no pass over pairs. Forces
  /// compute V once potential() has been called after a force.
  double potential(const double* q) const;

  /// The bits do not depend on the count. @throws Error if the system cannot start so many threads
  void use_threads(std::size_t count) const;

  /// Work since construction.
  struct Counts {
    std::uint64_t evaluations = 0;  // passes over the pairs
    std::uint64_t lists = 0;        // made
    std::uint64_t pairs = 0;        // in range, each counted once
  };
  Counts counts() const;
  BulkSet set() const;

 private:
  class Workspace;
  std::shared_ptr<Workspace> workspace_;
};

}  // namespace hamflow
