// The curves, axes and texts below the figures.
#include "hamflow/figures/curves.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "figure.hpp"
#include "hamflow/figures/axis.hpp"
#include "printed.hpp"
#include "text.hpp"

namespace hamflow::figures {
namespace {

constexpr double pi = std::numbers::pi;

/// A conic of parameter 1.5 with its pericentre on the x-axis.
std::function<double(double)> conic(double eccentricity) {
  return [=](double phi) { return 1.5 / (1 + eccentricity * std::cos(phi)); };
}

FigureData on_conic(double eccentricity, double first, double last) {
  FigureData data;
  data.coordinates = {"x", "y"};
  data.q.resize(2);
  for (int k = 0; k <= 200; ++k) {
    const double phi = first + (last - first) * k / 200;
    data.t.push_back(k);
    data.q[0].push_back(conic(eccentricity)(phi) * std::cos(phi));
    data.q[1].push_back(conic(eccentricity)(phi) * std::sin(phi));
  }
  sample_polar_curve(conic(eccentricity), data);
  return data;
}

/// The largest violation of the equation of the conic, r + e x = p, and the longest chord.
struct Quality {
  double residual = 0;
  double gap = 0;
  double reach = 0;
};
Quality quality(const FigureData& data, double eccentricity) {
  Quality result;
  for (std::size_t k = 0; k < data.curve_x.size(); ++k) {
    const double r = std::hypot(data.curve_x[k], data.curve_y[k]);
    if (std::isnan(r)) continue;
    result.reach = std::max(result.reach, r);
    result.residual = std::max(result.residual, std::abs(r + eccentricity * data.curve_x[k] - 1.5) / r);
    if (k > 0 && !std::isnan(data.curve_x[k - 1])) {
      result.gap = std::max(result.gap,
                            std::hypot(data.curve_x[k] - data.curve_x[k - 1], data.curve_y[k] - data.curve_y[k - 1]));
    }
  }
  return result;
}

TEST(ExactOrbit, EllipseClosesWhenDataGoRoundIt) {
  const FigureData data = on_conic(0.5, 0, 4 * pi);
  ASSERT_GT(data.curve_x.size(), 100U);
  EXPECT_NEAR(data.curve_x.front(), data.curve_x.back(), 1e-12);
  EXPECT_NEAR(data.curve_y.front(), data.curve_y.back(), 1e-12);
  const Quality q = quality(data, 0.5);
  EXPECT_LT(q.residual, 1e-13);
  EXPECT_LT(q.gap, 0.2);
  EXPECT_NEAR(q.reach, 3, 1e-3);
}

TEST(ExactOrbit, PartOfAnEllipseStaysPart) {
  const FigureData data = on_conic(0.5, 0, pi / 2);
  EXPECT_NEAR(data.curve_x.front(), 1, 1e-12);
  EXPECT_NEAR(data.curve_x.back(), 0, 1e-12);
  EXPECT_NEAR(data.curve_y.back(), 1.5, 1e-12);
}

TEST(ExactOrbit, OpenConicsEndWithTheData) {
  for (const double eccentricity : {1.0, 2.0}) {
    const double last = eccentricity == 1 ? 3.0 : std::acos(-0.5) - 0.01;
    const FigureData data = on_conic(eccentricity, -last, last);
    ASSERT_GT(data.curve_x.size(), 50U);
    const double reach = conic(eccentricity)(last);
    const Quality q = quality(data, eccentricity);
    EXPECT_LT(q.residual, 1e-12) << eccentricity;
    EXPECT_NEAR(q.reach, reach, 0.02 * reach) << eccentricity;
    for (const double x : data.curve_x) EXPECT_FALSE(std::isnan(x)) << "one branch only";
  }
}

TEST(ExactOrbit, NumericAnglesBeyondTheAsymptoteDrawNothingThere) {
  FigureData data = on_conic(2, 0, 2);
  data.q[0].push_back(-3);  // phi = pi, where the hyperbola has no point
  data.q[1].push_back(0.001);
  data.t.push_back(201);
  sample_polar_curve(conic(2), data);
  EXPECT_LT(quality(data, 2).residual, 1e-12);
  for (std::size_t k = 0; k < data.curve_x.size(); ++k) {
    EXPECT_FALSE(std::atan2(data.curve_y[k], data.curve_x[k]) > std::acos(-0.5)) << "beyond the asymptote";
  }
}

TEST(ExactOrbit, RosetteIsDrawnOverEveryTurn) {
  FigureData data;
  data.coordinates = {"r", "phi"};
  data.q.resize(2);
  const auto r = [](double phi) { return 1 / (1 + 0.5 * std::cos(0.9 * phi)); };
  for (int k = 0; k <= 300; ++k) {
    data.t.push_back(k);
    data.q[0].push_back(r(0.1 * k));
    data.q[1].push_back(0.1 * k);
  }
  sample_polar_curve(r, data);
  EXPECT_NEAR(std::hypot(data.curve_x.back(), data.curve_y.back()), r(30), 1e-9);
  EXPECT_NEAR(data.curve_x.back(), r(30) * std::cos(30.0), 1e-9);
}

TEST(LevelCurve, CircleIsClosedAndExact) {
  const auto h = [](double q, double p) { return (q * q + p * p) / 2; };
  const Curve curve = level_curve(h, 0.5, {-1.1, 1.1}, {-1.1, 1.1});
  ASSERT_GT(curve.x.size(), 1000U);
  double leftmost = 0;
  std::size_t branches = 0;
  for (std::size_t k = 0; k < curve.x.size(); ++k) {
    if (std::isnan(curve.x[k])) {
      ++branches;
      continue;
    }
    EXPECT_NEAR(h(curve.x[k], curve.y[k]), 0.5, 1e-14);
    leftmost = std::min(leftmost, curve.x[k]);
  }
  EXPECT_EQ(branches, 1U);
  EXPECT_EQ(curve.x.front(), curve.x[curve.x.size() - 2]);
  EXPECT_NEAR(leftmost, -1, 1e-5) << "the turning point";
}

TEST(LevelCurve, TwoWellsAndThreeBranchesInP) {
  const auto branches = [](const Curve& curve) {
    return std::count_if(curve.x.begin(), curve.x.end(), [](double x) { return std::isnan(x); });
  };
  const auto wells = [](double q, double p) { return p * p / 2 + (q * q - 1) * (q * q - 1); };
  EXPECT_EQ(branches(level_curve(wells, 0.5, {-2, 2}, {-2, 2})), 2);
  EXPECT_EQ(branches(level_curve(wells, 1.5, {-2, 2}, {-2, 2})), 1);
  const auto cubic = [](double, double p) { return p * p * p - p; };
  EXPECT_EQ(branches(level_curve(cubic, 0.1, {-1, 1}, {-2, 2})), 3);
}

TEST(LevelCurve, APoleIsNoCurve) {
  const auto h = [](double q, double p) { return p * p / 2 - 1 / q; };
  const Curve curve = level_curve(h, -1, {-1, 2}, {-3, 3});
  for (std::size_t k = 0; k < curve.x.size(); ++k) {
    if (std::isnan(curve.x[k])) continue;
    EXPECT_NEAR(h(curve.x[k], curve.y[k]), -1, 1e-9);
  }
}

TEST(Thinning, KeepsEveryPlaceOfAnOrbit) {
  Curve orbit;  // 100 samples a turn: every 50th shows two places only
  for (int k = 0; k < 10000; ++k) orbit.add(std::cos(2 * pi * k / 100), std::sin(2 * pi * k / 100));
  const Curve thin = thin_out(orbit, 200);
  ASSERT_EQ(thin.x.size(), 200U);
  std::vector<int> sector(12);
  for (std::size_t k = 0; k < thin.x.size(); ++k) {
    ++sector[static_cast<std::size_t>((std::atan2(thin.y[k], thin.x[k]) + pi) / (2 * pi) * 11.999)];
  }
  for (const int count : sector) EXPECT_GT(count, 8);
}

TEST(Thinning, EnvelopeKeepsTheExtremesOfEveryColumn) {
  Curve line;
  for (int k = 0; k < 50000; ++k) {
    if (k == 20000) line.lift();
    line.add(k, k == 33333 ? 7 : k == 44444 ? -7 : std::sin(k));
  }
  const Band band = envelope(line, 500);
  ASSERT_EQ(band.x.size(), 500U);
  EXPECT_EQ(band.high[333], 7);
  EXPECT_EQ(band.low[444], -7);
  for (std::size_t k = 0; k < band.x.size(); ++k) {
    EXPECT_NEAR(band.x[k], 100 * (static_cast<double>(k) + 0.5), 1);
    EXPECT_NEAR(band.low[k], k == 444 ? -7 : -1, 0.01) << "a fixed stride would show a slow beat";
    EXPECT_NEAR(band.high[k], k == 333 ? 7 : 1, 0.01);
  }
}

TEST(Thinning, EnvelopeOfUnevenTimesHasNoEmptyColumns) {
  Curve line;
  for (int k = 0; k < 5000; ++k) line.add(k < 100 ? 0.5 * k : 50 + 0.01 * k, k);
  const Band band = envelope(line, 400);
  EXPECT_TRUE(std::is_sorted(band.x.begin(), band.x.end()));
  for (std::size_t k = 0; k < band.x.size(); ++k) EXPECT_LE(band.low[k], band.high[k]);
  EXPECT_TRUE(envelope({{1, 1}, {2, 3}}, 10).x.empty());
}

TEST(Axis, LabelsStayReadable) {
  const Axis rounding = fit_axis({-1e-15, 1e-15}, 0, {6});
  EXPECT_EQ(rounding.exponent, -15);
  EXPECT_EQ(rounding.ticks().front().label, "\u22121.0");
  EXPECT_EQ(rounding.ticks().back().label, "1.0");
  const Axis huge = fit_axis({-1.7e308, 1.7e308}, 0.05, {6});
  EXPECT_EQ(huge.exponent, 308);
  EXPECT_NEAR(huge.high, 1.87, 1e-9);
  for (const Extent extent :
       {Extent{0, 0}, Extent{5.25, 5.25}, Extent{1e6, 1e6 + 1e-3}, Extent{-3e-320, 0}, Extent{}}) {
    const Axis axis = fit_axis(extent, 0.05, {6});
    EXPECT_LT(axis.low, axis.high);
    EXPECT_GE(axis.ticks().size(), 2U);
    EXPECT_LE(axis.ticks().size(), 6U);
    EXPECT_LE(axis.widest_label(), 8U);
  }
}

TEST(Text, GnuplotSeesNoCode) {
  EXPECT_EQ(quoted("it's"), "'it''s'");
  EXPECT_EQ(quoted("a\nb\x80"), "'a b\uFFFD'");
  EXPECT_EQ(quoted("`ls` $x \"y\" é"), "'`ls` $x \"y\" é'");
  EXPECT_EQ(escaped("a_b^{c}@&~\\"), "a\\_b\\^\\{c\\}\\@\\&\\~\\\\");
}

TEST(Text, Symbols) {
  EXPECT_EQ(symbol("q1"), "{/:Italic q}_{1}");
  EXPECT_EQ(symbol("phi_2"), "{/:Italic φ}_{2}");
  EXPECT_EQ(symbol("angle"), "angle");
  EXPECT_EQ(symbol("a{b}"), "a\\{b\\}");
  EXPECT_EQ(symbol("p"), "{/:Italic p}");
  EXPECT_EQ(symbol("p12"), "{/:Italic p}_{12}");
  EXPECT_EQ(symbol("p_x3"), "{/:Italic p}_{x3}");
  EXPECT_EQ(symbol("p_phi"), "{/:Italic p}_{φ}");
  EXPECT_EQ(symbol("x[1]"), "{/:Italic x}_{1}");
  EXPECT_EQ(symbol("p_x[12]"), "{/:Italic p}_{x12}");
  EXPECT_EQ(symbol("x[n]"), "x[n]");
  EXPECT_EQ(symbol("p_theta_1"), "{/:Italic p}_{θ1}");
  EXPECT_EQ(symbol("Z_long_name"), "Z\\_long\\_name");
  EXPECT_EQ(quantity("L_z"), "{/:Italic L}_{z}");
  EXPECT_EQ(quantity("kin_1"), "kin_{1}");
  EXPECT_EQ(quantity("angular_momentum"), "angular momentum");
  EXPECT_EQ(short_number(2.2e-16), "2.2·10^{\u221216}");
}

TEST(Text, LongTextsAreCutWhereTheyDiffer) {
  using Texts = std::vector<std::string>;
  EXPECT_EQ(shortened({"verlet", "stv4"}, 8), (Texts{"verlet", "stv4"}));
  EXPECT_EQ(shortened({"abcdefghijkl", "xbcdefghijkl", "short"}, 8), (Texts{"abcdefg…", "xbcdefg…", "short"}));
  EXPECT_EQ(shortened({"aaaaaaaaaaaaab", "aaaaaaaaaaaaac"}, 8), (Texts{"…aaaaaab", "…aaaaaac"}));
  EXPECT_EQ(shortened({"aaaa1aaaaaaaaaaaa2", "aaaa1aaaaaaaaaaaa3", "aaaa2aaaaaaaaaaaa3"}, 8),
            (Texts{"1: aaaa1aa…", "2: aaaa1aa…", "3: aaaa2aa…"}));
}

TEST(Text, LengthsAreThoseOfPrint) {
  EXPECT_EQ(printed_length("{/:Italic p}_{φ}"), 2U);
  EXPECT_EQ(printed_length("10^{\u221215}"), 5U);
  EXPECT_EQ(printed_length(escaped("a_b^{c}")), 7U);
}

TEST(Axis, ZeroIsWrittenAsZero) {
  for (const Extent extent : {Extent{-1, 1}, Extent{0, 0.3}, Extent{-0.002, 0.001}, Extent{-1e-15, 1e-15}}) {
    std::size_t zeros = 0;
    for (const Tick& tick : fit_axis(extent, 0.05, {7, 40}).ticks()) {
      EXPECT_EQ(tick.label == "0", tick.at == 0);
      if (tick.label == "0") ++zeros;
    }
    EXPECT_EQ(zeros, 1U);
  }
}

TEST(Axis, WordsStandAtWholeNumbers) {
  const Axis axis = word_axis({"verlet", "stv4"});
  ASSERT_EQ(axis.ticks().size(), 2U);
  EXPECT_EQ(axis.ticks()[1].at, 1);
  EXPECT_EQ(axis.ticks()[1].label, "stv4");
  EXPECT_EQ(axis.widest_label(), 6U);
}

TEST(Text, LongTitlesBreakAfterCommas) {
  EXPECT_EQ(wrapped("", 20, 3).size(), 0U);
  EXPECT_EQ(wrapped("one, two three four five", 20, 3), (std::vector<std::string>{"one, two three four", "five"}));
  EXPECT_EQ(wrapped("alpha beta, gamma delta", 20, 3), (std::vector<std::string>{"alpha beta,", "gamma delta"}));
  EXPECT_EQ(wrapped(std::string(100, 'x'), 20, 2).back(), std::string(20, 'x') + "…");
  EXPECT_EQ(wrapped("n-body, stv4(step_control=reversible,monitor=distance)", 45, 3),
            (std::vector<std::string>{"n-body, stv4(step_control=reversible,", "monitor=distance)"}))
      << "no word is broken behind which a comma stands";
}

TEST(Text, EnhancedTextIsBrokenBetweenItsGroups) {
  EXPECT_EQ(wrapped_enhanced("short {/:Italic t}", 40, 3), (std::vector<std::string>{"short {/:Italic t}"}));
  const std::vector<std::string> lines =
      wrapped_enhanced("section {/:Italic x}_{1}*(1 + long\\_name)-other\\_name = 0, up", 22, 4);
  std::string all;
  for (const std::string& line : lines) {
    EXPECT_LE(printed_length(line), 22U) << line;
    EXPECT_EQ(std::count(line.begin(), line.end(), '{'), std::count(line.begin(), line.end(), '}')) << line;
    all += line;
  }
  EXPECT_EQ(printed_length(wrapped_enhanced(std::string(1000, 'x'), 20, 4).back()), 21U) << "and an ellipsis";
}

/// A panel from 0 to 1 on both axes, 68 mm wide, with pixels of 0.085 mm.
std::vector<Series> all_on_paper(Ink ink, const Curve& curve) {
  Panel panel;
  return printed(panel, {.ink = ink, .name = "", .curve = curve}, {68, 68, 0.085});
}

Series on_paper(Ink ink, const Curve& curve) { return all_on_paper(ink, curve).at(0); }

TEST(Printed, ALineHasNoMorePointsThanColumnsOfPixelsCarry) {
  Curve curve;
  for (int k = 0; k < 1000000; ++k) curve.add(k * 1e-6, 0.5 + 0.4 * std::sin(k) * std::sin(1e-5 * k));
  curve.y[777777] = 0.99;  // one sample
  const Series line = on_paper(Ink::line, curve);
  EXPECT_LE(line.curve.x.size(), 4U * 801);
  EXPECT_EQ(*std::max_element(line.curve.y.begin(), line.curve.y.end()), 0.99);
  EXPECT_EQ(line.curve.x.front(), curve.x.front());
  EXPECT_EQ(line.curve.x.back(), curve.x.back());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(on_paper(Ink::line, {{0, 0.1, 0.2, nan, 0.3, 0.4}, {0, 0.1, 0.2, nan, 0, 0}}).curve.x.size(), 5U)
      << "gaps stay, straight parts are two points";
}

TEST(Printed, DotsOnOnePlaceAreOne) {
  Curve curve;
  for (int k = 0; k < 10000; ++k) curve.add(0.1 * (k % 10), 0.5 + 1e-7 * k);
  EXPECT_LE(on_paper(Ink::fine_dots, curve).curve.x.size(), 10U * 30);
}

TEST(Printed, APathOverItselfIsDrawnOnceAndAnAreaIsTintedBelowItsFirstTurns) {
  Curve circle;
  Curve ring;
  for (int k = 0; k < 100000; ++k) {
    const double phi = 0.0628 * k;
    circle.add(0.5 + 0.3 * std::cos(phi), 0.5 + 0.3 * std::sin(phi));
    const double r = 0.3 + 0.05 * std::sin(0.617 * phi);
    ring.add(0.5 + r * std::cos(phi), 0.5 + r * std::sin(phi));
  }
  const std::vector<Series> once = all_on_paper(Ink::path, circle);
  ASSERT_EQ(once.size(), 1U);
  EXPECT_EQ(once[0].opacity, 1);
  EXPECT_LT(once[0].curve.x.size(), 2000U);
  const std::vector<Series> area = all_on_paper(Ink::path, ring);
  ASSERT_EQ(area.size(), 2U);
  EXPECT_LT(area[0].opacity, 0.5);
  EXPECT_EQ(area[1].opacity, 1);
  EXPECT_GT(area[1].curve.x.size(), 100U);
  EXPECT_LT(area[1].curve.x.size(), 5000U);
}

}  // namespace
}  // namespace hamflow::figures
