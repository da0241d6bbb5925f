// Elements that figures of particles share: positions at a time, containers, and a selection from very many particles.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "figure.hpp"
#include "hamflow/figures/curves.hpp"
#include "hamflow/figures/page.hpp"
#include "planes.hpp"

namespace hamflow::figures {

/// Describes the samples if none is at a given time, to rounding; empty if there is one.
struct MissingSample {
  std::string samples{};  // for example "the 21 samples from 0 to 1; the nearest is at 0.5"
  bool is_beyond = false;
};
MissingSample missing_sample_at(const FigureData& data, double t);
/// Returns the sample nearest to each time.
std::vector<std::size_t> samples_at(const FigureData& data, const std::vector<double>& times);

/// Returns at most `most` of `count` indices in order, one at a pseudo-random place in each stretch, the same in every
/// run. If particles are numbered along a lattice, indices at a constant distance would only show some planes of the
/// lattice.
std::vector<std::size_t> some_of(std::size_t count, std::size_t most);
/// Returns a note such as "20000 of 1000000 particles are drawn"; empty if all are.
std::string part_note(std::size_t drawn, std::size_t count);

/// Moves each position by whole edges into a periodic box; with other containers positions are unchanged.
std::vector<double> folded(std::vector<double> positions, const FigureParticles& of);

/// Returns the outline of the circle or box in a plane; empty without a container.
Curve outline(const FigureParticles& of, Plane plane);

/// Returns a label of a time.
std::string time_text(double t);

}  // namespace hamflow::figures
