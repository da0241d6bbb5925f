// Nineteen stages of eighth order for quadratic T.   [BlanesCasasEscorihuela2022]
// Order 8, 19 force evaluations per step, symplectic, symmetric. Digits refined to 40 from the order conditions
// (tools/refine_coefficients.py).
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::splittings {

inline constexpr SplittingTable rkn8_s19{
    .name = "rkn8-s19",
    .order = 8,
    .reference = "BlanesCasasEscorihuela2022",
    .starts_with = StartsWith::drift,
    .symmetric = true,
    .nystroem = true,
    .coefficients = {"0.0505805",
                     "0.1294786065605367306624937943945166739713",
                     "0.149999",
                     "0.2222572600926711434230435595805940103550",
                     "-0.05517955107716155735110269503613148810943",
                     "-0.05775148933251472047570232463202185734726",
                     "0.4237558988353379514822649980506111783159",
                     "-0.05783122621039249102213450327632149553511",
                     "-0.2134953535846590480596721946325623507907",
                     "0.1030872974371753567479332522654779774362",
                     "-0.06807697745740326191116307362736375002126",
                     "-0.1408196125540907682055541038867954751245",
                     "0.2279170569740134359488872016706763984259",
                     "0.02344626034928262766997137186264428774895",
                     "-0.2353736193810589065247400477315158688403",
                     "0.1348545173566840966178822050679023087844",
                     "0.3874138691798780478167940310580510500943",
                     "0.02879738210737793063451721602112113578283",
                     "-0.1675408234889466614012682197517651690744",
                     "0.2289620083865401878950990652057648678561"},
    .advice = {.purpose = "T = p^T M^-1 p/2 with constant M: the highest accuracy per force evaluation",
               .take = "all digits of double are needed, for bodies, oscillators, central forces",
               .avoid = "T is not quadratic with constant mass matrix: kahan-li8 takes any "
                        "T(p) + V(q), cg any H; few digits are enough: verlet, stv4"}};

}  // namespace hamflow::splittings
