// A family of methods as the catalogue declares it. One file in src/catalog/families/ makes it (see HACKING, Adding);
// everything else that has to know about methods asks here.
#pragma once

#include <any>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "hamflow/core/method_info.hpp"
#include "hamflow/detail/core/option_info.hpp"

namespace hamflow {

/// A method by name, with those of its options that were given, as texts.
struct MethodSpec {
  std::string name = "stv4";
  Texts options{};

  friend bool operator==(const MethodSpec&, const MethodSpec&) = default;
};

/// What a user should know before taking a method.
struct MethodAdvice {
  std::string purpose{};  // for what, where it is one of the few with which `list methods` begins; else empty
  std::string take{};     // when to take it
  std::string avoid{};    // when not, and what is better then
};

/// The option that stands for the accuracy of a step, in every family that has one.
inline constexpr const char* tolerance_option = "tolerance";
/// The option that asks for measures of each step, in every family that has it.
inline constexpr const char* diagnostics_option = "diagnostics";

inline constexpr int unlimited_digits = std::numeric_limits<int>::max();

/// What a scenario can take of the advice that a method gives after a step that did not converge.
struct UsableAdvice {
  bool newton = true;                // method.iteration = "newton": a matrix is made for so many unknowns
  bool halving = true;               // method.on_divergence = "halve": no step has to be differentiated
  std::string without_quadrature{};  // a method that evaluates no quadrature; empty: none takes the problem
};

struct MethodFamily {
  std::string name;
  std::string meaning{};             // of the whole family, for the headings of lists
  std::vector<std::string> methods;  // their names
  std::vector<OptionInfo> options;   // the keys of [method] beside `name`
  /// Them read, as the type that the family's recipe is made of: nothing but this is compiled where recipes are
  /// visited.
  std::function<std::any(const Texts& options)> read{};
  int rank = 0;                              // in lists: 0 by order and cost, then 1, 2, ...
  std::string not_on_lattice;                // why it is no bijection of the lattice; empty: it is one
  std::vector<std::string> representatives;  // the forms that `verify --all` measures; none: each method as it is
  bool counts_forces = true;                 // its work is counted in evaluations of a force, or of a gradient

  /// Each of these takes the number of the method in `methods`.
  std::function<MethodInfo(std::size_t method, const Texts& options)> describe;
  /// What H has to be, in words: "a separable H = T(p) + V(q)".
  std::function<std::string(std::size_t method)> needs;
  std::function<MethodAdvice(std::size_t method)> advice;
  /// The decimal digits beyond which its coefficients would cap its order.
  std::function<int(std::size_t method)> digits;
  /// The option to blame, and what is wrong with options that do not go together: "found ...; allowed ...".
  std::function<std::pair<std::string, std::string>(const Texts& options)> refused;
  /// What a user can try after a step that did not converge.
  std::function<std::string(const Texts& options, const UsableAdvice& usable)> hint;
  /// The options with those that follow from an arithmetic of so many decimal digits; 0: double or less.
  std::function<Texts(const Texts& options, int digits)> completed;
  /// The options with which its order is measured: fixed steps, and an order that halving the step can show.
  std::function<Texts(const Texts& options)> measurable;
};

/// One name of the closed list of methods.
struct MethodEntry {
  std::string name;
  const MethodFamily* family = nullptr;
  std::size_t index = 0;  // in family->methods
};

}  // namespace hamflow
