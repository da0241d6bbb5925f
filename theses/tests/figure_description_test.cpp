// What a figure says to those who do not see it.
#include "figure_description.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hamflow::reproduction {
namespace {

using namespace figures;

Page page_with(const Curve& curve, double high = 2) {
  Panel panel;
  panel.x = plain_axis(-2, 2, {});
  panel.y = plain_axis(-2, high, {});
  panel.series.push_back({Ink::line, "{/:Italic H}", curve});
  return {"title", {panel}};
}

TEST(FigureDescription, TellsClosedCurvesFromOpenOnes) {
  Curve circle, arc;
  for (int i = 0; i <= 64; ++i) {
    const double angle = 2 * std::numbers::pi * i / 64;
    circle.add(std::cos(angle), std::sin(angle));
    if (i <= 48) arc.add(std::cos(angle), std::sin(angle));
  }
  EXPECT_EQ(describe_curves(page_with(circle)), "H reaches from -1 to 1 in y and ends where it begins.");
  EXPECT_EQ(describe_curves(page_with(arc)), "H reaches from -1 to 1 in y, from (1, 0) to (0, -1).");
}

TEST(FigureDescription, SaysWhatTheAxisResolves) {
  const Curve level{{-1, 0, 1}, {0.25, 0.25 + 1e-9, 0.25}};
  EXPECT_EQ(describe_curves(page_with(level)), "H stays at y = 0.25, from (-1, 0.25) to (1, 0.25).");
  const Curve rising{{0, 1}, {0.123456789, 1000}};
  EXPECT_EQ(describe_curves(page_with(rising, 1200)), "H reaches from 0 to 1000 in y, from (0, 0) to (1, 1000).");
}

TEST(FigureDescription, IsSilentOnLevelsAndOnTooManyCurves) {
  Page page = page_with({{-1, 1}, {0, 1}});
  page.panels[0].series.push_back({Ink::level, "E", {{-1, 1}, {1, 1}}});
  for (int i = 0; i < 9; ++i) page.panels[0].series.push_back({Ink::line, "more", {{-1, 1}, {1, 0}}});
  const std::string text = describe_curves(page);
  EXPECT_EQ(std::count(text.begin(), text.end(), '.'), 6) << text;
  EXPECT_EQ(text.find("E "), std::string::npos) << text;
}

TEST(FigureDescription, SpeaksInSentences) {
  Page page = page_with({{-1, 1}, {0, 1}});
  page.panels[0].series[0].name = "";
  EXPECT_EQ(describe_curves(page), "The curve reaches from 0 to 1 in y, from (-1, 0) to (1, 1).");
  page.panels[0].series.push_back({Ink::line, "", {{-1, 1}, {1, 1}}});
  page.panels[0].series.push_back({Ink::marks, "turning points", {{-1, 1}, {1, 1}}, {.shape = 6}});
  const std::string text = words_of(page);
  EXPECT_NE(text.find("turning points: rings."), std::string::npos) << text;
  EXPECT_NE(text.find("Curve 2 stays at y = 1, from (-1, 1) to (1, 1)."), std::string::npos) << text;
  EXPECT_NE(text.find("Turning points stay at y = 1, from"), std::string::npos) << text;
}

TEST(FigureDescription, SaysNumbersOfLogarithmicAxes) {
  Page page = page_with({{8, 50}, {0, 1}});
  page.panels[0].x = {.low = 0.845098040014, .high = 2, .logarithmic = true};
  page.panels[0].y_label = "{/:Italic V}'({/:Italic r})";
  EXPECT_NE(words_of(page).find("effective potential V'(r), x from 7 to 100, logarithmic, y from -2 to 2;"),
            std::string::npos)
      << words_of(page);
}

}  // namespace
}  // namespace hamflow::reproduction
