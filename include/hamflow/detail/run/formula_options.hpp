// The keys of [problem] with which a Hamiltonian, or a potential, is typed.
#pragma once

#include <string>
#include <vector>

#include "hamflow/detail/core/option_info.hpp"

namespace hamflow {

/// The keys of the problem `formula`, in the order in which they are shown.
const std::vector<OptionInfo>& formula_options();
/// How constraints are kept.
const OptionInfo& constraint_form_option();
/// The keys of `central-force` with a typed potential.
const std::vector<OptionInfo>& central_formula_options();
/// What a formula may be made of, in some sentences.
const std::vector<std::string>& formula_language();

}  // namespace hamflow
