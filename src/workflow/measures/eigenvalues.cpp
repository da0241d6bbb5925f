// run.eigenvalues: the eigenvalues of the derivative of all steps. On a periodic orbit they are Floquet multipliers.
#include <fmt/format.h>

#include <limits>

#include "json_fields.hpp"
#include "measure.hpp"
#include "measure_list.hpp"
#include "number_text.hpp"
#include "run_keys.hpp"
#include "verify/monodromy.hpp"

namespace hamflow {

template <class Ar>
void fields(Ar& ar, EigenvalueSummary& x) {
  ar("values", x.values);
  if (x.values) {
    ar("pair_defect", x.pair_defect, "symplectic_defect", x.symplectic_defect, "norm", x.norm);
  }
  ar.if_any("message", x.message);
  ar("steps", x.steps);
}

namespace {

class EigenvalueMeasure final : public Measure {
 public:
  explicit EigenvalueMeasure(const Scenario& scenario) : watch_(step_map_of(scenario), scenario.dt, scenario.steps) {}
  Observer& observer() override { return watch_; }
  TangentObserver* tangents() override { return &watch_; }
  void add_to(Summary& summary) const override {
    EigenvalueSummary& all = summary.eigenvalues.emplace();
    all.steps = watch_.step();
    try {
      SymplecticEigenvalues found = eigenvalues();
      all.values = std::move(found.values);
      all.pair_defect = found.pair_defect;
      all.symplectic_defect = found.symplectic_defect;
      all.norm = found.norm;
    } catch (const Error& error) {  // the derivative along a long chaotic orbit overflows; the run itself is fine
      all.message = error.what();
    }
  }
  /// Returns the numbers for a sweep; NaN if the eigenvalues cannot be computed.
  std::vector<double> row() const override {
    const std::size_t n = watch_.rows().size();
    try {
      const SymplecticEigenvalues found = eigenvalues();
      std::vector<double> all;
      for (const auto& value : found.values) all.insert(all.end(), {value.real(), value.imag()});
      all.insert(all.end(), {found.pair_defect, found.symplectic_defect, found.norm});
      return all;
    } catch (const Error&) {
      return std::vector<double>(2 * n + 3, std::numeric_limits<double>::quiet_NaN());
    }
  }

 private:
  SymplecticEigenvalues eigenvalues() const {
    if (!watch_.followed()) throw Error("a step could not be differentiated");
    return symplectic_eigenvalues(watch_.rows());
  }

  MonodromyObserver watch_;
};

/// Returns the columns in the order of the summary: partners next to each other.
std::vector<std::string> columns(const Scenario& first) {
  std::vector<std::string> all;
  for (std::size_t i = 1; i <= 2 * first.start_q.size(); ++i) {
    for (const char* part : {"_re", "_im"}) all.push_back("eigenvalue" + std::to_string(i) + part);
  }
  all.insert(all.end(), {"pair_defect", "symplectic_defect", "norm"});
  for (std::size_t i = all.size() - 3; i < all.size(); ++i) all[i] = "eigenvalues_" + all[i];
  return all;
}

std::string eigenvalues_text(const EigenvalueSummary& found) {
  if (!found.values) return found.message;
  constexpr std::size_t most_shown = 6;
  std::string line;
  for (std::size_t i = 0; i < std::min(found.values->size(), most_shown); ++i) {
    const std::complex<double> value = (*found.values)[i];
    line += (i > 0 ? ", " : "") + number_text(value.real(), "{:.6g}") +
            (value.imag() != 0 ? number_text(value.imag(), "{:+.6g}") + "i" : "");
  }
  if (found.values->size() > most_shown) line += ", ...";
  return line + fmt::format("; products of pairs differ from 1 by {}, symplecticity defect {}",
                            number_text(found.pair_defect, "{:.2g}"), number_text(found.symplectic_defect, "{:.2g}"));
}

template <class Ar>
void eigenvalues_entry(Ar& ar, Summary& summary) {
  ar.if_any(run_keys().eigenvalues.name, summary.eigenvalues);
}

}  // namespace

MeasureKind measure_eigenvalues() {
  return {.key = run_keys().eigenvalues.name,
          .label = "eigenvalues",
          .requested = [](const Scenario& scenario) { return scenario.eigenvalues; },
          .make = [](const Scenario& scenario) -> std::unique_ptr<Measure> {
            return std::make_unique<EigenvalueMeasure>(scenario);
          },
          .write = eigenvalues_entry,
          .read = eigenvalues_entry,
          .text = [](const Summary& s) { return s.eigenvalues ? eigenvalues_text(*s.eigenvalues) : std::string(); },
          .columns = columns};
}

}  // namespace hamflow
