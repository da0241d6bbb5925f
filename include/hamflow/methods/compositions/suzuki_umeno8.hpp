// Suzuki's and Umeno's fifteen Stoermer-Verlet steps, found by McLachlan too.
// [SuzukiUmeno1993; McLachlan1995; HLW2006, V.(3.13)]
// Order 8, 15 force evaluations per step, symplectic, symmetric. Digits refined to 40 from the order conditions
// (tools/refine_coefficients.py).
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::compositions {

inline constexpr CompositionTable suzuki_umeno8{
    .name = "suzuki-umeno8",
    .order = 8,
    .reference = "SuzukiUmeno1993; McLachlan1995; HLW2006, V.(3.13)",
    .half = {"0.7416703643506129534482278017838063156035", "-0.4091008258000315939973000958935634173099",
             "0.1907547102962383799538762564503716627355", "-0.5738624711160822666563877266355357421595",
             "0.2990641813036559238444635406886029882258", "0.3346249182452981837849579798821822886337",
             "0.3152930923967665966320566638110024309941"}};

}  // namespace hamflow::compositions
