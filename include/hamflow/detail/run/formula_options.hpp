// The keys of [problem] for a typed Hamiltonian or potential.
#pragma once

#include <string>
#include <vector>

#include "hamflow/detail/core/option_info.hpp"

namespace hamflow {

/// The keys of the problem `formula`, in the order in which they are shown.
const std::vector<OptionInfo>& formula_options();
/// The option that chooses how constraints are kept.
const OptionInfo& constraint_form_option();
/// The keys of `central-force` with a typed potential.
const std::vector<OptionInfo>& central_formula_options();
/// The syntax of formulas, in a few sentences.
const std::vector<std::string>& formula_language();

}  // namespace hamflow
