// Extends the run.h5 of particles to an H5MD file [DeBuylColbergHofling2014], version 1.1: author, box, masses, and
// elements {step, time, value} whose step and time are links to /step and /t. In H5MD times have to increase, but may
// be left out. So if they decrease, as with dt < 0, elements are {step, value}.
#pragma once

#include <string>
#include <vector>

namespace hamflow {

/// The particles of a run. If `space` is 0, the run has no particles, and its states are in /q and /p.
struct H5mdParticles {
  std::size_t space = 0;                // number of components of a position
  std::vector<double> masses{};         // one for each particle
  std::vector<std::string> boundary{};  // "periodic" or "none", for each direction of space
  std::vector<double> edges{};          // edge length for each direction; empty: the box has no size
  std::string author{};
  bool time_grows = true;         // time increases from sample to sample
  std::vector<double> start_q{};  // start of a run whose samples do not begin with it; else empty
  std::vector<double> start_p{};

  /// If all masses are 1, velocities equal momenta and are stored only once.
  bool unit_masses() const;
};

/// Paths of the particles' datasets.
struct H5mdNames {
  static constexpr const char* position = "particles/all/position/value";
  static constexpr const char* momentum = "particles/all/momentum/value";
  static constexpr const char* velocity = "particles/all/velocity/value";
  /// The edges do not change but have a row for each sample, because readers of H5MD do not accept another form.
  static constexpr const char* edges = "particles/all/box/edges/value";
  static constexpr const char* edges_meaning = "edges of the box, which is centred at the origin";
  static constexpr const char* mass = "particles/all/mass/value";
  static constexpr const char* start_position = "particles/start/position/value";
  static constexpr const char* start_momentum = "particles/start/momentum/value";
};

/// Returns the name of the user, as the system knows it.
std::string author_name();

}  // namespace hamflow
