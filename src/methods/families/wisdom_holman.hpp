// Kepler drifts and kicks by the planets.
#pragma once

#include <any>

#include "hamflow/detail/run/method_family.hpp"
#include "hamflow/methods/wisdom_holman_step.hpp"

namespace hamflow::families {

struct WisdomHolman {
  static const BoundOptions<WisdomHolmanOptions>& options() {
    static const BoundOptions<WisdomHolmanOptions> all{
        bind_word(
            {.name = "coordinates",
             .default_value = "jacobi",
             .meaning = "jacobi: each planet from the centre of mass of the bodies before it, so give planets from "
                        "the inside out; democratic-heliocentric: from the first body, where orbits cross"},
            &WisdomHolmanOptions::coordinates,
            std::vector<std::pair<std::string, WisdomHolmanCoordinates>>{
                {"jacobi", WisdomHolmanCoordinates::jacobi},
                {"democratic-heliocentric", WisdomHolmanCoordinates::heliocentric}}),
        bind_number(
            {.name = "corrector",
             .default_value = "0",
             .meaning = "3, 5, 7, 11 or 17: the order of a change of variables that removes the error proportional to "
                        "the masses of the planets; it costs nothing between recorded states, in which it is undone. "
                        "0: none",
             .range = Range::whole_from(0, 17)},
            &WisdomHolmanOptions::corrector),
        bind_word(
            {.name = "kernel",
             .default_value = "standard",
             .meaning = "lazy: two forces instead of one, and no error proportional to dt^2 and the square of the "
                        "masses of the planets"},
            &WisdomHolmanOptions::kernel,
            std::vector<std::pair<std::string, WisdomHolmanKernel>>{{"standard", WisdomHolmanKernel::standard},
                                                                    {"lazy", WisdomHolmanKernel::lazy}})};
    return all;
  }

  static MethodFamily declared() {
    return {
        .name = "wisdom-holman",
        .meaning = "Kepler drifts and kicks by the planets, for bodies about one that is much heavier",
        .methods = {"wisdom-holman"},
        .options = declarations_of(options()),
        .read = [](const Texts& given) { return std::any(read_options(options(), given)); },
        .rank = 1,
        .not_on_lattice =
            "Jacobi coordinates are no bijection of the lattice; coordinates = "
            "\"democratic-heliocentric\" are",
        .allowed_on_lattice =
            [](const Texts& given) {
              return read_options(options(), given).coordinates == WisdomHolmanCoordinates::heliocentric;
            },
        .representatives = {"wisdom-holman", "wisdom-holman(coordinates=democratic-heliocentric)",
                            "wisdom-holman(kernel=lazy)", "wisdom-holman(corrector=3)",
                            "wisdom-holman(corrector=17,kernel=lazy)"},
        .describe = [](std::size_t, const Texts& given) { return hamflow::describe(read_options(options(), given)); },
        .needs = [](std::size_t) { return "bodies under gravity (n-body, solar-system)"; },
        .advice =
            [](std::size_t) {
              return MethodAdvice{.take =
                                      "planets move about a star for very many revolutions: the error of a step "
                                      "is proportional to the masses of the planets",
                                  .avoid = "bodies have like masses or meet closely: kahan-li8, rkn8-s19"};
            },
        .refused = [](const Texts& given) -> std::pair<std::string, std::string> {
          const WisdomHolmanOptions read = read_options(options(), given);
          const std::string found = std::to_string(read.corrector);
          if (read.corrector != 0 && !corrector_stages().contains(read.corrector)) {
            return {"corrector", "found " + found + "; allowed 0, 3, 5, 7, 11, 17"};
          }
          if (read.coordinates == WisdomHolmanCoordinates::jacobi) return {};
          const std::string with = " with democratic-heliocentric coordinates; allowed with jacobi";
          if (read.corrector != 0) return {"corrector", "found " + found + with};
          if (read.kernel == WisdomHolmanKernel::lazy) return {"kernel", "found lazy" + with};
          return {};
        },
        .hint = [](const Texts&, const UsableAdvice&) { return "try a smaller dt, or dop853 for a close encounter"; }};
  }

  template <class F>
  static auto visit(std::size_t, const std::any& given, F&& f) {
    return f(hamflow::WisdomHolman{std::any_cast<const WisdomHolmanOptions&>(given)});
  }
};

}  // namespace hamflow::families
