// The JSON keys of a summary, in the order in which they are written.
#include "json_text.hpp"
#include "measures/measure.hpp"
#include "summary.hpp"
#include "summary_fields.hpp"

namespace hamflow {

template <class Ar>
void fields(Ar& ar, LatticeUnits& x) {
  ar("position", x.position, "momentum", x.momentum);
}

template <class Ar>
void fields(Ar& ar, EnergySummary& x) {
  ar("initial", x.initial, "final", x.final, "max_error", x.max_error, "scale", x.scale, "max_relative_error",
     x.max_relative_error);
  ar.if_any("of", x.of);
}

template <class Ar>
void fields(Ar& ar, HamiltonianSummary& x) {
  ar("initial", x.initial, "final", x.final);
}

template <class Ar>
void fields(Ar& ar, ConstraintResiduals& x) {
  ar("position", x.position, "velocity", x.velocity);
}

template <class Ar>
void fields(Ar& ar, DiagnosticRange& x) {
  ar("min", x.min, "t_min", x.t_min, "max", x.max, "t_max", x.t_max);
}

template <class Ar>
void fields(Ar& ar, DiagnosticsSummary& x) {
  ar("condition_tangent", x.condition_tangent, "determinant_tangent", x.determinant_tangent, "condition_inverse_mass",
     x.condition_inverse_mass);
}

template <class Ar>
void fields(Ar& ar, Body& x) {
  ar("mass", x.mass);
  for (auto& [key, vector] : {std::pair{"position", &x.position}, std::pair{"velocity", &x.velocity}}) {
    std::vector<double> numbers(vector->begin(), vector->end());
    if constexpr (Ar::reading) numbers.clear();
    ar(key, numbers);
    if constexpr (Ar::reading) std::copy_n(numbers.begin(), std::min(numbers.size(), vector->size()), vector->begin());
  }
}

template <class Ar>
void fields(Ar& ar, OrbitSummary& x) {
  ar("type", x.type);
  ar.text_or_null("conic", x.conic);
  ar("r_min", x.r_min, "r_max", x.r_max, "circular_radius", x.circular_radius, "circular_stable", x.circular_stable,
     "apsidal_angle", x.apsidal_angle, "radial_period", x.radial_period, "closed", x.closed, "revolutions",
     x.revolutions, "radial_periods", x.radial_periods, "falls_into_centre", x.falls_into_centre);
  ar.if_any("uncertainty", x.uncertainty);
}

template <class Ar>
void fields(Ar& ar, ExactSummary& x) {
  ar("q", x.q, "p", x.p, "max_difference", x.max_difference, "relative_difference", x.relative_difference,
     "differences", x.differences);
  ar.if_any("uncertainty", x.uncertainty);
}

template <class Ar>
void fields(Ar& ar, Effort& x) {
  ar("force", x.force, "gradient", x.gradient, "hessian", x.hessian, "linear_solves", x.linear_solves);
}

template <class Ar>
void fields(Ar& ar, NewtonSummary& x) {
  ar("min", x.min, "mean", x.mean, "max", x.max, "stagnated", x.stagnated);
  ar.if_any("iteration", x.iteration);
}

template <class Ar>
void fields(Ar& ar, MomentumMap& x) {
  ar("max_error", x.max_error, "relative", x.relative, "rounding", x.rounding);
  const std::optional<bool> conserved = x.conserved();
  std::string verdict = !x.rounding ? "" : !conserved ? "undecided" : *conserved ? "to rounding" : "not";
  ar.text_or_null("conserved", verdict);
  // An infinite bound gives the verdict "undecided" for every error.
  if (Ar::reading && verdict == "undecided") x.doubtful = std::numeric_limits<double>::infinity();
}

template <class Ar>
void fields(Ar& ar, ReversalEvidence& x) {
  ar("steps", x.steps, "share", x.share, "bounces", x.bounces, "distance", x.distance, "relative", x.relative,
     "bit_exact", x.bit_exact);
  std::string proves(name(x.proves));
  ar("proves", proves);
  for (const ReversalProof proof :
       {ReversalProof::every_bit, ReversalProof::to_rounding, ReversalProof::not_reversible, ReversalProof::nothing}) {
    if (Ar::reading && name(proof) == proves) x.proves = proof;
  }
  ar("reason", x.reason);
}

template <class Ar>
void fields(Ar& ar, RunCertificate& x) {
  RunDrift& d = x.drift;
  const bool measured = d.blocks >= RunDrift::fewest_blocks;
  const auto if_measured = [&](const char* key, auto& number) {
    std::optional<LongNumber> known;
    if (!Ar::reading && measured) known = number;
    ar(key, known);
    if (Ar::reading && known) number = *known;
  };
  std::string drift(d.drift ? name(*d.drift) : "undecided");
  ar("drift", drift);
  for (const DriftClass one : {DriftClass::bounded, DriftClass::random_walk, DriftClass::linear}) {
    if (Ar::reading && name(one) == drift) d.drift = one;
  }
  ar("reason", d.reason);
  if_measured("p_value", d.p_value);
  if_measured("sign_p_value", d.sign_p_value);
  if_measured("growth_exponent", d.growth_exponent);
  if_measured("growth_uncertainty", d.growth_uncertainty);
  if_measured("mean_increment", x.mean_increment);
  if_measured("mean_increment_error", x.mean_increment_error);
  if_measured("trend_not_excluded", x.trend_not_excluded);
  ar("blocks", d.blocks, "periods", d.periods, "energy_level", x.energy_level);
  ar.by_name("momentum_maps", x.momentum_maps);
  ar("reversal_distance", x.reversal);
}

template <class Ar>
void fields(Ar& ar, SessionChange& x) {
  ar("step", x.step, "t", x.time, "what", x.what);
}

template <class Ar>
void fields(Ar& ar, Summary& x) {
  ar("status", x.status, "problem", x.problem, "method", x.method, "arithmetic", x.arithmetic);
  ar.if_any("lattice", x.lattice);
  ar("parameters", x.parameters, "dt", x.dt, "steps", x.steps);
  ar.if_any("start", x.start);
  ar("final", x.final, "energy", x.energy);
  ar.if_any("hamiltonian", x.hamiltonian);
  ar.by_name("invariants", x.invariants);
  ar.if_any("constraints", x.constraints);
  ar.if_any("diagnostics", x.diagnostics);
  ar.if_any("bodies", x.bodies);
  ar.if_any("elements", x.elements);
  ar.if_any("orbit", x.orbit);
  ar.if_any("exact", x.exact);
  ar("evaluations", x.effort, "newton", x.newton, "events", x.events);
  for (const MeasureKind& kind : measure_kinds()) {
    if constexpr (Ar::reading) {
      kind.read(ar, x);
    } else {
      kind.write(ar, x);
    }
  }
  ar("warnings", x.warnings, "certificate", x.certificate, "wall_seconds", x.wall_seconds, "steps_per_second",
     x.steps_per_second);
  ar.if_any("error", x.error);
  ar.if_any("changes", x.changes);
}

std::string summary_json(const Summary& summary) { return json_text(JsonWriter::written(summary)); }

Summary read_summary(const std::string& json) {
  Summary all;
  JsonReader::read(read_json(json), all);
  // JSON writes NaN as null, so a missing relative error may have been NaN.
  EnergySummary& energy = all.energy;
  if (energy.scale && std::isnan(energy.max_error.value)) {
    energy.max_relative_error = energy.max_relative_error.value_or(energy.max_error);
  }
  return all;
}

}  // namespace hamflow
