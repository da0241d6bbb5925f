// Between a recording of arithmetic (detail/core/tape.hpp) and what can be run (detail/numerics/program.hpp).
#pragma once

#include "hamflow/detail/core/tape.hpp"
#include "hamflow/detail/numerics/program.hpp"

namespace hamflow {

/// The program of an exact recording: what the outputs and the guards need of the tape.
Program program_of(const Tape<double>& tape);

}  // namespace hamflow
