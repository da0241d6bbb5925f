// Typed problems in a scenario.
#pragma once

#include <string>
#include <vector>

#include "hamflow/core/option_info.hpp"
#include "hamflow/formula/problem_texts.hpp"
#include "toml_table.hpp"

namespace hamflow {

/// The keys of the problem `formula`, in the order in which they are shown.
const std::vector<OptionInfo>& formula_options();
/// How constraints are kept.
const OptionInfo& constraint_form_option();
/// Those of `central-force` with a typed potential, beside the others that it has.
const std::vector<OptionInfo>& central_formula_options();
/// The choices of the example that stands with them.
Choices central_formula_example(const std::string& coordinates);
/// What a formula may be made of, in some sentences.
const std::vector<std::string>& formula_language();

/// Whether [problem] has a Hamiltonian, or a potential, of the user.
bool is_typed_problem(TomlTable& table, const std::string& name);

}  // namespace hamflow
