// taylor has the digits that its tolerance promises, in any arithmetic: against Kepler's equation, and against the same
// motion in more digits. HAMFLOW_RANDOM_MOTIONS=200 draws so many of each kind, of up to 400 digits.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "hamflow/arithmetic/mp.hpp"
#include "hamflow/detail/run/digits.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow::test {
namespace {

constexpr int more = 20;  // digits of what is compared with

struct Drawn {
  std::mt19937 random;
  double between(double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); }
  /// Log-uniform.
  double of_size(double a, double b) { return std::exp(between(std::log(a), std::log(b))); }
};

int motions(int in_the_suite) {
  const char* const text = std::getenv("HAMFLOW_RANDOM_MOTIONS");
  return text == nullptr ? in_the_suite : std::atoi(text);
}
bool is_campaign() { return std::getenv("HAMFLOW_RANDOM_MOTIONS") != nullptr; }

int drawn_digits(Drawn& draw) { return static_cast<int>(draw.of_size(34, is_campaign() ? 400 : 80)); }
/// A sub-step costs some third power of the digits: motions in many digits are shorter.
double share_of_time(int digits) { return std::min(1.0, std::pow((is_campaign() ? 100.0 : 34.0) / digits, 2.5)); }

struct End {
  Outcome outcome = Outcome::done;
  std::string failure;
  std::vector<std::string> q, p;
  double substeps = 0;
};

std::string in_mp(int digits) { return "mp(" + std::to_string(digits) + ")"; }

End end_of(Request request, int steps, int digits) {
  request.method = parse_method("taylor");
  request.arithmetic = in_mp(digits);
  const auto simulation = make_simulation(request);
  End end;
  end.outcome = simulation->advance(steps);
  if (end.outcome != Outcome::done) {
    end.failure = simulation->failure();
    return end;
  }
  Frame frame;
  simulation->look(frame);
  end.q = frame.digits.q;
  end.p = frame.digits.p;
  end.substeps = static_cast<double>(simulation->effort().gradient) / (1 + std::log(10.0) * (digits - 4) / 2);
  return end;
}

double log10_of(const Mp& x) { return binary_logarithm(x) * std::log10(2.0); }

/// log10 of the distance of two blocks over the size of the second, both of its largest component.
double log_relative(const std::vector<std::string>& a, const std::vector<std::string>& b, int digits) {
  const MpDigits scope(digits);
  Mp distance(0);
  Mp size(0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Mp y = parse_decimal<Mp>(b[i]);
    const Mp off = abs(parse_decimal<Mp>(a[i]) - y);
    if (!(off <= distance)) distance = off;
    if (abs(y) > size) size = abs(y);
  }
  return log10_of(distance) - log10_of(size);
}

/// Every sub-step has an error of the tolerance, which may grow by a factor 10^log_growth.
double allowed(int digits, const End& end, double log_growth) {
  return 4 - digits + std::log10(std::max(1.0, end.substeps)) + std::max(0.0, log_growth) + 1;
}

/// What is refused is told in words, and only where a step is longer than so many sub-steps of the shortest length.
void expect_refused(const End& end) {
  EXPECT_EQ(end.outcome, Outcome::not_converged);
  EXPECT_NE(end.failure.find("too short to change the state"), std::string::npos) << end.failure;
}

/// e = 1 - 1e-9 is the most. The start is the pericentre; the end, by Kepler's equation, what the mean anomaly says.
void expect_ellipse(double one_minus_e, double revolutions, int steps, int digits) {
  SCOPED_TRACE("1 - e = " + shortest(one_minus_e) + ", revolutions " + shortest(revolutions) + " in " +
               std::to_string(steps) + " steps, " + in_mp(digits));
  Request request;
  request.problem = "central-force";
  request.variant = {{"potential", "kepler"}, {"coordinates", "cartesian"}};
  // r_per and the step are doubles, and a = 1.
  request.start.kind = "ellipse";
  request.start.orbit = {{"r_per", shortest(one_minus_e)}, {"r_aph", "2-" + shortest(one_minus_e)}};
  const double dt = 2 * pi_value<double>() * revolutions / steps;
  request.dt = shortest(dt);
  const End end = end_of(request, steps, digits);
  if (end.outcome != Outcome::done) {
    // The shortest sub-step, over the time of passing the pericentre.
    EXPECT_LT(std::pow(one_minus_e, 1.5) / dt, 0x1p-43);
    return expect_refused(end);
  }

  const int wide = digits + more;
  const MpDigits scope(wide);
  const Mp e = Mp(1) - parse_decimal<Mp>(shortest(one_minus_e));
  const Mp mean = Mp(steps) * parse_decimal<Mp>(request.dt);
  // E - e sin E - M is increasing and is met by bisection, in as many parts as there are bits.
  Mp below = mean - Mp(1);
  Mp above = mean + Mp(1);
  for (long bit = 0; bit < precision_in_use<Mp>(); ++bit) {
    const Mp middle = (below + above) / Mp(2);
    (middle - e * sin(middle) < mean ? below : above) = middle;
  }
  const Mp& eccentric = below;
  const Mp b = sqrt((Mp(1) - e) * (Mp(1) + e));
  const Mp r = Mp(1) - e * cos(eccentric);
  const std::vector<std::string> q{written_digits(cos(eccentric) - e), written_digits(b * sin(eccentric))};
  const std::vector<std::string> p{written_digits(-sin(eccentric) / r), written_digits(b * cos(eccentric) / r)};

  // A rounding at the pericentre, where p^2 = 2/(1 - e), changes a and with it the mean motion by 3/(1 - e), which the
  // revolutions add up and the speed at the end makes a distance.
  const double radius = static_cast<double>(r);
  const double speed = std::sqrt(2 / radius - 1);
  const double growth = std::log10(6 / one_minus_e * (1 + 2 * pi_value<double>() * revolutions));
  EXPECT_LE(log_relative(end.q, q, wide), allowed(digits, end, growth + std::log10(1 + speed / radius)));
  EXPECT_LE(log_relative(end.p, p, wide), allowed(digits, end, growth + std::log10(1 + 1 / (radius * radius * speed))));
}

