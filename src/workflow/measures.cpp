#include "measures.hpp"

#include "hamflow/problems/henon_heiles.hpp"
#include "hamflow/run/splitting_named.hpp"
#include "hamflow/verify/lyapunov_of.hpp"
#include "run_keys.hpp"

namespace hamflow {

namespace {

using Json = nlohmann::ordered_json;

std::shared_ptr<const StepMap> step_map_of(const Scenario& scenario) {
  return scenario.problem->step_map(scenario.request.parameters, scenario.request.method, scenario.start_q.size());
}

/// The problem whose chaos is mapped most, by a kernel of its own: a quarter of the time that a StepMap takes.
std::optional<double> exponent_of_henon_heiles(const Scenario& scenario) {
  if (scenario.request.problem != "henon-heiles") return std::nullopt;
  const std::optional<AnySplitting> method = splitting_named(scenario.request.method.name);
  if (!method) return std::nullopt;
  const HenonHeiles<double> problem{Parameters<double>(scenario.request.parameters)};
  const std::vector<double>& q = scenario.start_q;
  const std::vector<double>& p = scenario.start_p;
  return largest_lyapunov(problem, TableRecipe<Shape::any>{*method}, {q[0], q[1]}, {p[0], p[1]}, scenario.dt,
                          scenario.steps);
}

Json as_json(const LyapunovWatch& watch) {
  const LyapunovSpectrum found = watch.spectrum();
  Json all{{"exponents", found.exponents},
           {"standard_errors", found.standard_errors},
           {"pair_sums", found.pair_sums},
           {"time", found.time},
           {"renormalisations", found.renormalisations}};
  if (!watch.followed()) all["stopped_at_step"] = watch.step();
  return all;
}

Json as_json(const MonodromyWatch& watch) {
  Json all;
  try {
    if (!watch.followed()) throw Error("a step could not be differentiated");
    const SymplecticEigenvalues found = symplectic_eigenvalues(watch.rows());
    all["values"] = Json::array();
    for (const auto& value : found.values) all["values"].push_back({value.real(), value.imag()});
    all["pair_defect"] = found.pair_defect;
    all["symplectic_defect"] = found.symplectic_defect;
    all["norm"] = found.norm;
  } catch (const Error& error) {  // chaos overflows in the end: the run itself is none the worse
    all = {{"values", nullptr}, {"message", error.what()}};
  }
  all["steps"] = watch.step();
  return all;
}

}  // namespace

Measures::Measures(const Scenario& scenario, const Simulation& simulation, Recorder* recorder) {
  if (scenario.lyapunov > 0) {
    lyapunov_.emplace(step_map_of(scenario), scenario.dt, scenario.steps, scenario.lyapunov);
  }
  if (scenario.eigenvalues) product_.emplace(step_map_of(scenario), scenario.dt, scenario.steps);
  if (scenario.section) {
    section_.emplace(simulation, *scenario.section, [recorder](const SectionPoint& point) {
      if (recorder != nullptr) recorder->append(point);
    });
  }
}

std::vector<Observer*> Measures::observers() {
  std::vector<Observer*> all;
  if (lyapunov_) all.push_back(&*lyapunov_);
  if (product_) all.push_back(&*product_);
  if (section_) all.push_back(&*section_);
  return all;
}

nlohmann::ordered_json Measures::summary() const {
  Json all = Json::object();
  if (lyapunov_) all["lyapunov"] = as_json(*lyapunov_);
  if (product_) all["eigenvalues"] = as_json(*product_);
  if (section_) {
    all["section"] = {{"points", section_->points()}, {"max_residual", section_->max_residual()}};
    if (section_->failed()) all["section"]["message"] = "a partial step failed: no points after it were sought";
  }
  return all;
}

std::vector<Complaint> refused_resumption(const Scenario& scenario) {
  std::vector<Complaint> all;
  const auto complain = [&](const std::string& key) {
    const auto found = scenario.settings.find(key);
    const Setting where = found == scenario.settings.end() ? Setting{{}, 1, 1} : found->second;
    all.push_back({scenario.file, where.line, where.column, key,
                   "found with --resume; allowed in a run from its start: what it has seen is not in the checkpoint; "
                   "give --out another folder, or --force to begin anew"});
  };
  if (scenario.lyapunov > 0) complain(run_path(run_keys().lyapunov));
  if (scenario.eigenvalues) complain(run_path(run_keys().eigenvalues));
  if (scenario.section) complain(run_path(run_keys().section));
  return all;
}

std::vector<double> exponents_of(const Scenario& scenario) {
  if (scenario.lyapunov == 1) {
    if (const auto typed = exponent_of_henon_heiles(scenario)) return {*typed};
  }
  const auto map = step_map_of(scenario);
  State<double> z = scenario.start_q;
  z.insert(z.end(), scenario.start_p.begin(), scenario.start_p.end());
  if (scenario.lyapunov == 1) return {largest_lyapunov(*map, z, scenario.dt, scenario.steps)};
  try {
    return lyapunov_spectrum(*map, z, scenario.dt, scenario.steps, scenario.lyapunov).exponents;
  } catch (const Error&) {  // its status tells
    return std::vector<double>(scenario.lyapunov, std::numeric_limits<double>::quiet_NaN());
  }
}

}  // namespace hamflow
