// Forces, states and energies of LAMMPS (tests/data/lammps.json, by tools/lammps_reference.py): 108 particles in space
// with a shifted potential, 49 in the plane with a force-shifted one, disordered, in periodic boxes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hamflow/run/catalog.hpp"
#include "reference_data.hpp"

namespace hamflow::test {
namespace {

class Lammps : public ::testing::TestWithParam<const char*> {
 protected:
  const nlohmann::json data_ = reference_file("lammps.json")[GetParam()];
  const std::map<std::string, std::string> choices_{{"container", "periodic"},
                                                    {"cutoff_kind", data_["kind"].get<std::string>()}};
  const std::shared_ptr<const ProblemEntry> entry_ = find_problem("gas", choices_);
  const ProblemEntry& gas_ = *entry_;
  const std::size_t space_ = data_["dimension"];

  Texts parameters() const {
    const std::string edge = data_["edge"].dump();
    return complete(gas_.info, {{"dimension", std::to_string(space_)},
                                {"epsilon", "1"},
                                {"sigma", "1"},
                                {"size", "[" + edge + ", " + edge + (space_ == 3 ? ", " + edge : "") + "]"},
                                {"cutoff", data_["radius"].dump()}});
  }
  Request request(const std::string& method, const std::string& dt) const {
    return {.problem = "gas",
            .variant = choices_,
            .parameters = parameters(),
            .start = {.q = texts(data_["q"]), .p = texts(data_["p"])},
            .method = {.name = method},
            .dt = dt};
  }
};

/// One kick of length 2^-30 from rest, by the engine and by the loop over pairs that all other number types take.
TEST_P(Lammps, Forces) {
  const std::vector<double> forces = doubles(data_["force"]);
  double largest = 0;
  for (const double f : forces) largest = std::max(largest, std::abs(f));
  for (const char* const arithmetic : {"double", "double-double"}) {
    Request from_rest = request("euler-b", "2^-30");
    std::fill(from_rest.start.p.begin(), from_rest.start.p.end(), "0");
    from_rest.arithmetic = arithmetic;
    const auto simulation = make_simulation(from_rest);
    ASSERT_EQ(simulation->advance(1), Outcome::done);
    Frame frame;
    simulation->look(frame);
    // Up to 60 partners within reach, each force to some ten roundings, which are 13 times those of r (r^-13): of terms
    // that are some times the largest sum. 1e-10 is what is asked for; this is 6e-11 of forces up to 67.
    const double bound = 4096 * std::numeric_limits<double>::epsilon() * largest;
    ASSERT_LT(bound, 1e-10);
    for (std::size_t i = 0; i < forces.size(); ++i) {
      EXPECT_NEAR(frame.p[i] * 0x1p30, forces[i], bound) << arithmetic << ", coordinate " << i;
    }
  }
}

/// Its velocity Verlet is verlet. Over 100 steps rounding grows some tenfold, and each step adds its own.
TEST_P(Lammps, EnergiesAndStates) {
  const auto simulation = make_simulation(request("verlet", data_["dt"].dump()));
  const double many = static_cast<double>(data_["q"].size());
  Frame frame;
  for (const int step : {0, 20, 50, 100}) {
    ASSERT_EQ(simulation->advance(step - simulation->step()), Outcome::done);
    simulation->look(frame);
    const auto& energies = data_["energies"][std::to_string(step)];
    const double kinetic = energies["kinetic"];
    const double potential = energies["potential"];
    double sum = 0;
    for (const double p : frame.p) sum += p * p / 2;
    // A force is at most 67, so that 1e-13 in each coordinate is at most 67 * 1e-13 each in V.
    EXPECT_NEAR(sum, kinetic, 7e-12 * many) << step;
    EXPECT_NEAR(frame.energy - sum, potential, 7e-12 * many) << step;
  }
  const std::vector<double> q = doubles(data_["end"]["q"]);
  const std::vector<double> p = doubles(data_["end"]["p"]);
  for (std::size_t i = 0; i < q.size(); ++i) {
    EXPECT_NEAR(frame.q[i], q[i], 1e-12) << i;
    EXPECT_NEAR(frame.p[i], p[i], 1e-11) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Boxes, Lammps, ::testing::Values("space", "plane"),
                         [](const auto& each) { return std::string(each.param); });

}  // namespace
}  // namespace hamflow::test
