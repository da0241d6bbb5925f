// [Sonnleitner2010]: what the listings of the gas and of the T-tube compute beside what they are said to, by page.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "../experiment.hpp"
#include "../gas_runs.hpp"

namespace hamflow::reproduction {

namespace sonnleitner_listings {

/// Pages 72 and 81: sqrt(sum |difference|^2)/N of N particles is called their mean error.
void mean_error(Study& study) {
  constexpr int particles = 121;
  constexpr double error = 1e-3;  // of each particle
  const double of_equal = std::sqrt(particles * error * error) / particles / error;
  const Return back = there_and_back(study, {.side = 11, .steps = 20});
  double squares = 0;
  for (std::size_t i = 0; i < back.start.q.size(); ++i) squares += std::pow(back.end.q[i] - back.start.q[i], 2);
  const double root_mean_square = std::sqrt(squares / particles);
  study.claim({"mean", "the mean error of the listing is the typical error of a particle", "mittFehlerOrt", "72, 81"},
              within(1, 1e-9, "the listing's number divided by the root mean square, for 121 particles"),
              {{of_equal, 1e-15, "if all errors are equal, the listing gives 1/sqrt(N) of them"},
               {back.position / root_mean_square, 1e-12, "for a run of 20 steps there and back"}},
              Grounds::identity);
}

/// What the listing of the force, page 74, has beside the Hamiltonian of page 67: a scale, of which no text speaks.
void factor_of_scale(Study& study) {
  std::string lengths;
  for (const int side : {11, 21}) {
    const double spacing = 2.0 / (side - 1);  // "Abst", page 72
    const double listed = GasRun{.side = side, .scale = "listing"}.scale_number();
    // LJKraft(:,i,j) = dij*12*(d2ij^-7 - d2ij^-4), d2ij = |dij|^2 SkalierFaktor^2
    const auto factor = [](double squared) { return 12 * (std::pow(squared, -7) - std::pow(squared, -4)); };
    const double of_listing = factor(spacing * spacing * listed * listed), of_text = factor(spacing * spacing);
    study.claim({fmt::format("force_{}", side * side),
                 fmt::format("{} particles: the listed force belongs to the printed Hamiltonian", side * side),
                 "d2ij*SkalierFaktor^2 (74); |qi - qj|^-12 - 2 |qi - qj|^-6 (67)", "67, 74"},
                within(1, 1e-9, "listed force between neighbours at the start over that of the Hamiltonian"),
                {{of_listing / of_text, 1e-15,
                  fmt::format("{:.3g} over {:.3g}, for neighbours at distance {:g}", spacing * of_listing,
                              spacing * of_text, spacing)}},
                Grounds::identity);
    study.nothing_to_test(
        fmt::format("factor_{}", side * side),
        fmt::format("the text does not say what the factor (AnzahlTeile - 1)/2 of page 74 is for; with {} particles it "
                    "is {:g}, {:g} times the reciprocal of the distance of neighbours, 2/(N - 1) of page 72",
                    side * side, listed, listed * spacing));
    lengths += fmt::format("{}{:g} with {} particles", lengths.empty() ? "" : ", ", spacing * listed, side * side);
  }
  study.note(
      "The text does not say what SkalierFaktor is for. If N were the number on a side, as on page 72, and not the "
      "number "
      "of particles, it would be 1/Abst, and neighbours would start one length of the potential apart. In the listing "
      "they start N + 1 lengths apart, " +
      lengths + ", which is almost an ideal gas. hamflow has both, as scale \"per-side\" and \"listing\".");
}

/// The listed tests behind a step that leads to `next`, in their order: each negates one of the momenta p of before.
std::array<double, 2> listed_bounce(const std::array<double, 2>& p, const std::array<double, 2>& next) {
  std::array<double, 2> after = p;
  if (std::abs(next[0]) > 1 || std::abs(next[1] - 1.1) > 1) {
    if (std::abs(next[0]) > 1) after = {-p[0], p[1]};
    if (std::abs(next[1] - 1.1) > 1) after = {p[0], -p[1]};
  }
  return after;
}

void both_walls(Study& study) {
  const std::array<double, 2> p{10, 100}, next{1.05, 2.105};  // from (0.95, 2.095)
  const std::array<double, 2> after = listed_bounce(p, next);
  study.claim({"both", "if both bodies are beyond their walls after a step, the listing reverses both momenta",
               "the momentum is negated in part", "103, 104"},
              within(2, 0.5, "number of momenta that are reversed"),
              {{static_cast<double>(after[0] == -p[0]) + static_cast<double>(after[1] == -p[1]), 0,
                "the second test begins again with the momenta before the first, and undoes it"}},
              Grounds::identity);
}

}  // namespace sonnleitner_listings

std::vector<Experiment> sonnleitner_listings_experiments() {
  using namespace sonnleitner_listings;
  return {{{"S-C72", sonnleitner, "72, 81", "gas: the mean error of the listing"}, mean_error},
          {{"S-C75", sonnleitner, "72 to 75", "gas: the factor of the scale"}, factor_of_scale},
          {{"S-C103", sonnleitner, "103, 104", "T-tube: both walls in one step"}, both_walls}};
}

}  // namespace hamflow::reproduction
