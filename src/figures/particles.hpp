// What figures of particles draw alike: places at a time, what holds them, some of very many.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "figure.hpp"
#include "hamflow/figures/curves.hpp"
#include "hamflow/figures/page.hpp"
#include "planes.hpp"

namespace hamflow::figures {

/// That there is no sample at a time, to rounding: which there are instead, or nothing where there is one.
struct OtherSample {
  std::string told{};  // "the 21 samples from 0 to 1; the nearest is at 0.5"
  bool is_beyond = false;
};
OtherSample other_sample_at(const FigureData& data, double t);
/// The sample nearest to each time.
std::vector<std::size_t> samples_at(const FigureData& data, const std::vector<double>& times);

/// At most `most` of `count` numbers, in order, one at random from each stretch, always the same: of particles that are
/// numbered along a lattice an even stride would show some of its planes and hide the rest.
std::vector<std::size_t> some_of(std::size_t count, std::size_t most);
/// "20000 of 1000000 particles are drawn"; empty where all are.
std::string part_note(std::size_t drawn, std::size_t count);

/// Each position moved by whole edges into a periodic box; of other containers as they are.
std::vector<double> folded(std::vector<double> positions, const FigureParticles& of);

/// The outline of the circle or box, seen in a plane; of no container nothing.
Curve outline(const FigureParticles& of, Plane plane);

/// {x} = a number, for a time.
std::string time_text(double t);

}  // namespace hamflow::figures
