// Forces and potential energy of all particles of a pair system in one call, with neighbour lists, registers and
// threads. The bits are a function of the positions alone. Of each particle's neighbours in range, in the
// order of particle numbers, the k-th is added to the (k mod 8)-th of eight partial sums, whatever the width of a
// register, and nothing is fused. They then depend neither on threads nor on the instruction set, nor on when lists
// were made.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "hamflow/core/vector.hpp"

namespace hamflow {

/// V = prefactor sum_{i<j} w_i w_j phi(S r_ij), S = length_scale. Lengths below are those of the potential, S r, but
/// for `edges`, which are those of the coordinates.
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
  std::array<double, 3> edges{};    // of the periodic box, whose middle is the origin; 0: not periodic
  double skin = 0.3;                // of neighbour lists; no bit depends on it
  bool rebuild_every_time = false;  // of neighbour lists, for tests
};

/// What the kernels are compiled for; `best` is the widest of them that this machine has.
enum class BulkSet : unsigned char { sse2, avx2, avx512, best };

/// The functions. Copies share lists, scratch memory and threads, and take turns; nothing large is copied. A call
/// allocates nothing once the first list is made, unless a later list needs more room.
class BulkForces {
 public:
  /// @throws Error where a number is out of its range, naming it, or the machine lacks the instruction set
  explicit BulkForces(const BulkPairSystem& system, BulkSet set = BulkSet::best);

  /// Whether this machine has the instructions of a set.
  static bool has(BulkSet set);

  /// f <- -dV/dq. @param q, f space x particles numbers, particle by particle
  void force(const double* q, double* f) const;
  /// The same, and V.
  double force_and_potential(const double* q, double* f) const;
  /// V; without a pass over pairs where q is that of a force that has computed it too, which those forces do after
  /// which it was asked for before.
  double potential(const double* q) const;

  /// The bits do not depend on it. @throws Error when the system starts no more threads
  void use_threads(std::size_t count) const;

  /// What has been done since the beginning.
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
