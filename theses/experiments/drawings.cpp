// What both theses draw without a number or a curve that could be measured.
#include "../experiment.hpp"

namespace hamflow::reproduction {

std::vector<Experiment> drawings_experiments() {
  return {drawing(gross, "G1.1", "4", "division of time into elements"),
          drawing(gross, "G1.2", "5", "master element"),
          drawing(gross, "G2.1", "13", "two masses in space"),
          drawing(gross, "G2.2", "15", "forces between two masses"),
          drawing(gross, "G2.3", "16", "central force"),
          drawing(gross, "G2.4", "20", "polar coordinates"),
          drawing(gross, "G2.6", "27", "cartesian coordinates"),
          drawing(gross, "G2.7", "32", "polar coordinates as generalised coordinates"),
          drawing(gross, "G2.12", "48", "a spring as a model of the Hooke potential"),
          drawing(gross, "G2.22", "62", "a spring as a model of the binomial potential"),
          drawing(gross, "G2.25", "65", "the Duffing oscillator"),
          drawing(gross, "G3.1", "77", "the double pendulum"),
          drawing(gross, "G3.2", "85", "double pendulum, absolute angles"),
          drawing(gross, "G3.5", "90", "phase space of systems of two degrees of freedom"),
          drawing(gross, "G3.11", "96", "double pendulum, relative angles"),
          drawing(gross, "G3.19", "111", "nonlinear double pendulum, absolute angles"),
          drawing(gross, "G3.20", "115", "start of the lower rod at +90 degrees, absolute angles"),
          drawing(gross, "G3.23", "118", "nonlinear double pendulum, relative angles"),
          drawing(gross, "G3.24", "121", "start of the lower rod at +90 degrees, relative angles"),
          drawing(sonnleitner, "S1.1", "19", "weak reversibility"),
          drawing(sonnleitner, "S1.3", "26", "the T-tube"),
          drawing(sonnleitner, "S3.1", "70", "scheme of the gas program"),
          drawing(sonnleitner, "S3.9", "101", "scheme of the T-tube program")};
}

}  // namespace hamflow::reproduction
