// Typed problems in a scenario.
#pragma once

#include <string>
#include <vector>

#include "hamflow/core/option_info.hpp"
#include "hamflow/formula/problem_texts.hpp"
#include "toml_table.hpp"

namespace hamflow {

/// The built-in problem that takes a typed potential, and the key that says so.
struct CentralFormula {
  const char* problem;
  const char* key;
};
inline CentralFormula central_formula() { return {"central-force", "potential"}; }

/// The keys of the problem `formula`, in the order in which they are shown.
const std::vector<OptionInfo>& formula_options();
/// What a formula may be made of, in some sentences.
const std::vector<std::string>& formula_language();

/// Whether [problem] has a Hamiltonian, or a potential, of the user.
bool is_typed_problem(TomlTable& table, const std::string& name);

}  // namespace hamflow
