// What makes a run.h5 of particles an H5MD file [DeBuylColbergHofling2014], version 1.1: who made it, the box, masses,
// and elements {step, time, value} whose step and time are links to /step and /t. Its times grow, and may be left out:
// where those of the run do not, as with dt < 0, elements are {step, value}.
#pragma once

#include <string>
#include <vector>

namespace hamflow {

/// The particles of a run; none where `space` is 0, and states are then /q and /p.
struct H5mdParticles {
  std::size_t space = 0;                // numbers of a position
  std::vector<double> masses{};         // one for each particle
  std::vector<std::string> boundary{};  // "periodic" or "none", for each direction of space
  std::vector<double> edges{};          // for each direction; none: the box has no size
  std::string author{};
  bool time_grows = true;         // from sample to sample
  std::vector<double> start_q{};  // of a run whose samples do not begin with its start; else empty
  std::vector<double> start_p{};

  /// Velocities are momenta then, and stand in the file once.
  bool unit_masses() const;
};

/// Where the numbers of the particles stand.
struct H5mdNames {
  static constexpr const char* position = "particles/all/position/value";
  static constexpr const char* momentum = "particles/all/momentum/value";
  static constexpr const char* velocity = "particles/all/velocity/value";
  /// A row a sample, though they do not change: readers of H5MD know no other box.
  static constexpr const char* edges = "particles/all/box/edges/value";
  static constexpr const char* edges_meaning = "of the box, whose middle is the origin";
  static constexpr const char* mass = "particles/all/mass/value";
  static constexpr const char* start_position = "particles/start/position/value";
  static constexpr const char* start_momentum = "particles/start/momentum/value";
};

/// The name of this user, as the system knows it.
std::string author_name();

}  // namespace hamflow
