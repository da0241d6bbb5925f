// Typed problems in a scenario.
#pragma once

#include <string>

#include "hamflow/formula/problem_texts.hpp"
#include "toml_table.hpp"

namespace hamflow {

/// The built-in problem that takes a typed potential, and the key that says so.
struct CentralFormula {
  const char* problem;
  const char* key;
};
inline CentralFormula central_formula() { return {"central-force", "potential"}; }

/// Whether [problem] has a Hamiltonian, or a potential, of the user.
bool is_typed_problem(TomlTable& table, const std::string& name);

}  // namespace hamflow
