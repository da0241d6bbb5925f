// What both theses draw without a number or a curve that could be measured.
#include "../experiment.hpp"

namespace hamflow::reproduction {

std::vector<Experiment> drawings_experiments() {
  return {drawing(gross, "G1.1", "12", "division of time into elements"),
          drawing(gross, "G1.2", "13", "master element"),
          drawing(gross, "G2.1", "21", "two masses in space"),
          drawing(gross, "G2.2", "22", "forces between two masses"),
          drawing(gross, "G2.3", "23", "central force"),
          drawing(gross, "G2.4", "24", "polar coordinates"),
          drawing(gross, "G2.6", "27", "cartesian coordinates"),
          drawing(gross, "G2.7", "31", "polar coordinates as generalised coordinates"),
          drawing(gross, "G2.12", "47", "a spring as a model of the Hooke potential"),
          drawing(gross, "G2.22", "62", "a spring as a model of the binomial potential"),
          drawing(gross, "G2.25", "65", "the Duffing oscillator"),
          drawing(sonnleitner, "S1.1", "19", "weak reversibility"),
          drawing(sonnleitner, "S1.3", "26", "the T-tube"),
          drawing(sonnleitner, "S3.1", "70", "scheme of the gas program"),
          drawing(sonnleitner, "S3.9", "101", "scheme of the T-tube program")};
}

}  // namespace hamflow::reproduction
