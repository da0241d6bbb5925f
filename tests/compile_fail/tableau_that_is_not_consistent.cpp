// expect: the weights of a Runge-Kutta tableau must sum to 1
#include "hamflow/hamflow.hpp"

inline constexpr hamflow::ButcherTableau<2> heun_with_wrong_weights{.name = "wrong",
                                                                    .order = 2,
                                                                    .reference = "none",
                                                                    .a = {{{}, {hamflow::Ratio{1, 1}}}},
                                                                    .b = {hamflow::Ratio{1, 2}, hamflow::Ratio{1, 3}}};

void misuse() {
  (void)hamflow::simulate(hamflow::HenonHeiles<double>(), hamflow::RungeKuttaBy<heun_with_wrong_weights>{}, {0.1, 0.1},
                          {0.1, 0.1}, 0.1);
}
