// expect: the kicks and the drifts of a splitting table must each sum to 1
#include "hamflow/hamflow.hpp"

inline constexpr hamflow::SplittingTable nine_tenths{.name = "nine-tenths",
                                                     .order = 2,
                                                     .reference = "none",
                                                     .starts_with = hamflow::StartsWith::kick,
                                                     .symmetric = true,
                                                     .coefficients = {"0.45", "1"}};

void misuse() {
  (void)hamflow::simulate(hamflow::HenonHeiles<double>(), hamflow::SplittingBy<nine_tenths>{}, {0.1, 0.1}, {0.1, 0.1},
                          0.1);
}
