// Methods to name in advice. A message that names a method as an alternative asks here whether that method accepts the
// problem, so that the reader can follow the advice.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// Returns the first three candidates that accept a problem in an arithmetic: "stv4, cg"; empty if there are none.
/// @param problem null: unknown, so every method may accept it
std::string fitting_methods(std::initializer_list<std::string_view> candidates, const ProblemEntry* problem,
                            const std::string& arithmetic);
/// Returns them as the end of "allowed ...": "soft", or another method, e.g. stv4; empty if there are none.
/// @param what "another method" @param before other allowed values; if not empty, "or" is added
std::string or_fitting_method(const std::string& before, const std::string& what,
                              std::initializer_list<std::string_view> candidates, const ProblemEntry* problem,
                              const std::string& arithmetic);

/// Returns them for the end of a description of methods: ", e.g. stv4, cg"; empty if there are none.
std::string with_fitting_methods(std::initializer_list<std::string_view> candidates, const ProblemEntry* problem,
                                 const std::string& arithmetic);

/// Advice after a step that did not converge.
/// @param differentiated whether the run differentiates its steps: it then refuses to halve them
std::string hint_after_divergence(const Request& request, bool differentiated);

/// refusal() of a method in an arithmetic, with methods that accept the problem in it.
std::string refusal_with_advice(const MethodSpec& spec, const ProblemEntry* problem, const std::string& arithmetic);

}  // namespace hamflow