/// The same in more digits; what a small difference at the start becomes is measured there.
void expect_digits(const Request& request, int steps, int digits) {
  std::string start;
  for (const auto* block : {&request.start.q, &request.start.p}) start += " (" + joined(*block, ", ") + ")";
  SCOPED_TRACE(request.problem + start + ", " + std::to_string(steps) + " steps of " + request.dt + ", " +
               in_mp(digits));
  const End end = end_of(request, steps, digits);
  if (end.outcome != Outcome::done) return expect_refused(end);
  const int wide = digits + more;
  const End right = end_of(request, steps, wide);
  Request moved = request;
  const int half = digits / 2;
  int sign = 1;
  for (auto* block : {&moved.start.q, &moved.start.p}) {
    for (std::string& x : *block) x = "(" + x + ")+" + std::to_string(sign = -sign) + "e-" + std::to_string(half);
  }
  const End other = end_of(moved, steps, wide);
  ASSERT_EQ(right.outcome, Outcome::done) << right.failure;
  ASSERT_EQ(other.outcome, Outcome::done) << other.failure;
  const double growth = half + std::max(log_relative(other.q, right.q, wide), log_relative(other.p, right.p, wide));
  EXPECT_LE(log_relative(end.q, right.q, wide), allowed(digits, end, growth));
  EXPECT_LE(log_relative(end.p, right.p, wide), allowed(digits, end, growth));
}

TEST(TaylorDigits, EllipsesMeetKeplersEquation) {
  Drawn draw{std::mt19937(40)};
  for (int i = 0; i < motions(6); ++i) {
    const double one_minus_e = draw.of_size(1e-9, 1);
    const int digits = drawn_digits(draw);
    const double revolutions = draw.between(0, is_campaign() ? 1.5 : 0.7) * share_of_time(digits);
    expect_ellipse(one_minus_e, revolutions, static_cast<int>(draw.of_size(1, 200)), digits);
  }
}

TEST(TaylorDigits, ManyDigitsNearThePericentre) {
  expect_ellipse(0.01, 0.02, 1, 100);
  expect_ellipse(1e-9, 1e-9, 1, 150);
  expect_ellipse(0.01, 1e-5, 1, 400);
}

/// p = 2 - delta turns below the upper equilibrium, and 2 + delta goes round, after a time of ln(1/delta).
TEST(TaylorDigits, PendulumsNearTheSeparatrix) {
  Drawn draw{std::mt19937(41)};
  for (int i = 0; i < motions(4); ++i) {
    Request request;
    request.problem = "pendulum";
    request.variant = {{"coordinates", "generalised"}};
    const int digits = drawn_digits(draw);
    const int exponent = static_cast<int>(draw.between(1, digits / 3.0));
    request.start = {.q = {"0"}, .p = {std::string(i % 2 == 0 ? "2+" : "2-") + "1e-" + std::to_string(exponent)}};
    const double time =
        draw.between(0.5, is_campaign() ? 2.5 : 1.2) * (2 + exponent * std::log(10.0)) * share_of_time(digits);
    const int steps = static_cast<int>(draw.of_size(1, 50));
    request.dt = shortest(time / steps);
    expect_digits(request, steps, digits);
  }
}

TEST(TaylorDigits, ThreeBodies) {
  Drawn draw{std::mt19937(42)};
  for (int i = 0; i < motions(1); ++i) {
    Request request;
    request.problem = "n-body";
    std::vector<std::string> masses;
    for (int body = 0; body < 3; ++body) masses.push_back(shortest(draw.of_size(0.01, 1)));
    request.parameters = {{"masses", "[" + joined(masses, ", ") + "]"}};
    for (int k = 0; k < 6; ++k) {
      request.start.q.push_back(shortest(draw.between(-1, 1)));
      request.start.p.push_back(
          shortest(draw.between(-0.3, 0.3) * std::atof(masses[static_cast<std::size_t>(k / 2)].c_str())));
    }
    const int steps = static_cast<int>(draw.of_size(1, 20));
    const int digits = drawn_digits(draw);
    request.dt = shortest(draw.between(0.2, is_campaign() ? 3 : 1) * share_of_time(digits) / steps);
    expect_digits(request, steps, digits);
  }
}

/// Sub-steps are multiples of 2^-50 of a step. A motion that needs shorter ones is refused, and a shorter step follows
/// it.
TEST(TaylorDigits, SubstepsTooShortForTheStepAreRefusedInWords) {
  const double r_per = 1e-9;
  const double passing = std::pow(r_per, 1.5);
  for (const int digits : {34, 60}) {
    Request request;
    request.problem = "central-force";
    request.variant = {{"potential", "kepler"}, {"coordinates", "cartesian"}};
    request.start.kind = "ellipse";
    request.start.orbit = {{"r_per", shortest(r_per)}, {"r_aph", "2-1e-9"}};
    request.dt = shortest(passing * 0x1p50);
    expect_refused(end_of(request, 1, digits));
  }
  // The first sub-steps are some multiples of 2^-50 long.
  expect_ellipse(r_per, passing * 0x1p46 / (2 * pi_value<double>()), 1, 34);
}

}  // namespace
}  // namespace hamflow::test
