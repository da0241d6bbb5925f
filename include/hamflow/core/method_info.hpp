// The claims of a method. tests/conformance tries to refute each claim, and `hamflow verify` prints claims beside
// measurements.
#pragma once

#include <limits>
#include <string>
#include <string_view>

namespace hamflow {

/// Whether H(Psi_h(z)) = H(z) to rounding: not in general, if the quadrature is exact, or always.
enum class Conservation { no, up_to_quadrature, yes };

constexpr std::string_view name(Conservation conservation) {
  switch (conservation) {
    case Conservation::no:
      return "no";
    case Conservation::up_to_quadrature:
      return "up to quadrature";
    case Conservation::yes:
      return "yes";
  }
  return "unknown";
}

struct MethodInfo {
  std::string name;       // canonical, e.g. "stv4", "cg(1,5)"
  std::string summary;    // one line
  std::string reference;  // work and equation
  int order = 0;
  bool explicit_step = true;
  bool symplectic = false;
  bool weakly_reversible = false;  // S Psi_-h S = Psi_h
  bool symmetric = false;          // Psi_-h o Psi_h = id
  bool reversible = false;         // S Psi_h S Psi_h = id
  Conservation energy_conserving = Conservation::no;
  int forces_per_step = 0;    // evaluations of -dV/dq per step, without repeated ones; 0: depends on the iteration
  bool own_substeps = false;  // the method divides a step into sub-steps of its own choice
  bool halves_steps = false;  // a step that does not converge is replaced by two half steps
  bool carries_copy = false;  // integrates a second copy of the state; the claims hold for both copies together
  bool varies_steps = false;  // step sizes vary, and the time is part of the state (detail/methods/step_density.hpp)
  bool diagnostics = false;   // every step is diagnosed, see StepDiagnostics
};

/// Whether dt is the length of every step.
inline bool takes_equal_steps(const MethodInfo& method) { return !method.own_substeps && !method.varies_steps; }

/// Conditioning of Newton's method in an implicit step; computed on request.   [Gross1999, figures 3.27, 3.28]
struct StepDiagnostics {
  struct Extremes {
    double least = std::numeric_limits<double>::infinity();
    double most = -std::numeric_limits<double>::infinity();
    long long step_of_least = 0;
    long long step_of_most = 0;
    void extend(double x, long long step) {
      if (x < least) {
        least = x;
        step_of_least = step;
      }
      if (x > most) {
        most = x;
        step_of_most = step;
      }
    }
    template <class Archive>
    void archive(Archive& ar) {
      ar(least, most, step_of_least, step_of_most);
    }
  };
  static constexpr double unset = std::numeric_limits<double>::quiet_NaN();  // before the first step
  double iterations = unset;                                                 // linear solves
  double residual = unset;                                                   // the last one computed
  double condition_tangent = unset;                                          // cond_inf(K_T), of the last solve
  double determinant_tangent = unset;                                        // det(K_T)
  double condition_inverse_mass = unset;                                     // cond_inf(M^-1(q)) at the end of the step
  Extremes of_condition_tangent, of_determinant_tangent, of_condition_inverse_mass;  // over every step

  void extend(long long step) {
    of_condition_tangent.extend(condition_tangent, step);
    of_determinant_tangent.extend(determinant_tangent, step);
    of_condition_inverse_mass.extend(condition_inverse_mass, step);
  }
  template <class Archive>
  void archive(Archive& ar) {
    ar(iterations, residual, condition_tangent, determinant_tangent, condition_inverse_mass, of_condition_tangent,
       of_determinant_tangent, of_condition_inverse_mass);
  }
};

/// The work of a method since it was constructed.
struct Effort {
  long long force = 0;          // evaluations of -dV/dq
  long long gradient = 0;       // evaluations of the whole gradient of H
  long long hessian = 0;        // evaluations of second derivatives
  long long linear_solves = 0;  // Newton corrections
  long long steps = 0;          // implicit steps taken
  long long solves_min = 0;     // linear solves per step
  long long solves_max = 0;
  long long stagnated = 0;  // steps accepted at rounding level although the residual is above the tolerance
  long long halved = 0;     // steps replaced by two half steps (on_divergence = "halve")

  template <class Archive>
  void archive(Archive& ar) {
    ar(force, gradient, hessian, linear_solves, steps, solves_min, solves_max, stagnated, halved);
  }
};

}  // namespace hamflow
