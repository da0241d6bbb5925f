// Initial state of the particles of a gas, as texts that every arithmetic reads with all its digits.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace hamflow {

struct GasStart {
  std::vector<std::string> q;  // ordered by particle
  std::vector<std::string> p;
  std::vector<std::string> masses;   // from the file, a single one if all are equal; empty if it has none
  std::vector<std::size_t> lines{};  // line of each particle in a CSV file, counted from 1
};

/// Places n^space particles on a square or cubic lattice; the first coordinate changes fastest. Without `edges` the
/// lattice fills [-1, 1]^space, with particles on its sides; with `edges` each particle is in the middle of a cell of
/// the box. Momenta are uniform in [-1, 1), in multiples of 2e-5 [Sonnleitner2010, ch. 3a]: the k-th of them is 2e-5
/// floor(1e5 u_k) - 1, where u_k in [0, 1) has the upper 53 bits of counter_bits(seed, k), k = 0, 1, ... in the order
/// of p.
/// @param n at least 2   @param space 2 or 3   @param edges empty, or one for each coordinate, numbers as text
GasStart gas_on_lattice(std::int64_t n, std::size_t space, std::uint64_t seed,
                        const std::vector<std::string>& edges = {});
/// Places n^space particles at rest on [0, 1]^space.
GasStart gas_in_corner(std::int64_t n, std::size_t space);
/// Reads a CSV file. Its first row has the names x, y(, z), p_x, p_y(, p_z)(, mass) in any order, and each further row
/// has one particle.
/// @throws Error with line, column, what was found and what is allowed
GasStart gas_from_file(const std::filesystem::path& file, std::size_t space);

/// Reads a state of the particles in a run.h5, with their masses: the last sample, or the start of the run.
/// @throws Error if the file has no such state, or no particles
enum class RunState { last, start };
GasStart gas_from_run(const std::filesystem::path& file, std::size_t space, RunState which = RunState::last);

/// Returns whether a file is an HDF5 file, so that it contains the scenario of a run.
bool is_in_run_file(const std::filesystem::path& file);

}  // namespace hamflow
