// Between a recording of arithmetic (core/tape.hpp) and what can be run (numerics/program.hpp).
#pragma once

#include "hamflow/core/tape.hpp"
#include "hamflow/numerics/program.hpp"

namespace hamflow {

/// The program of an exact recording: what the outputs and the guards need of the tape.
Program program_of(const Tape<double>& tape);

}  // namespace hamflow
