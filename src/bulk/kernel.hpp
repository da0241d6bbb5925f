// Data of the kernels of all instruction sets: plain memory, filled by workspace.cpp. There must be no inline function
// here, because the linker would keep one of several copies compiled for different instruction sets.
#pragma once

#include <cstddef>
#include <cstdint>

namespace hamflow::bulk {

/// Constants of the law in the lengths of the coordinates. phi is that of the unit law; a row's sums are multiplied by
/// what they lack at the end.
struct Law {
  double sigma_squared;  // lennard-jones: s = sigma^2/u, phi = s^3 (s^3 - a), c = s^4 (s^3 - a/2)
  double attraction;     // a
  double half_attraction;
  double softening_squared;  // newton: phi = -w/sqrt(u + softening^2), c = -w (u + softening^2)^(-3/2)
  double cut_squared;        // of the radius
  double shift;              // phi(R), or of force-shifted phi(R) - R phi'(R)
  double slope;              // phi'(R)
  double slope_in_c;         // phi'(R) in units of c
  double inner_squared;      // smooth: x = (u - inner^2) inverse_width
  double inverse_width;
  double turn_in_c;  // of phi s'(x) in units of c
};

/// Particles are stored in slots, in the order of cells; without lists in the order of their numbers.
struct Rows {
  const double* at = nullptr;  // with lists: x, y, z, w of each slot
  const double* x[3] = {};     // without: coordinate by coordinate, up to a multiple of eight
  const double* w = nullptr;
  std::size_t particles = 0;
  const std::uint32_t* number = nullptr;  // of the particle in a slot
  const unsigned char* plain = nullptr;   // of slots: no neighbour is beyond an edge of the box
  double edge[3] = {};                    // of the periodic box; 0: not periodic
  double inverse_edge[3] = {};
  Law law{};
  double force_factor = 1;
  bool times_strength = false;  // with lists the sums of a row by its w
  double* force = nullptr;      // by particle
  double* energy = nullptr;     // by particle, of the unit law
};

/// Candidates of the rows first .. last - 1: slots in the order of their particles' numbers, filled up to a multiple of
/// eight.
struct Candidates {
  const std::uint32_t* slots = nullptr;
  const std::uint32_t* begins = nullptr;  // of each row, in `slots`
  const std::uint32_t* counts = nullptr;  // of each row
};

/// With lists, of one worker: for two rows each d_x, d_y, d_z, w of those in range. Without, of one block of rows:
/// the forces that it adds, coordinate by coordinate.
struct Scratch {
  double* memory = nullptr;
  std::size_t row = 0;  // numbers of each of them
};

/// @return how many neighbours were in range, with lists
using SumRows = std::uint64_t (*)(const Rows&, std::size_t first, std::size_t last, const Candidates&, const Scratch&);

/// Some particles, in the order of their numbers, with room for eight more.
struct CandidateParticles {
  const double* x[3];
  const std::uint32_t* slots;
  std::size_t count;
  double edge[3];  // where images of them count too; else 0
  double inverse_edge[3];
  double radius_squared;
};
/// The slots of all but one within a distance of that one. @param found room for count + 8 @return their number
using FindNear = std::size_t (*)(const CandidateParticles&, std::size_t one, std::uint32_t* found);

struct Kernels {
  SumRows all[2][2][2];        // [law][space - 2][with energy]
  SumRows listed[2][3][2][2];  // [law][cutoff - 1][space - 2][with energy]
  FindNear near[2][2];         // [space - 2][with images]
};

extern const Kernels sse2;
extern const Kernels avx2;
extern const Kernels avx512;
/// The kernels with the widest registers of this machine.
const Kernels& widest();

}  // namespace hamflow::bulk
