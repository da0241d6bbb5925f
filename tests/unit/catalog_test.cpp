// Names to types: the catalogue, what it refuses and how it says so.
#include "hamflow/run/catalog.hpp"

#include <algorithm>
#include <filesystem>
#include <set>

#include "../support/near.hpp"
#include "hamflow/detail/run/splitting_named.hpp"
#include "hamflow/run/gas.hpp"
#include "hamflow/run/socket.hpp"
#include "hamflow/run/state_names.hpp"

namespace hamflow {
namespace {

std::set<std::string> files_of(const std::string& folder) {
  std::set<std::string> names;
  for (const auto& file : std::filesystem::directory_iterator(std::string(HAMFLOW_INCLUDE) + "/hamflow/" + folder)) {
    if (!file.is_regular_file()) continue;
    std::string name = file.path().stem().string();
    std::replace(name.begin(), name.end(), '_', '-');
    names.insert(name);
  }
  return names;
}

TEST(Catalog, MethodsAreTheFilesOfTheFolders) {
  std::set<std::string> expected;  // of families without tables, what they declare
  for (const MethodFamily& family : method_families()) {
    if (family.rank > 0) expected.insert(family.methods.begin(), family.methods.end());
  }
  EXPECT_TRUE(expected.contains("cg") && expected.contains("boris"));
  for (const std::string& name : files_of("methods/compositions")) {
    expected.insert(name);
    expected.insert(name + "-dkd");
  }
  for (const char* folder : {"methods/splittings", "methods/tableaus", "methods/force_gradient"}) {
    expected.merge(files_of(folder));
  }
  std::set<std::string> found;
  for (const MethodEntry& entry : methods()) EXPECT_TRUE(found.insert(entry.name).second) << entry.name << " twice";
  EXPECT_EQ(found, expected);
}

TEST(Catalog, ProblemsAreTheFilesOfTheFolders) {
  std::set<std::string> found;
  std::set<std::string> potentials;
  for (const ProblemEntry& entry : problems()) {
    if (entry.info.name == "central-force") {
      for (const auto& [key, value] : entry.info.variant) {
        if (key == "potential") potentials.insert(value);
      }
    } else if (entry.info.name != "formula" && entry.info.name != GasKeys::problem &&
               entry.info.name != SocketKeys::problem && entry.constraint_form.empty()) {  // texts, not files
      std::string name = entry.info.name;
      for (const auto& [key, value] : entry.info.variant) {
        if (key == "planets") {
          if (value == "all") name = "whole-" + name;
        } else if (value != "generalised") {  // beside Cartesian coordinates, which are texts
          name += "-" + value;
        }
      }
      found.insert(name);
    }
  }
  std::set<std::string> files = files_of("problems");
  files.merge(files_of("problems/of_any_size"));
  EXPECT_EQ(found, files);
  EXPECT_EQ(potentials, files_of("problems/potentials"));
  std::set<std::string> pairs;
  for (const ProblemInfo& law : pair_laws()) pairs.insert(law.name);
  EXPECT_EQ(pairs, files_of("problems/pairs"));
}

TEST(Catalog, EveryEntryIsComplete) {
  for (const ProblemEntry& entry : problems()) {
    SCOPED_TRACE(entry.info.name);
    EXPECT_FALSE(entry.info.formula.empty() || entry.info.reference.empty());
    if (entry.dimension > 0) {
      EXPECT_EQ(entry.info.coordinates.size(), entry.dimension);
    }
    const bool by_velocities = !entry.info.velocities.name.empty();
    EXPECT_EQ(entry.info.default_p.size(), by_velocities ? 0 : entry.info.default_q.size());
    for (const ParameterInfo& p : entry.info.parameters) {
      EXPECT_FALSE(p.meaning.empty()) << p.name;
      if (!p.default_value.empty()) {
        EXPECT_NO_THROW((void)Parameters<double>(Texts{{p.name, p.default_value}})) << p.name;
      }
    }
  }
  for (const MethodEntry& entry : methods()) {
    const MethodInfo info = describe(parse_method(entry.name));
    SCOPED_TRACE(entry.name);
    EXPECT_FALSE(info.summary.empty() || info.reference.empty());
    EXPECT_GE(info.order, 1);
    EXPECT_TRUE(info.name == entry.name || info.name.substr(0, entry.name.size() + 1) == entry.name + "(");
  }
}

TEST(Catalog, ParsesMethodsWithTheirOptions) {
  EXPECT_EQ(parse_method("stv4").name, "stv4");
  EXPECT_EQ(parse_method(" stv4 ").name, "stv4");
  EXPECT_EQ(parse_method("cg").options, Texts{});
  EXPECT_EQ(parse_method("cg()").options, Texts{});
  EXPECT_EQ(parse_method("cg(1,5)").options, (Texts{{"degree", "1"}, {"quadrature", "5"}}));
  EXPECT_EQ(parse_method("cg(1,\"auto\")").options, (Texts{{"degree", "1"}, {"quadrature", "auto"}}));
  EXPECT_EQ(parse_method("cg( degree = 1 , quadrature = 7 )").options, (Texts{{"degree", "1"}, {"quadrature", "7"}}));
  EXPECT_EQ(parse_method("taylor(30, 1e-9)").options, (Texts{{"order", "30"}, {"tolerance", "1e-9"}}));
  EXPECT_EQ(parse_method("dop853(1e-9)").options, (Texts{{"tolerance", "1e-9"}}));
  EXPECT_EQ(describe(parse_method("taylor(order=3e1)")).order, 30);
  EXPECT_EQ(describe(parse_method("taylor(30,1e-9)")).name, "taylor(order=30,tolerance=1e-09)");
  EXPECT_EQ(split_list("verlet, cg(1,5),taylor(order=20)"),
            (std::vector<std::string>{"verlet", "cg(1,5)", "taylor(order=20)"}));
  EXPECT_EQ(describe(parse_method("cg(1,5)")).name, "cg(1,5)");
  EXPECT_EQ(describe(parse_method("cg")).name, "cg(1,auto)");
  EXPECT_EQ(describe(parse_method("cg(2,6)")).name, "cg(2,6)");
  EXPECT_EQ(describe(parse_method("gauss(4)")).name, "gauss(4)");
  EXPECT_EQ(describe(parse_method("avf(5)")).name, "avf(5)");
  EXPECT_EQ(describe(parse_method("implicit-midpoint")).name, "implicit-midpoint");
}

TEST(Catalog, ClaimsFollowTheOptions) {
  for (int k = 1; k <= 10; ++k) {
    for (const int s : {k, k + 1, 3 * k}) {
      const MethodInfo info = describe(parse_method("cg(" + std::to_string(k) + "," + std::to_string(s) + ")"));
      EXPECT_EQ(info.order, 2 * k);
      EXPECT_EQ(info.symplectic, s == k);
      EXPECT_EQ(info.energy_conserving, s == k ? Conservation::no : Conservation::up_to_quadrature);
      EXPECT_TRUE(info.symmetric && info.reversible && !info.explicit_step);
    }
    EXPECT_EQ(describe(parse_method("cg(" + std::to_string(k) + ")")).energy_conserving, Conservation::yes);
    const MethodInfo gauss = describe(parse_method("gauss(" + std::to_string(k) + ")"));
    EXPECT_TRUE(gauss.order == 2 * k && gauss.symplectic && gauss.energy_conserving == Conservation::no);
  }
  EXPECT_EQ(describe(parse_method("avf")).energy_conserving, Conservation::yes);
  EXPECT_TRUE(describe(parse_method("avf(1)")).symplectic && describe(parse_method("implicit-midpoint")).symplectic);
}

TEST(Catalog, NamesOfOneMapGiveTheSameBits) {
  const auto bits = [](const char* method) {
    Request request{.problem = "double-pendulum"};
    request.start.q = {"0.4", "-0.3"};
    request.start.p = {"0.1", "0.2"};
    request.dt = "0.01";
    request.method = parse_method(method);
    const auto run = make_simulation(request);
    EXPECT_EQ(run->advance(200), Outcome::done);
    return run->bits();
  };
  EXPECT_EQ(bits("implicit-midpoint"), bits("cg(1,1)"));
  EXPECT_EQ(bits("avf(5)"), bits("cg(1,5)"));
  EXPECT_EQ(bits("avf"), bits("cg"));
  EXPECT_EQ(bits("avf(3,iteration=simplified)"), bits("cg(1,3,iteration=simplified)"));
  EXPECT_NE(bits("cg(2,4)"), bits("cg(2,5)"));
}

TEST(Catalog, LargeSystemsTakeFixedPoints) {
  // 9 x 9 x 9 bodies on a lattice, 2187 coordinates: Newton's matrix would have 38 MB, an LU of it takes seconds.
  Request request{.problem = "n-body"};
  std::string masses = "[1";
  for (int i = 0; i < 729; ++i) {
    if (i > 0) masses += ", 1";
    for (const int x : {i % 9, i / 9 % 9, i / 81}) {
      request.start.q.push_back(std::to_string(x));
      request.start.p.push_back("0");
    }
  }
  request.parameters = {{"masses", masses + "]"}, {"gravitational_constant", "0.001"}, {"softening", "0.1"}};
  request.dt = "0.01";
  for (const char* method : {"cg(1,2)", "cg(2,3)", "gauss(2)", "cg(1,2,iteration=newton)"}) {
    request.method = parse_method(method);
    const auto run = make_simulation(request);
    EXPECT_EQ(run->advance(1), Outcome::done) << method << ": " << run->failure();
    EXPECT_EQ(run->effort().hessian, 0) << method;
  }
  request.method = parse_method("cg(1,2,diagnostics=true)");
  EXPECT_THROW((void)make_simulation(request), Error);
}

TEST(Catalog, SaysWhatIsWrongWithAMethod) {
  const auto message = [](const char* text) { return test::message_of<Error>([&] { (void)parse_method(text); }); };
  const std::string first = "'; allowed verlet, stv4, kahan-li8, rkn8-s19, cg, taylor and ";
  const std::string others =
      std::to_string(methods().size() - first_methods().size()) + " others (hamflow list methods)";
  EXPECT_EQ(message("verlett"), "found the method 'verlett" + first + others + "; did you mean verlet?");
  EXPECT_EQ(message("qqqqqqqqqqqq"), "found the method 'qqqqqqqqqqqq" + first + others);
  EXPECT_EQ(message("cg(1,5"), "found 'cg(1,5' without a closing parenthesis; allowed cg(1,5)");
  EXPECT_EQ(message("stv4(2)"),
            "stv4: found an option without a name; allowed by name: step_control=VALUE, monitor=VALUE");
  const std::string points = "; allowed a whole number from 1 to 64, or \"auto\"";
  EXPECT_EQ(message("cg(1.5)"), "cg: degree: found '1.5'; allowed a whole number from 1 to 63");
  EXPECT_EQ(message("cg(1,many)"), "cg: quadrature: found 'many'" + points);
  EXPECT_EQ(message("cg(1,aut)"), "cg: quadrature: found 'aut'" + points + "; did you mean auto?");
  EXPECT_EQ(message("cg(1,0)"), "cg: quadrature: found '0'" + points);
  EXPECT_EQ(message("cg(1,65)"), "cg: quadrature: found '65'" + points);
  EXPECT_EQ(message("cg(1,)"), "cg: quadrature: found ''" + points);
  EXPECT_EQ(message("cg(1,5,7)"),
            "cg: found more than 2 options without a name; allowed cg(degree, quadrature), the others by name: "
            "NAME=VALUE");
  EXPECT_EQ(message("cg(1,degree=1)"), "cg: degree: found twice; allowed once");
  EXPECT_EQ(message("cg(tolerance=0)"), "cg: tolerance: found '0'; allowed a positive number");
  EXPECT_EQ(message("cg(tolerance=-1)"), "cg: tolerance: found '-1'; allowed a positive number");
  EXPECT_EQ(message("cg(stages=3)"),
            "cg: found an unknown option 'stages'; allowed degree, quadrature, tolerance, criterion, max_iterations, "
            "iteration, on_divergence, diagnostics, step_control, monitor");
  EXPECT_EQ(message("cg(tol=3)").substr(0, 33), "cg: found an unknown option 'tol'");
  EXPECT_EQ(message("cg(0)"), "cg: degree: found '0'; allowed a whole number from 1 to 63");
  EXPECT_EQ(message("cg(3,2)"), "cg: quadrature: found 2; allowed at least the degree, 3, or \"auto\"");
  EXPECT_EQ(message("cg(2,iteration=fixedpoint)"),
            "cg: iteration: found 'fixedpoint'; allowed newton, simplified, fixed-point, "
            "fixed-point-or-newton; did you mean fixed-point?");
  EXPECT_EQ(message("cg(2,iteration=fixed-point,diagnostics=true)"),
            "cg: diagnostics: found true; allowed false, since a fixed-point iteration has no Jacobian");
  EXPECT_EQ(message("gauss(11)"), "gauss: stages: found '11'; allowed a whole number from 1 to 10");
  EXPECT_EQ(message("gauss(2,4)").substr(0, 48), "gauss: found more than 1 options without a name;");
  EXPECT_EQ(message("avf(0)"), "avf: quadrature: found '0'" + points);
  EXPECT_EQ(message("avf(degree=2)").substr(0, 36), "avf: found an unknown option 'degree");
  EXPECT_EQ(message("cg(criterion=sed)"), "cg: criterion: found 'sed'; allowed stagnation, seed; did you mean seed?");
  EXPECT_EQ(message("taylor(1)"), "taylor: order: found '1'; allowed a whole number from 2 to 200");
  EXPECT_EQ(message("dop853(1)"), "dop853: tolerance: found '1'; allowed a number between 0 and 1");
}

TEST(Catalog, RefusesTablesForQuadraticKineticEnergyElsewhere) {
  const auto sextic_entry = find_problem("sextic", {});
  const ProblemEntry& sextic = *sextic_entry;  // T = p^3/3 - p/2
  for (const MethodEntry& entry : methods()) {
    const auto splitting = splitting_named(entry.name);
    const bool force_gradient = entry.family->name == "force-gradient";
    if (!splitting && !force_gradient) continue;
    const bool needs_quadratic = force_gradient || splitting->nystroem();
    SCOPED_TRACE(entry.name);
    const MethodSpec spec = parse_method(entry.name);
    EXPECT_EQ(sextic.accepts(spec), !needs_quadratic);
    EXPECT_EQ(sextic.step_map({.problem = "sextic", .variant = {}, .parameters = {}, .start = {}, .method = spec}, 1) ==
                  nullptr,
              needs_quadratic);
    EXPECT_TRUE(find_problem("henon-heiles", {})->accepts(spec));
    if (!needs_quadratic) continue;
    const std::string message = refusal(spec, sextic);
    EXPECT_NE(message.find("T quadratic in p with constant mass matrix"), std::string::npos) << message;
    Request request;
    request.problem = "sextic";
    request.method = spec;
    request.start.q = {"0.6"};
    request.start.p = {"0.9"};
    EXPECT_EQ(test::message_of<Error>([&] { (void)make_simulation(request); }), message);
  }
  for (const char* name : {"mcate4", "mcate5", "sb3a-4", "sb3a-5", "calvo-sanz-serna4", "srkn6b", "srkn11b", "srkn14a",
                           "okunbor-skeel6", "rkn8-s19", "chin4a", "chin4b"}) {
    EXPECT_FALSE(sextic.accepts(parse_method(name))) << name;
  }
}

TEST(Catalog, SaysWhatIsWrongWithAProblem) {
  const auto message = [](const char* name, std::map<std::string, std::string> variant) {
    return test::message_of<Error>([&] { (void)find_problem(name, variant); });
  };
  const std::string wrong = message("pendulm", {});
  EXPECT_TRUE(wrong.starts_with("found the problem 'pendulm'; allowed double-pendulum, duffing, ")) << wrong;
  EXPECT_TRUE(wrong.ends_with("; did you mean pendulum?")) << wrong;
  EXPECT_EQ(message("central-force", {{"potential", "coulomb"}}),
            "problem 'central-force' has no variant with potential = coulomb (hamflow show central-force)");
  EXPECT_EQ(find_problem("central-force", {{"potential", "kepler"}})->info.variant.front().second, "kepler");
  EXPECT_EQ(test::message_of<Error>([] {
              (void)complete(find_problem("pendulum", {})->info, {{"weight", "1"}});
            }),
            "problem 'pendulum' has no parameter 'weight'");
  const Texts all = complete(find_problem("pendulum", {})->info, {{"length", "2"}});
  EXPECT_EQ(all.at("length"), "2");
  EXPECT_EQ(all.at("mass"), "1");
}

Request pendulum_request() {
  Request request;
  request.problem = "pendulum";
  request.start.q = {"1"};
  request.start.p = {"0.5"};
  return request;
}

TEST(Catalog, RefusesWhatCannotBeRunAndSaysWhy) {
  Request request = pendulum_request();
  request.arithmetic = "lattice";
  request.method = parse_method("rk4");
  const auto message = [&] { return test::message_of<Error>([&] { (void)make_simulation(request); }); };
  EXPECT_NE(message().find(
                "method rk4 cannot run in lattice: an explicit Runge-Kutta step is not a bijection of the lattice"),
            std::string::npos)
      << message();
  request.method = parse_method("cg");
  EXPECT_NE(message().find("an implicit step is not a bijection of the lattice"), std::string::npos) << message();
  request.arithmetic = "octuple";
  EXPECT_NE(message().find("found 'octuple'; allowed double, compensated, double-double"), std::string::npos);
  request = pendulum_request();
  request.start.q = {"1", "2"};
  EXPECT_EQ(message(), "a state of this problem has 1 number for each of q and p, not 2");
}

TEST(Catalog, MomentaFromVelocitiesAreMassTimesVelocity) {
  Request request = pendulum_request();  // p = m l^2 v
  request.parameters = {{"mass", "3"}, {"length", "2"}};
  request.start.p.clear();
  request.start.v = {"0.25"};
  Frame frame;
  make_simulation(request)->look(frame);
  EXPECT_EQ(frame.p[0], 3.0);
}

TEST(Catalog, AGeometricStartMeetsItsGeometry) {
  const auto found_entry = find_problem("central-force", {{"potential", "kepler"}});
  const ProblemEntry& entry = *found_entry;
  Request request;
  request.problem = "central-force";
  request.variant = {{"potential", "kepler"}};
  request.parameters = complete(entry.info, {{"mass", "2"}, {"k", "1"}});
  request.start = {.kind = "ellipse", .orbit = {{"r_per", "1"}, {"r_aph", "3"}}};
  const Frame frame = entry.start(request);
  EXPECT_EQ(frame.q, (std::vector<double>{1, 0}));
  EXPECT_TRUE(test::same_to_rounding(frame.p[1], std::sqrt(3.0), 2.0));  // l = sqrt(2 k mu r_per r_aph/(r_per + r_aph))
  // E = -k/(r_per + r_aph)
  EXPECT_TRUE(test::within(entry.energy(request.parameters, frame.q, frame.p), -0.25, 4 * test::epsilon));
  request.start.direction = -1;
  EXPECT_EQ(entry.start(request).p[1], -frame.p[1]);
  request.start = {.kind = "ellipse", .orbit = {{"r_per", "3"}, {"r_aph", "1"}}};
  EXPECT_EQ(test::message_of<Error>([&] { (void)entry.start(request); }),
            "problem.orbit.r_aph: the start needs r_per <= r_aph");
}

TEST(Catalog, NamesTheNumbersOfAState) {
  const auto names = [](const std::string& problem, const Texts& given, std::size_t size) {
    const auto found_entry = usual_problem(problem);
    const ProblemEntry& entry = *found_entry;
    const StateNames all = state_names(entry, complete(entry.info, given), size);
    return joined(all.q) + "; " + joined(all.p);
  };
  EXPECT_EQ(names("harmonic", {}, 1), "q; p");
  EXPECT_EQ(names("central-force", {}, 2), "x, y; p_x, p_y");
  EXPECT_EQ(names("henon-heiles", {}, 2), "q1, q2; p1, p2");
  EXPECT_EQ(names("fput", {{"n", "3"}}, 3), "q1, q2, q3; p1, p2, p3");
  EXPECT_EQ(names("n-body", {{"masses", "[1, 1]"}}, 4), "x1, y1, x2, y2; p_x1, p_y1, p_x2, p_y2");
  EXPECT_EQ(names("n-body", {{"masses", "[1]"}}, 3), "x1, y1, z1; p_x1, p_y1, p_z1");
  for (const ProblemEntry& entry : problems()) {  // a name for each number, all of them different
    Texts parameters = complete(entry.info, entry.info.region.parameters);
    const std::size_t size = entry.dimension > 0
                                 ? entry.dimension
                                 : std::max(entry.info.region.centre.size() / 2, entry.info.default_q.size());
    const StateNames all = state_names(entry, parameters, size);
    std::set<std::string> different(all.q.begin(), all.q.end());
    different.insert(all.p.begin(), all.p.end());
    EXPECT_EQ(different.size(), 2 * size) << entry.info.name;
  }
}

TEST(Catalog, KnowsWhereAProblemIsSingular) {
  const auto kepler_entry = find_problem("central-force", {{"potential", "kepler"}});
  const ProblemEntry& kepler = *kepler_entry;
  const Texts parameters = complete(kepler.info, {});
  EXPECT_FALSE(kepler.regular(parameters, {0, 0}, {1, 0}));
  EXPECT_TRUE(kepler.regular(parameters, {1, 0}, {0, 1}));
}

TEST(Catalog, AnEntrySaysWhatItsParticlesAre) {
  for (const ProblemEntry& entry : problems()) {
    EXPECT_EQ(static_cast<bool>(entry.particles), !entry.container.empty()) << entry.info.name;
  }
  const Texts edges{{"size", "[4, 2]"}, {"masses", "[1, 3]"}, {"scale", "2"}};
  const auto box = find_problem("gas", {{"pair", "lennard-jones"}, {"container", "box"}});
  const ParticleFacts in_box = box->particles(complete(box->info, edges));
  EXPECT_EQ(box->container, "box");
  EXPECT_FALSE(box->has_cutoff);
  EXPECT_EQ(in_box.space, 2u);
  EXPECT_EQ(in_box.edges, (std::vector<double>{4, 2}));
  EXPECT_EQ(in_box.masses, (std::vector<double>{1, 3}));
  EXPECT_EQ(in_box.radius, 0);
  EXPECT_EQ(in_box.repulsion, 0.5);
  const auto cut = find_problem("gas", {{"pair", "newton"}, {"cutoff_kind", "shifted"}});
  const ParticleFacts in_circle = cut->particles(complete(cut->info, {{"cutoff", "2.5"}, {"dimension", "3"}}));
  EXPECT_TRUE(cut->has_cutoff);
  EXPECT_EQ(cut->container, "circle");
  EXPECT_EQ(in_circle.space, 3u);
  EXPECT_EQ(in_circle.radius, 1.5);
  EXPECT_EQ(in_circle.repulsion, 0);
}

TEST(Catalog, EveryTypedChoiceHasAnExampleInEachChart) {
  std::set<std::pair<std::string, std::string>> wanted;
  for (const ProblemEntry& entry : problems()) {
    if (entry.info.typed_choice.empty()) continue;
    wanted.emplace(entry.info.name, choice_of(entry.info, entry.info.chart_key));
  }
  std::set<std::pair<std::string, std::string>> found;
  for (const ProblemEntry& entry : typed_examples()) {
    EXPECT_TRUE(entry.structure.has_value());
    EXPECT_FALSE(has_typed_hamiltonian(entry));
    EXPECT_FALSE(entry.info.keys.empty());
    EXPECT_EQ(choice_of(entry.info, entry.info.typed_choice), "formula");
    found.emplace(entry.info.name, choice_of(entry.info, entry.info.chart_key));
  }
  EXPECT_EQ(found, wanted);
  EXPECT_TRUE(has_typed_hamiltonian(formula_example()));
}

}  // namespace
}  // namespace hamflow
