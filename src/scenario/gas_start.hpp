// Where the particles of a gas begin, as texts that every arithmetic reads with its own digits.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace hamflow {

struct GasStart {
  std::vector<std::string> q;  // particle by particle
  std::vector<std::string> p;
  std::vector<std::string> masses;   // of a file that has them, one for all where they are equal; else empty
  std::vector<std::size_t> lines{};  // of a CSV, from 1, in which each particle stands
};

/// n particles on each side of a lattice, the first coordinate changing fastest: of the square, or cube, [-1, 1]^space
/// with particles on its sides, or of a box of the given edges, each particle in the middle of its cell. Momenta are
/// uniform in [-1, 1), multiples of 2e-5 [Sonnleitner2010, ch. 3a]: the k-th of them is 2e-5 floor(1e5 u_k) - 1, u_k in
/// [0, 1) the upper 53 bits of counter_bits(seed, k), k = 0, 1, ... in the order of p.
/// @param n at least 2   @param space 2 or 3   @param edges none, or one a coordinate, numbers as text
GasStart gas_on_lattice(std::int64_t n, std::size_t space, std::uint64_t seed,
                        const std::vector<std::string>& edges = {});
/// The same on [0, 1]^space, at rest.
GasStart gas_in_corner(std::int64_t n, std::size_t space);
/// A CSV whose first row names x, y(, z), p_x, p_y(, p_z)(, mass), in any order; a row a particle.
/// @throws Error with the line and column, what was found and what is allowed
GasStart gas_from_file(const std::filesystem::path& file, std::size_t space);

/// A state of the particles in a run.h5, in double, with their masses: the last sample, or where the run began.
/// @throws Error where there is none, or it is no state of particles
enum class RunState { last, start };
GasStart gas_from_run(const std::filesystem::path& file, std::size_t space, RunState which = RunState::last);

/// Whether a scenario's text was found in a run.h5, by the name under which it is read.
bool is_in_run_file(const std::filesystem::path& file);

}  // namespace hamflow
