// The uncertainty that a reference states is a claim: closed forms and integrations, which share nothing, are no
// further apart than both say.
#include "hamflow/verify/reference_solution.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>

#include "engine/double_constants.hpp"
#include "hamflow/core/math.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow {
namespace {

ReferenceSolution finished(const Request& request, const std::string& t_end, std::int64_t steps = 100) {
  ReferenceRun run(request, t_end, steps);
  while (!run.finished()) run.advance();
  return run.solution();
}

/// Numbers that double holds exactly, so that a run in any arithmetic is of the same problem.
struct Case {
  std::string problem;
  std::map<std::string, std::string> variant;
  Texts parameters;
  std::vector<std::string> q;
  std::vector<std::string> p;
};

const std::vector<Case>& cases() {
  static const std::vector<Case> all{
      {"harmonic", {}, {{"omega", "1.5"}}, {"1"}, {"0.5"}},
      {"free-fall", {}, {}, {"1"}, {"0.5"}},
      {"pendulum", {{"coordinates", "generalised"}}, {}, {"1"}, {"0.5"}},
      {"pendulum", {{"coordinates", "generalised"}}, {}, {"0.25"}, {"3"}},
      {"duffing", {}, {{"alpha", "-1"}, {"beta", "1"}}, {"1.5"}, {"0.25"}},
      {"central-force",
       {{"potential", "kepler"}, {"coordinates", "cartesian"}},
       {{"k", "1"}},
       {"1", "0"},
       {"0", "1.25"}},
      {"central-force",
       {{"potential", "kepler"}, {"coordinates", "cartesian"}},
       {{"k", "1"}},
       {"1", "0"},
       {"0", "0.25"}},
      {"central-force",
       {{"potential", "kepler"}, {"coordinates", "polar"}},
       {{"k", "1"}},
       {"1", "0.5"},
       {"0.25", "1.25"}},
      {"central-force",
       {{"potential", "hooke"}, {"coordinates", "cartesian"}},
       {{"k", "1"}},
       {"1", "0.5"},
       {"-0.25", "1"}},
      {"magnetic", {}, {{"field", "[0.5, 0.25, 1]"}}, {"1", "0", "0"}, {"0", "1", "0.5"}}};
  return all;
}

TEST(ReferenceSolution, ClosedFormsAndIntegrationsAreNoFurtherApartThanTheySay) {
  int closed_forms = 0;
  for (const Case& c : cases()) {
    for (const char* t_end : {"1", "20.5", "-7.25"}) {
      SCOPED_TRACE(c.problem + " at " + t_end);
      Request request;
      request.problem = c.problem;
      request.variant = c.variant;
      request.parameters = c.parameters;
      request.start = {.q = c.q, .p = c.p};
      const ReferenceSolution closed = finished(request, t_end);
      request.arithmetic = "mp(24)";
      const ReferenceSolution integrated = finished(request, t_end);
      ASSERT_EQ(integrated.kind, "integration");
      EXPECT_LT(integrated.uncertainty.value, 1e-17);
      if (closed.kind != "closed form") continue;
      ++closed_forms;
      const ProblemInfo& info = find_problem(request)->info;
      for (std::size_t i = 0; i < closed.end.size(); ++i) {
        double difference = std::strtod(closed.digits[i].c_str(), nullptr) - integrated.end[i];
        if (i < info.coordinates.size() && info.coordinates[i] == "phi") {
          difference = std::remainder(difference, 2 * pi_value<double>());
        }
        // The other one is rounded to double here.
        const double rounding = std::numeric_limits<double>::epsilon() * std::abs(integrated.end[i]);
        EXPECT_LE(std::abs(difference), closed.uncertainty.value + integrated.uncertainty.value + rounding) << i;
      }
    }
  }
  EXPECT_EQ(closed_forms, static_cast<int>(3 * cases().size()));
}

/// The decimal that a double is, for an arithmetic with more digits.
std::string all_digits(double x) {
  char text[128];
  return {text, static_cast<std::size_t>(std::snprintf(text, sizeof text, "%.60e", x))};
}

/// A case that degenerates as `off`, a power of two, goes to 0, and the time up to which it is followed.
struct Degenerate {
  const char* name;
  std::function<Case(double off)> at;
  double t;
};

std::vector<Degenerate> degenerate_cases() {
  const auto state = [](std::initializer_list<double> x) {
    std::vector<std::string> all;
    for (const double number : x) all.push_back(all_digits(number));
    return all;
  };
  const auto central = [state](const char* potential, const Texts& parameters, std::initializer_list<double> q,
                               std::initializer_list<double> p, const char* chart = "cartesian") {
    return Case{"central-force", {{"potential", potential}, {"coordinates", chart}}, parameters, state(q), state(p)};
  };
  const auto on_axis = [state](const char* problem, const Texts& parameters, double q, double p) {
    std::map<std::string, std::string> variant;
    if (std::string(problem) == "pendulum") variant["coordinates"] = "generalised";
    return Case{problem, variant, parameters, state({q}), state({p})};
  };
  const Texts inverse_square{{"a", "-0.5"}, {"n", "-3"}};  // l^2 = -2 mu a at l = 1
  const Texts inverse_cube{{"a", "-0.5"}, {"n", "-4"}};    // the circle of l^2 = 1.5 is unstable
  const double root2 = std::sqrt(2.0);
  const double unstable = std::sqrt(1.5);
  const double pi = pi_value<double>();
  return {{"-1/r^2, slow",
           [=](double off) {
             return central("power", inverse_square, {1, 0}, {off, 1});
           },
           1},
          {"-1/r^2, bound",
           [=](double off) {
             return central("power", inverse_square, {1, 0}, {off, 1 - off});
           },
           1},
          {"-1/r^2, free",
           [=](double off) {
             return central("power", inverse_square, {1, 0}, {off, 1 + off});
           },
           1},
          {"-1/r^2, inwards",
           [=](double off) {
             return central("power", inverse_square, {1, 0}, {-off, 1 + off});
           },
           1},
          {"-1/r^2, polar",
           [=](double off) {
             return central("power", inverse_square, {1, 0}, {off, 1}, "polar");
           },
           1},
          {"-1/r^3, circle",
           [=](double off) {
             return central("power", inverse_cube, {1, 0}, {off, unstable});
           },
           2},
          {"-1/r^3, outside",
           [=](double off) {
             return central("power", inverse_cube, {1, 0}, {0, unstable + off});
           },
           2},
          {"kepler, circle",
           [=](double off) {
             return central("kepler", {}, {1, 0}, {0, 1 + off});
           },
           20},
          {"kepler, parabola",
           [=](double off) {
             return central("kepler", {}, {1, 0}, {0, root2 * (1 + off)});
           },
           20},
          {"kepler, ellipse",
           [=](double off) {
             return central("kepler", {}, {1, 0}, {0, root2 * (1 - off)});
           },
           20},
          {"kepler, line",
           [=](double off) {
             return central("kepler", {}, {1, 0}, {0, off});
           },
           1},
          {"kepler, polar line",
           [=](double off) {
             return central("kepler", {}, {1, 0.5}, {0, off}, "polar");
           },
           1},
          {"hooke, free",
           [=](double off) {
             return central("hooke", {{"k", all_digits(off)}}, {1, 0}, {0.5, 1});
           },
           9},
          {"hooke, bound",
           [=](double off) {
             return central("hooke", {{"k", all_digits(-off)}}, {1, 0}, {0.5, 1});
           },
           9},
          {"linear, circle",
           [=](double off) {
             return central("linear", {}, {1, 0}, {0, 1 + off});
           },
           20},
          {"linear, line",
           [=](double off) {
             return central("linear", {}, {1, 0}, {0.5, off});
           },
           1.75},
          {"linear, weak",
           [=](double off) {
             return central("linear", {{"k", all_digits(off)}}, {1, 0}, {0.5, 1});
           },
           9},
          {"binomial, circle",
           [=](double off) {
             return central("binomial", {}, {1, 0}, {0, off});
           },
           9},
          {"binomial, over the hill",
           [=](double off) {
             return central("binomial", {}, {1, 0}, {-1 - off, 0});
           },
           4},
          {"binomial, past the hill",
           [=](double off) {
             return central("binomial", {}, {1, 0}, {-1, off});
           },
           4},
          {"pendulum, upright", [=](double off) { return on_axis("pendulum", {}, pi, off); }, 7},
          {"pendulum, nearly over", [=](double off) { return on_axis("pendulum", {}, 0, 2 - off); }, 7},
          {"pendulum, just over", [=](double off) { return on_axis("pendulum", {}, 0, 2 + off); }, 7},
          {"pendulum, small", [=](double off) { return on_axis("pendulum", {}, off, 0); }, 7},
          {"duffing, hill",
           [=](double off) {
             return on_axis("duffing", {{"alpha", "-1"}, {"beta", "1"}}, off, 0);
           },
           7},
          {"duffing, to the hill",
           [=](double off) {
             return on_axis("duffing", {{"alpha", "-1"}, {"beta", "1"}}, root2, off);
           },
           7},
          {"duffing, over the edge",
           [=](double off) {
             return on_axis("duffing", {{"alpha", "1"}, {"beta", "-1"}}, 1 - off, 0);
           },
           5},
          {"duffing, nearly linear",
           [=](double off) {
             return on_axis("duffing", {{"alpha", "1"}, {"beta", all_digits(off)}}, 1, 0.5);
           },
           9},
          {"duffing, softening",
           [=](double off) {
             return on_axis("duffing", {{"alpha", "1"}, {"beta", all_digits(-off)}}, 0.5, 0.25);
           },
           9},
          {"duffing, quartic",
           [=](double off) {
             return on_axis("duffing", {{"alpha", all_digits(off)}, {"beta", "1"}}, 1, 0.5);
           },
           9},
          {"harmonic, free",
           [=](double off) {
             return on_axis("harmonic", {{"omega", all_digits(off)}}, 1, 0.5);
           },
           9},
          {"free fall",
           [=](double off) {
             return on_axis("free-fall", {{"gravity", all_digits(off)}}, 1, 0.5);
           },
           9},
          {"magnetic, weak",
           [=](double off) {
             return Case{
                 "magnetic", {}, {{"field", "[0, " + all_digits(off) + ", 0]"}}, state({1, 0, 0}), state({0, 1, 0.5})};
           },
           9},
          {"double pendulum, light",
           [=](double off) {
             return Case{"double-pendulum",
                         {{"model", "linear"}, {"angles", "absolute"}, {"coordinates", "generalised"}},
                         {{"masses", "[1, " + all_digits(off) + "]"}},
                         state({0.125, -0.25}),
                         state({0.5, 0.25 * off})};
           },
           9}};
}

/// q, then p, after a time, in double-double and to some 25 digits; empty where the motion cannot be followed.
std::vector<double> integrated(const Case& c, double change, double t) {
  Request request;
  request.problem = c.problem;
  request.variant = c.variant;
  request.parameters = c.parameters;
  request.arithmetic = "double-double";
  request.method = {"taylor", {{"tolerance", "1e-25"}}};
  const auto changed = [](const std::vector<std::string>& texts, double factor) {
    std::vector<std::string> all;
    for (const std::string& text : texts) all.push_back("(" + text + ")*(1+" + all_digits(factor) + ")");
    return all;
  };
  request.start = {.q = changed(c.q, change), .p = changed(c.p, -change)};
  request.dt = shortest(t) + "*(1+" + all_digits(change) + ")";
  const DoubleConstants constants;
  const auto simulation = make_simulation(request);
  if (simulation->advance(1) != Outcome::done) return {};
  Frame frame;
  simulation->look(frame);
  std::vector<double> z = frame.q;
  z.insert(z.end(), frame.p.begin(), frame.p.end());
  return z;
}

// Every exact state is that of an integration with more digits, or there is none: close to each degenerate case too.
TEST(ReferenceSolution, ExactStatesAreRightNearDegenerateCases) {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  int tried = 0;
  int known = 0;
  for (const Degenerate& d : degenerate_cases()) {
    for (const int exponent : {2, 4, 7, 10, 14, 20, 27, 34, 40, 47}) {
      SCOPED_TRACE(std::string(d.name) + ", off by 2^-" + std::to_string(exponent));
      const Case c = d.at(std::ldexp(1.0, -exponent));
      const auto problem_entry = find_problem(c.problem, c.variant);
      const ProblemEntry& problem = *problem_entry;
      std::vector<double> q, p;
      for (const std::string& x : c.q) q.push_back(number_value(x));
      for (const std::string& x : c.p) p.push_back(number_value(x));
      ++tried;
      const auto exact = problem.exact(complete(problem.info, c.parameters), q, p, d.t);
      if (!exact) continue;
      constexpr double change = 0x1p-40;
      const std::vector<double> right = integrated(c, 0, d.t);
      const std::vector<double> moved = integrated(c, change, d.t);
      if (right.empty() || moved.empty()) continue;
      ++known;
      const std::size_t n = q.size();
      for (std::size_t i = 0; i < 2 * n; ++i) {
        const bool is_angle = i < n && problem.info.coordinates[i] == "phi";
        const std::vector<double>& own = i < n ? exact->q : exact->p;
        double size = std::abs(own[i % n]);
        for (const double x : own) size = is_angle ? size : std::max(size, std::abs(x));
        const double off = own[i % n] - right[i];
        const double apart = moved[i] - right[i];
        const double turn = 2 * pi_value<double>();
        const double of_a_rounding = std::abs(is_angle ? std::remainder(apart, turn) : apart) / change * epsilon;
        EXPECT_LE(std::abs(is_angle ? std::remainder(off, turn) : off), 2 * epsilon * size + of_a_rounding / 4)
            << "number " << i << ": " << own[i % n] << ", right is " << right[i];
      }
    }
  }
  EXPECT_GE(known, 2 * tried / 3);
}

TEST(ReferenceSolution, EveryProblemHasOneInEveryArithmetic) {
  EXPECT_EQ(reference_arithmetic("double"), "double-double");
  EXPECT_EQ(reference_arithmetic("lattice"), "double-double");
  EXPECT_EQ(reference_arithmetic("mp(12)"), "double-double");
  for (const char* arithmetic : {"double-double", "quad", "mp(50)"}) {
    EXPECT_GE(digits_beyond_double(reference_arithmetic(arithmetic)), digits_beyond_double(arithmetic) + 10);
  }
  for (const ProblemEntry& problem : problems()) {
    if (problem.info.name == "socket") continue;  // it has no forces without a client
    Request request;
    request.problem = problem.info.name;
    for (const auto& [key, value] : problem.info.variant) request.variant[key] = value;
    request.parameters = problem.info.region.parameters;
    request.start = {.q = problem.info.default_q, .p = problem.info.default_p};
    std::vector<double> centre = problem.info.region.centre;
    if (!problem.constraint_form.empty() && problem.info.walls.empty()) {  // where it is need not meet the constraints
      centre = problem.info.example.q;
      centre.insert(centre.end(), problem.info.example.p.begin(), problem.info.example.p.end());
    }
    if (!centre.empty()) request.start = {};
    for (std::size_t i = 0; i < centre.size(); ++i) {
      (i < centre.size() / 2 ? request.start.q : request.start.p).push_back(shortest(centre[i]));
    }
    SCOPED_TRACE(problem.info.name);
    const ReferenceSolution found = finished(request, shortest(20 * problem.info.region.step), 20);
    double size = 0;
    for (const double x : found.end) size = std::max(size, std::abs(x));
    EXPECT_LT(found.uncertainty.value, 1e-13 * size) << found.description;
  }
}

TEST(ReferenceSolution, AMotionThatCannotBeFollowedHasNone) {
  Request request;
  request.problem = "henon-heiles";
  request.start = {.q = {"0", "0"}, .p = {"0", "3"}};  // over the saddle: to infinity in finite time
  EXPECT_THROW((void)finished(request, "100"), Error);
}

TEST(Magnitude, BelowTheDoublesIsAText) {
  const Magnitude small("3.25e-412");
  EXPECT_EQ(small.value, 0);
  EXPECT_NEAR(small.log10, std::log10(3.25) - 412, 1e-12);
  EXPECT_EQ(readable(small, 2), "3.25e-412");
  EXPECT_EQ(Magnitude("3.25e-300").value, 3.25e-300);
  EXPECT_TRUE(Magnitude("3.25e-300").text.empty());
  EXPECT_TRUE(small < Magnitude(1e-308));
  EXPECT_TRUE(Magnitude(0.0) < small);
}

}  // namespace
}  // namespace hamflow
