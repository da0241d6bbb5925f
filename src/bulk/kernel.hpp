// Data of the kernels of all instruction sets: plain memory, filled by workspace.cpp. There must be no inline function
// here, because the linker would keep one of several copies compiled for different instruction sets.
#pragma once

#include <cstddef>
#include <cstdint>

namespace hamflow::bulk {

/// Constants of the law in the length unit of the coordinates. phi is the potential of the unit law. The sums of a row
/// are multiplied by the missing factors at the end.
struct Law {
  double sigma_squared;  // lennard-jones: s = sigma^2/u, phi = s^3 (s^3 - a), c = s^4 (s^3 - a/2)
  double attraction;     // a
  double half_attraction;
  double softening_squared;  // newton: phi = -w/sqrt(u + softening^2), c = -w (u + softening^2)^(-3/2)
  double cut_squared;        // R^2 for the cut-off R
  double shift;              // phi(R); for force-shifted potentials phi(R) - R phi'(R)
  double slope;              // phi'(R)
  double slope_in_c;         // phi'(R) in units of c
  double inner_squared;      // smooth: x = (u - inner^2) inverse_width
  double inverse_width;
  double turn_in_c;  // the factor of phi s'(x) in units of c
};

/// Particles are stored in slots. With lists, slots are in the order of cells, else in the order of numbers.
struct Rows {
  const double* at = nullptr;  // with lists: x, y, z, w of each slot
  const double* x[3] = {};     // without lists: one array per coordinate, filled up to a multiple of eight
  const double* w = nullptr;
  std::size_t particles = 0;
  const std::uint32_t* number = nullptr;  // the number of the particle in each slot
  const unsigned char* plain = nullptr;   // for each slot, whether no neighbour is beyond an edge of the box
  double edge[3] = {};                    // edges of the periodic box; 0: not periodic
  double inverse_edge[3] = {};
  Law law{};
  double force_factor = 1;
  bool times_strength = false;  // with lists: whether the sums of a row are multiplied by its w
  double* force = nullptr;      // by particle
  double* energy = nullptr;     // by particle, for the unit law
};

/// Candidates of the rows first .. last - 1: slots in the order of particle numbers, filled up to a multiple of eight.
struct Candidates {
  const std::uint32_t* slots = nullptr;
  const std::uint32_t* begins = nullptr;  // where each row begins in `slots`
  const std::uint32_t* counts = nullptr;  // the number of candidates of each row
};

/// Scratch memory. With lists it belongs to a worker, and holds d_x, d_y, d_z, w of the neighbours in range for two
/// rows. Without lists it belongs to a block of rows, and holds the forces from the block, one array per coordinate.
struct Scratch {
  double* memory = nullptr;
  std::size_t row = 0;  // the length of each array
};

/// @return with lists, the number of neighbours in range
using SumRows = std::uint64_t (*)(const Rows&, std::size_t first, std::size_t last, const Candidates&, const Scratch&);

/// Particles in the order of their numbers. The arrays have space for eight more.
struct CandidateParticles {
  const double* x[3];
  const std::uint32_t* slots;
  std::size_t count;
  double edge[3];  // edges of the box if images are considered, else 0
  double inverse_edge[3];
  double radius_squared;
};
/// Finds the slots of the other particles within a distance of one. @param found has space for count + 8 numbers
/// @return the number of slots found
using FindNear = std::size_t (*)(const CandidateParticles&, std::size_t one, std::uint32_t* found);

struct Kernels {
  SumRows all[2][2][2];        // [law][space - 2][with energy]
  SumRows listed[2][3][2][2];  // [law][cutoff - 1][space - 2][with energy]
  FindNear near[2][2];         // [space - 2][with images]
};

extern const Kernels sse2;
extern const Kernels avx2;
extern const Kernels avx512;
/// Returns the kernels for the widest registers of this machine.
const Kernels& widest();

}  // namespace hamflow::bulk
