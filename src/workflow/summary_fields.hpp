// JSON keys that summaries of runs, sweeps and reversals share.
#pragma once

#include "hamflow/workflow/summary.hpp"
#include "json_fields.hpp"

namespace hamflow {

template <class Ar>
void fields(Ar& ar, Warning& x) {
  ar("kind", x.kind, "message", x.message);
}

template <class Ar>
void fields(Ar& ar, RunError& x) {
  ar("kind", x.kind, "step", x.step, "t", x.t, "message", x.message, "hint", x.hint);
  ar.if_any("details", x.details);
}

template <class Ar>
void fields(Ar& ar, StateSummary& x) {
  if constexpr (Ar::reading) x.is_large = ar.has("dataset");
  if (x.is_large) return ar.text_or_null("dataset", x.dataset);
  ar.numbers("q", x.q, x.digits.q);
  ar.numbers("p", x.p, x.digits.p);
}

template <class Ar>
void fields(Ar& ar, StateAtTime& x) {
  ar.number("t", x.t, x.digits.time);
  fields(ar, static_cast<StateSummary&>(x));
}

template <class Ar>
void fields(Ar& ar, StopSummary& x) {
  ar("event", x.event);
  fields(ar, static_cast<StateAtTime&>(x));
}

template <class Ar>
void fields(Ar& ar, SectionSummary& x) {
  ar("points", x.points, "max_residual", x.max_residual);
  ar.if_any("message", x.message);
}

template <class Ar>
void fields(Ar& ar, ObservableSummary& x) {
  ar("initial", x.initial, "mean", x.mean, "final", x.final);
}

template <class Ar>
void fields(Ar& ar, InvariantSummary& x) {
  const auto numbers = [&](const char* key, std::vector<double>& values, std::vector<std::string>& digits) {
    if constexpr (Ar::reading) {
      x.is_list = ar.is_list(key);
      ar.numbers(key, values, digits);
    } else if (x.is_list) {
      ar.numbers(key, values, digits);
    } else {
      ar.number(key, values.at(0), digits.empty() ? std::string() : digits.at(0));
    }
  };
  numbers("initial", x.seen.initial, x.seen.initial_digits);
  numbers("final", x.seen.final, x.seen.final_digits);
  std::optional<LongNumber> most = x.max_error();
  ar("max_error", most);
  if constexpr (Ar::reading) {
    x.seen.max_error = most.value_or(0.0).value;
    x.seen.max_error_digits = most.value_or(0.0).text;
  }
}

}  // namespace hamflow
