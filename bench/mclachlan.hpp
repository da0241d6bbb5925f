// McLachlan's symmetric Runge-Kutta-Nystroem splittings, with the coefficients of Boost.Odeint, so that both libraries
// run the same methods: sb3a_m4 with four forces (Odeint computes a fifth and multiplies it by 0) and sb3a with five
// (Odeint: six).
// [McLachlan1995]
#pragma once

#include <array>

#include "hamflow/methods/tables.hpp"

namespace bench {

/// a1 = 1/2 - z, a2 = z - 1/3, z = sqrt(7/8)/3. Entries are in the order of application: drift, kick, ..., drift.
inline constexpr hamflow::SplittingTable sb3a_m4{
    .name = "sb3a_m4",
    .order = 4,
    .reference = "McLachlan1995",
    .starts_with = hamflow::StartsWith::drift,
    .symmetric = true,
    .nystroem = true,
    .coefficients = {"0.18819521776883821786802093897362089152", "1", "-0.02152855110217155120135427230695422485",
                     "-1/2", "2/3"}};
inline constexpr std::array<double, 9> sb3a_m4_numbers = [] {
  constexpr double a1 = 0.18819521776883821786802093897362089152, a2 = -0.02152855110217155120135427230695422485;
  return std::array{a1, 1.0, a2, -0.5, 2.0 / 3, -0.5, a2, 1.0, a1};
}();

inline constexpr hamflow::SplittingTable sb3a{
    .name = "sb3a",
    .order = 4,
    .reference = "McLachlan1995",
    .starts_with = hamflow::StartsWith::drift,
    .symmetric = true,
    .nystroem = true,
    .coefficients = {"0.40518861839525227722", "-3/73", "-0.28714404081652408900", "17/59", "0.38195542242127181178",
                     "0.50592059438123984211748316693754353378"}};
inline constexpr std::array<double, 11> sb3a_numbers = [] {
  constexpr double a1 = 0.40518861839525227722, a2 = -0.28714404081652408900, a3 = 0.38195542242127181178;
  constexpr double b1 = -3.0 / 73, b2 = 17.0 / 59, b3 = 0.50592059438123984211748316693754353378;
  return std::array{a1, b1, a2, b2, a3, b3, a3, b2, a2, b1, a1};
}();

}  // namespace bench
