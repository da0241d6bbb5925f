// Compositions of Kepler drifts and kicks by the planets.
#pragma once

#include <any>

#include "hamflow/core/text.hpp"
#include "hamflow/detail/run/method_family.hpp"
#include "hamflow/methods/wisdom_holman_step.hpp"

namespace hamflow::families {

struct Saba {
  /// Powers of dt in the error of a step: times the mass of the planets, its square, its cube. 0: not given.
  struct Powers {
    int first = 1;
    int second = 0;
    int third = 0;
  };

  static const BoundOptions<Powers>& options() {
    static const BoundOptions<Powers> all{
        bind_number(
            {.name = "order_of_masses",
             .default_value = "1",
             .meaning = "n = 1, 2, 3, 4: the error of a step has a term of order 2 n that is proportional to the "
                        "masses of the planets, and one of order 2 proportional to their squares. 8 and 10: with "
                        "order_of_squares and order_of_cubes, saba(8,4), saba(8,6,4), saba(10,6,4)",
             .range = Range::whole_from(1, 10),
             .position = 1},
            &Powers::first),
        bind_number({.name = "order_of_squares",
                     .meaning = "the order of the term proportional to the squares of these masses",
                     .range = Range::whole_from(4, 6),
                     .unset = "2",
                     .example = "4",
                     .position = 2},
                    &Powers::second),
        bind_number({.name = "order_of_cubes",
                     .meaning = "the order of the term proportional to their cubes",
                     .range = Range::whole_from(4, 4),
                     .unset = "order_of_squares",
                     .example = "4",
                     .position = 3},
                    &Powers::third)};
    return all;
  }

  static MethodFamily declared() {
    return {
        .name = "saba",
        .meaning = "compositions of Kepler drifts and kicks by the planets, for bodies about one that is much heavier",
        .methods = {"saba"},
        .options = declarations_of(options()),
        .read = [](const Texts& given) { return std::any(table_of(given)); },
        .rank = 1,
        .not_on_lattice = "Jacobi coordinates are no bijection of the lattice; wisdom-holman has others that are",
        .representatives = {"saba(1)", "saba(2)", "saba(3)", "saba(4)", "saba(8,4)", "saba(8,6,4)", "saba(10,6,4)"},
        .describe = [](std::size_t, const Texts& given) { return describe_saba(table_of(given)); },
        .needs = [](std::size_t) { return "bodies under gravity (n-body, solar-system)"; },
        .advice =
            [](std::size_t) {
              return MethodAdvice{
                  .take =
                      "planets move about a star for very many revolutions, and wisdom-holman is not accurate "
                      "enough: saba(10,6,4) takes long steps",
                  .avoid = "bodies have like masses or meet closely: kahan-li8, rkn8-s19"};
            },
        .digits = [](std::size_t) { return 40; },
        .refused = [](const Texts& given) -> std::pair<std::string, std::string> {
          const std::string name = name_of(given);
          if (index_of(name) < kepler_tables().size()) return {};
          const std::string allowed =
              joined(kepler_tables(), [](const KeplerTable& table) { return "saba(" + std::string(table.name) + ")"; });
          return {"order_of_masses", "found saba(" + name + "); allowed " + allowed};
        },
        .hint = [](const Texts&, const UsableAdvice&) { return "try a smaller dt, or dop853 for a close encounter"; }};
  }

  template <class F>
  static auto visit(std::size_t, const std::any& given, F&& f) {
    return f(hamflow::Saba{std::any_cast<std::size_t>(given)});
  }

 private:
  static std::string name_of(const Texts& given) {
    const Powers powers = read_options(options(), given);
    std::string name = std::to_string(powers.first);
    for (const int next : {powers.second, powers.third}) {
      if (next > 0) name += "," + std::to_string(next);
    }
    return name;
  }
  static std::size_t index_of(const std::string& name) {
    std::size_t index = 0;
    while (index < kepler_tables().size() && kepler_tables()[index].name != name) ++index;
    return index;
  }
  /// The first table where there is none of this name, which is refused.
  static std::size_t table_of(const Texts& given) {
    const std::size_t index = index_of(name_of(given));
    return index < kepler_tables().size() ? index : 0;
  }
};

}  // namespace hamflow::families
