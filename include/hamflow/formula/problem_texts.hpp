// Typed Hamiltonians: the keys of the problem `formula`, and of `central-force` with potential = "formula".
//
// Such a problem is an entry of the catalogue, found by choices: formula_choices(texts) makes them,
// find_problem("formula", choices) (run/catalog.hpp) gives the entry, whose info() names its coordinates, parameters
// and invariants. The choices have names, sizes of lists and the whole numbers that indices and sums need, but no other
// values: members of a sweep that differ in parameters share one entry, and give their values with the request as for
// every problem.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "hamflow/core/error.hpp"
#include "hamflow/core/problem_info.hpp"
#include "hamflow/detail/formula/structure.hpp"

namespace hamflow {

/// The names that choices use, and the keys of a scenario.
struct FormulaKeys {
  static constexpr const char* problem = "formula";
  static constexpr const char* coordinates = "coordinates";
  static constexpr const char* momenta = "momenta";
  static constexpr const char* hamiltonian = "hamiltonian";
  static constexpr const char* kinetic = "kinetic";
  static constexpr const char* potential = "potential";
  static constexpr const char* parameters = "parameters";
  static constexpr const char* invariants = "invariants";
  static constexpr const char* constraints = "constraints";
  static constexpr const char* constraint_form = "constraint_form";
  static constexpr const char* manifold = "manifold";
  static constexpr const char* multiplier = "multiplier";
  static constexpr const char* central_potential = "V";  // of central-force
  static constexpr const char* unknown = "?";            // a parameter value that choices do not keep
};

/// The names of `central-force` for a typed potential.
struct CentralKeys {
  static constexpr const char* problem = "central-force";
  static constexpr const char* key = "potential";
  static constexpr const char* mass = "mass";
  static constexpr const char* polar = "polar";
};

/// The problem `formula`. Parameters: name to a number expression "1/3" or a list "[1, 2]".
struct FormulaTexts {
  std::vector<std::string> coordinates{};  // "x"; "x[n]" with a number or whole parameter n: x[1] .. x[n]
  std::vector<std::string> momenta{};      // empty: p of q, p1 of q1, p_x of x
  std::string hamiltonian{};               // or kinetic and potential
  std::string kinetic{};
  std::string potential{};
  Texts parameters{};
  std::vector<std::pair<std::string, std::string>>
      invariants{};                        // name, formula of coordinates, momenta, parameters, t
  std::vector<std::string> constraints{};  // g(q) = 0
  std::string constraint_form{};           // with constraints: "manifold" (or empty) or "multiplier"
};

/// The error of a typed text, and the text at fault: "hamiltonian", "coordinates[1]", "invariants.L", "parameters.k".
/// The message has the form "found ...; allowed ...; did you mean ...?".
class FormulaError : public Error {
 public:
  FormulaError(std::string at, const std::string& message) : Error(message), key(std::move(at)) {}
  std::string key;
};

using Choices = std::map<std::string, std::string>;

/// The owner of a potential V(r): its name in messages, and whether V may depend on the time.
struct CentralUse {
  std::string owner = CentralKeys::problem;
  bool has_time = true;
};

/// The choices of a typed problem, after checking that every text can be parsed and differentiated.
/// @throws FormulaError
Choices formula_choices(const FormulaTexts& texts);
/// Returns the choices of `central-force` with potential = "formula", from V(r) and the parameters.
/// @param coordinates "cartesian" or "polar"
/// @param use for another owner, such as the pair law of a gas @throws FormulaError
Choices central_formula_choices(const std::string& potential, const Texts& parameters, const std::string& coordinates,
                                const CentralUse& use = {});
/// The whole Hamiltonian of a particle of mass `mass` in such a potential, in the coordinates of the choices.
FormulaTexts central_formula_texts(const Choices& choices);
/// Only p_r^2/2 + V(r).
FormulaTexts radial_formula_texts(const Choices& choices);
/// The texts from which choices were made; parameter values that choices do not keep are "?".
FormulaTexts formula_texts(const Choices& choices);

/// The texts of a problem given only by H. The names p, p1, p2 ... and p_x for a name x are momenta. They determine the
/// coordinates, q, q1, q2 ... and x, in the order of first occurrence. Every other name is a parameter.
/// @throws FormulaError if there is no momentum
FormulaTexts texts_of_hamiltonian(const std::string& hamiltonian, const Texts& parameters = {});

}  // namespace hamflow
