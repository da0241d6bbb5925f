// The declaration of a family of methods, made in one file of src/methods/families/ (see HACKING, Adding). All other
// code gets its knowledge of methods from here.
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

/// A method by name, with the given options as texts.
struct MethodSpec {
  std::string name = "stv4";
  Texts options{};

  friend bool operator==(const MethodSpec&, const MethodSpec&) = default;
};

/// Advice for users who choose a method.
struct MethodAdvice {
  std::string purpose{};  // its use, for the few methods recommended at the top of `list methods`; else empty
  std::string take{};     // when to use it
  std::string avoid{};    // when not to use it, and a better choice
};

/// The option for the accuracy of a step, in every family that has one.
inline constexpr const char* tolerance_option = "tolerance";
/// The option for diagnostics of each step, in every family that has it.
inline constexpr const char* diagnostics_option = "diagnostics";

inline constexpr int unlimited_digits = std::numeric_limits<int>::max();

/// The parts of a method's advice after a step that did not converge that a scenario can follow.
struct UsableAdvice {
  bool newton = true;                // method.iteration = "newton": there are few enough unknowns for a matrix
  bool halving = true;               // method.on_divergence = "halve": the run does not differentiate steps
  std::string without_quadrature{};  // a method without quadrature; empty: none accepts the problem
};

struct MethodFamily {
  std::string name;
  std::string meaning{};             // of the whole family, for headings of lists
  std::vector<std::string> methods;  // their names
  std::vector<OptionInfo> options;   // the keys of [method] except `name`
  /// Reads the options into the type from which the family's recipe is made, so that code that visits recipes does not
  /// compile the reading of options.
  std::function<std::any(const Texts& options)> read{};
  int rank = 0;                // in lists: 0 by order and cost, then 1, 2, ...
  std::string not_on_lattice;  // why it is not a bijection of the lattice; empty: it is one
  std::function<bool(const Texts& options)> allowed_on_lattice{};  // with these options it is one all the same
  std::vector<std::string>
      representatives;        // the forms that `verify --all` measures; empty: each method without options
  bool counts_forces = true;  // its work is counted in evaluations of the force or of the gradient

  /// The functions below take the index of the method in `methods`.
  std::function<MethodInfo(std::size_t method, const Texts& options)> describe;
  /// The requirement on H, in words: "a separable H = T(p) + V(q)".
  std::function<std::string(std::size_t method)> needs;
  std::function<MethodAdvice(std::size_t method)> advice;
  /// The number of decimal digits of its coefficients; with more digits they would limit the order.
  std::function<int(std::size_t method)> digits;
  /// The error of options that cannot be combined: the option at fault and "found ...; allowed ...".
  std::function<std::pair<std::string, std::string>(const Texts& options)> refused;
  /// Advice after a step that did not converge.
  std::function<std::string(const Texts& options, const UsableAdvice& usable)> hint;
  /// The options, completed by defaults for an arithmetic with the given decimal digits; 0: double or less.
  std::function<Texts(const Texts& options, int digits)> completed;
  /// The options with which the order is measured: fixed steps, and an order that halving the step can show.
  std::function<Texts(const Texts& options)> measurable;
};

/// A method of the catalogue.
struct MethodEntry {
  std::string name;
  const MethodFamily* family = nullptr;
  std::size_t index = 0;  // in family->methods
};

}  // namespace hamflow
