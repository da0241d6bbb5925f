// Translates a recording (detail/core/tape.hpp) into a program (detail/numerics/program.hpp).
#pragma once

#include "hamflow/detail/core/tape.hpp"
#include "hamflow/detail/numerics/program.hpp"

namespace hamflow {

/// The program of an exact recording, with the operations that outputs and guards need.
Program program_of(const Tape<double>& tape);

}  // namespace hamflow
