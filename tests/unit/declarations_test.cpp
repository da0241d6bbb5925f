// What problems declare of themselves is consistent and usable: examples, regions, charts, angles, momentum maps. The
// catalogue is walked, so that a problem in a new file is held to the same.
#include <algorithm>
#include <map>
#include <set>

#include "../support/near.hpp"
#include "hamflow/verify/certificate.hpp"
#include "hamflow/verify/measure.hpp"

namespace hamflow {
namespace {

std::map<std::string, std::string> variant_of(const ProblemEntry& entry) {
  return {entry.info.variant.begin(), entry.info.variant.end()};
}
std::string name_of(const ProblemEntry& entry) {
  std::string name = entry.info.name;
  for (const auto& [key, value] : entry.info.variant) name += " " + value;
  return name;
}
bool contains(const std::vector<std::string>& all, const std::string& one) {
  return std::find(all.begin(), all.end(), one) != all.end();
}

/// Empty where the catalogue accepts the start, else why not.
std::string refused(const ProblemEntry& entry, const Texts& parameters, const StartSpec& start) {
  const Texts all = entry.derived(parameters, start);
  if (const std::string why_not = entry.refused_parameters(all).second; !why_not.empty()) return why_not;
  if (start.geometric()) {
    for (const Condition& c : entry.conditions(all, start)) {
      if (!c.holds()) return c.key + ": " + c.statement;
    }
  }
  Request request;
  request.problem = entry.info.name;
  request.variant = variant_of(entry);
  request.parameters = all;
  request.start = start;
  const Frame state = entry.start(request);
  if (const StartRefusal refusal = entry.refused_start(all, state.q); !refusal.message.empty()) return refusal.message;
  return entry.regular(all, state.q, state.p) ? "" : "not regular";
}
StartSpec state_of(const std::vector<double>& z) {
  StartSpec start;
  for (std::size_t i = 0; i < z.size(); ++i) (2 * i < z.size() ? start.q : start.p).push_back(shortest(z[i]));
  return start;
}

TEST(Declarations, NameWhatThereIs) {
  std::map<std::string, std::map<std::string, std::set<std::string>>> taken;  // where a choice is left open
  for (const ProblemEntry& entry : problems()) {
    SCOPED_TRACE(name_of(entry));
    const ProblemInfo& info = entry.info;
    for (const std::string& angle : info.angles) EXPECT_TRUE(contains(info.coordinates, angle)) << angle;
    EXPECT_TRUE(info.chart_key.empty() || !choice_of(info, info.chart_key).empty());
    for (const auto* keys : {&info.default_choices, &info.example_choices}) {
      for (const std::string& key : *keys) {
        EXPECT_NE(choice_of(info, key), "") << key;
        taken[info.name][key].insert(choice_of(info, key));
      }
    }
    for (const auto& choice : info.variant) (void)taken[info.name][choice.first];
    EXPECT_NO_THROW((void)complete(info, info.region.parameters));
    EXPECT_NO_THROW((void)complete(info, info.example.parameters));
    if (entry.dimension > 0) {
      EXPECT_TRUE(info.region.centre.empty() || info.region.centre.size() == 2 * entry.dimension);
    }
    EXPECT_EQ(info.example.q.size(), info.example.p.size());
    bool has_start = info.example.start.empty();
    for (const StartInfo& start : info.starts) {
      has_start = has_start || start.kind == info.example.start;
      for (const std::string& parameter : start.derives) EXPECT_TRUE(complete(info, {}).contains(parameter));
    }
    EXPECT_TRUE(has_start) << info.example.start;
    for (const InvariantInfo& invariant : info.invariants) {
      EXPECT_TRUE(invariant.terms != Terms::centre_of_mass || entry.total_mass) << invariant.name;
    }
  }
  for (const auto& [problem, keys] : taken) {
    for (const auto& [key, values] : keys) EXPECT_EQ(values.size(), 1u) << problem << ": " << key;
  }
}

TEST(Declarations, EveryExampleIsAccepted) {
  int starts = 0;
  for (const ProblemEntry& entry : problems()) {
    SCOPED_TRACE(name_of(entry));
    const ProblemInfo& info = entry.info;
    const Region region = region_of(info.name, variant_of(entry));
    const Texts in_region = complete(info, region.parameters);
    for (std::uint64_t k = 0; k < 8; ++k) EXPECT_EQ(refused(entry, in_region, state_of(random_state(region, k))), "");
    const Texts parameters =
        complete(info, info.example.parameters.empty() ? info.region.parameters : info.example.parameters);
    if (!info.example.q.empty()) {
      std::vector<double> z = info.example.q;
      z.insert(z.end(), info.example.p.begin(), info.example.p.end());
      EXPECT_EQ(refused(entry, parameters, state_of(z)), "");
    }
    for (const StartInfo& start : info.starts) {
      SCOPED_TRACE(start.kind);
      for (const std::string& key : start.keys) EXPECT_TRUE(start.example.contains(key)) << key;
      EXPECT_EQ(start.example.size(), start.keys.size());
      const Texts& with = start.example_parameters;
      EXPECT_EQ(refused(entry, with.empty() ? parameters : complete(info, with), {start.kind, start.example}), "");
      ++starts;
    }
  }
  EXPECT_GE(starts, 35);
}

TEST(Declarations, AnOpenChoiceIsTheDeclaredOne) {
  const auto chosen = [](const char* name, const std::map<std::string, std::string>& variant) {
    return name_of(*usual_problem(name, variant));
  };
  EXPECT_EQ(chosen("central-force", {}), "central-force kepler cartesian");
  EXPECT_EQ(chosen("central-force", {{"coordinates", "polar"}}), "central-force kepler polar");
  EXPECT_EQ(chosen("central-force", {{"potential", "power"}}), "central-force power cartesian");
  EXPECT_EQ(chosen("double-pendulum", {}), "double-pendulum nonlinear absolute generalised");
  EXPECT_EQ(chosen("double-pendulum", {{"model", "linear"}}), "double-pendulum linear absolute generalised");
  EXPECT_EQ(chosen("pendulum", {}), "pendulum generalised");
  EXPECT_EQ(chosen("pendulum", {{"coordinates", "cartesian"}}), "pendulum cartesian 2 manifold");
  EXPECT_THROW((void)chosen("pendulm", {}), Error);
  EXPECT_THROW((void)chosen("central-force", {{"potential", "keplr"}}), Error);
}

TEST(Declarations, ChartsAreOneMotion) {
  int charts = 0;
  for (const ProblemEntry& entry : problems()) {
    EXPECT_EQ(static_cast<bool>(entry.to_reference), static_cast<bool>(entry.from_reference));
    if (!entry.to_reference) continue;
    SCOPED_TRACE(name_of(entry));
    ++charts;
    const ProblemEntry* reference = nullptr;
    for (const ProblemEntry& other : problems()) {
      if (other.info.name != entry.info.name || other.to_reference || other.info.chart_key.empty()) continue;
      const auto agrees = [&](const auto& choice) {  // an entry may have choices of its own, such as angles
        const std::string here = choice_of(entry.info, choice.first);
        const bool is_chart = choice.first == entry.info.chart_key || choice.first == other.info.chart_key;
        return is_chart || here.empty() || here == choice.second;
      };
      if (std::all_of(other.info.variant.begin(), other.info.variant.end(), agrees)) reference = &other;
    }
    ASSERT_NE(reference, nullptr);
    const Region region = region_of(entry.info.name, variant_of(entry));
    const Texts parameters = complete(entry.info, region.parameters);
    for (std::uint64_t k = 0; k < 8; ++k) {
      const State<double> z = random_state(region, k);
      const auto half = static_cast<std::ptrdiff_t>(z.size() / 2);
      const std::vector<double> q(z.begin(), z.begin() + half);
      const std::vector<double> p(z.begin() + half, z.end());
      const Frame there = entry.to_reference(parameters, q, p);
      const Frame back = entry.from_reference(parameters, there.q, there.p);
      // A handful of roundings of terms up to the largest coordinate.
      double size = 1;
      for (const double x : z) size = std::max(size, std::fabs(x));
      for (std::size_t i = 0; i < q.size(); ++i) {
        EXPECT_TRUE(test::within(back.q[i], q[i], 16 * test::epsilon * size));
        EXPECT_TRUE(test::within(back.p[i], p[i], 16 * test::epsilon * size));
      }
      // H is the same function of the motion; its slopes times the error of the coordinates are its own error.
      const double here = entry.energy(parameters, q, p);
      EXPECT_TRUE(test::within(reference->energy(parameters, there.q, there.p), here,
                               1024 * test::epsilon * (1 + std::fabs(here))));
      // And so are its slopes: dq/dt of the reference chart along the motion, by divided differences of the chart. The
      // error is h^2 from the differences and epsilon/h from rounding.
      const std::vector<double> rates = entry.gradient(parameters, q, p).by_p;
      const std::vector<double> reference_rates = reference->gradient(parameters, there.q, there.p).by_p;
      const double h = 1e-5;
      auto ahead = q;
      auto behind = q;
      for (std::size_t i = 0; i < q.size(); ++i) {
        ahead[i] += h * rates[i];
        behind[i] -= h * rates[i];
      }
      const Frame after = entry.to_reference(parameters, ahead, p);
      const Frame before = entry.to_reference(parameters, behind, p);
      for (std::size_t i = 0; i < reference_rates.size(); ++i) {
        EXPECT_TRUE(test::within((after.q[i] - before.q[i]) / (2 * h), reference_rates[i], 1e-8));
      }
    }
  }
  EXPECT_GE(charts, 7);
}

TEST(Declarations, PolarCoordinatesRefuseTheSameParameters) {
  for (const char* coordinates : {"cartesian", "polar"}) {
    const auto power_entry = find_problem("central-force", {{"potential", "power"}, {"coordinates", coordinates}});
    const ProblemEntry& power = *power_entry;
    EXPECT_EQ(power.refused_parameters(complete(power.info, {{"a", "[1, 2]"}, {"n", "[2]"}})).first, "n");
    EXPECT_EQ(power.refused_parameters(complete(power.info, {{"a", "1"}, {"n", "-1"}})).first, "n");
    EXPECT_EQ(power.refused_parameters(complete(power.info, {{"a", "1"}, {"n", "2"}})).second, "");
  }
}

/// By the terms that are declared: a problem under another name, with invariants of other names, is judged alike.
TEST(Declarations, MomentumMapsAreJudgedByTheirTerms) {
  const Region region = region_of("n-body");
  Request request;
  request.problem = region.problem;
  request.parameters = region.parameters;
  request.method = parse_method("stv4");
  request.dt = "0.02";
  request.start = state_of(region.centre);
  const auto simulation = make_simulation(request);
  EnergyBlocks blocks;
  Observer* const observers[] = {&blocks};
  ASSERT_EQ(run(*simulation, 1000, observers), Outcome::done);
  const auto& magnitudes = blocks.state().magnitudes;
  ProblemEntry problem = *find_problem("n-body", {});
  const std::vector<MomentumMap> shipped = momentum_maps(*simulation, problem, magnitudes, request);
  ASSERT_EQ(shipped.size(), 3u);
  for (const MomentumMap& map : shipped) EXPECT_EQ(map.conserved(), true) << map.name;

  problem.info.name = "mine";
  for (InvariantInfo& invariant : problem.info.invariants) invariant.name += "-of-mine";
  const std::vector<MomentumMap> mine = momentum_maps(*simulation, problem, magnitudes, request);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(mine[i].rounding, shipped[i].rounding);
    EXPECT_EQ(mine[i].name, shipped[i].name + "-of-mine");
  }
  for (InvariantInfo& invariant : problem.info.invariants) invariant.terms = Terms::other;
  for (const MomentumMap& map : momentum_maps(*simulation, problem, magnitudes, request)) {
    EXPECT_EQ(map.conserved(), true) << map.name;  // by how a rounding of each coordinate moves it
  }
}

}  // namespace
}  // namespace hamflow
