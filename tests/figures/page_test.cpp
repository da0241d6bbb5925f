// Pages: logarithmic axes, maps and legends of their own, and the two figures that are made of them.
#include "hamflow/figures/page.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <regex>
#include <sstream>

#include "draw_style.hpp"
#include "hamflow/core/error.hpp"
#include "page_size.hpp"
#include "parameter_map.hpp"
#include "script.hpp"
#include "work_precision.hpp"

namespace hamflow::figures {
namespace {

namespace fs = std::filesystem;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

class Pages : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("hamflow_pages_" + std::to_string(std::random_device{}()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  static std::string bytes_of(const fs::path& file) {
    std::ostringstream bytes;
    bytes << std::ifstream(file, std::ios::binary).rdbuf();
    return bytes.str();
  }
  fs::path folder_;
};

TEST(LogAxis, PlacesNumbersByTheirLogarithm) {
  Extent extent;
  extent.include_positive(std::vector<double>{-1, 0, nan, 1e-3, 1e5});
  EXPECT_EQ(extent.low, 1e-3);
  const Axis axis = log_axis(extent);
  EXPECT_EQ(axis.place(1000), 3);
  EXPECT_TRUE(std::isnan(axis.place(0)));
  EXPECT_TRUE(std::isnan(axis.place(-1)));
  EXPECT_NEAR(axis.low, -3 - 0.04 * 8, 1e-14);
  EXPECT_NEAR(axis.high, 5 + 0.04 * 8, 1e-14);
}

TEST(LogAxis, TicksArePowersOfTen) {
  for (const auto& [low, high] : {std::pair{1e-16, 1e3}, {1e-3, 1e-1}, {2.0, 3.0}, {1e-300, 1e300}, {5.0, 5.0}}) {
    const Axis axis = log_axis({low, high});
    std::size_t labelled = 0;
    for (const Tick& tick : axis.ticks()) {
      EXPECT_GE(tick.at, axis.low - 1e-9);
      EXPECT_LE(tick.at, axis.high + 1e-9);
      labelled += tick.label.empty() ? 0 : 1;
      if (tick.minor) continue;
      const int power = static_cast<int>(std::lround(tick.at));
      EXPECT_EQ(tick.label, fmt::format("10^{{{}{}}}", power < 0 ? "\u2212" : "", std::abs(power)));
    }
    EXPECT_GE(labelled, 1U) << low;
    EXPECT_LE(labelled, 9U) << low;
    EXPECT_LE(axis.widest_label(), 8U) << low;
  }
}

TEST_F(Pages, GnuplotPrintsEveryLabelOfAnAxis) {
  // It prints none of a tick of level 1.
  Panel panel;
  panel.x = log_axis({0.025, 0.1});
  panel.y = plain_axis(0, 1, {7});
  panel.series.push_back({Ink::line, "", {{0.025, 0.1}, {0, 1}}});
  const std::string script = gnuplot_script({"title", {panel}}, Format::svg);
  EXPECT_NE(script.find("'5·10^{\u22122}' -1.30102999566 0"), std::string::npos) << script;
  EXPECT_NE(script.find("'' -1.39794000867 1"), std::string::npos) << script;
}

TEST_F(Pages, ATerminalStandsInEveryScriptAndCountsMillimetres) {
  Panel panel;
  panel.x = plain_axis(0, 1, {7, 40});
  panel.y = plain_axis(0, 1, {7});
  panel.series.push_back({Ink::line, "", {{0, 1}, {0, 1}}});
  for (const auto& [format, beginning] : {std::pair{Format::svg, "set terminal svg size 643,"},
                                          {Format::pdf, "set terminal pdfcairo size 17.0000cm,"},
                                          {Format::png, "set terminal pngcairo size 2008,"}}) {
    EXPECT_TRUE(gnuplot_script({"title", {panel}, 1, two_columns}, format).starts_with(beginning));
  }
}

TEST_F(Pages, FilesAreChosenByTheirExtension) {
  EXPECT_EQ(format_of("a/b.svg"), Format::svg);
  EXPECT_EQ(format_of("a/b.PDF"), Format::pdf);
  EXPECT_EQ(format_of("a/b.png"), Format::png);
  EXPECT_EQ(refused_figure_file("a.svg"), "");
  EXPECT_EQ(refused_figure_file("a.gif"), "found 'a.gif'; allowed a file .svg, .pdf or .png");
  EXPECT_THROW(format_of("a.gif"), Error);
}

/// Two methods, one with a run that failed.
WorkPrecision two_methods() {
  return {"henon-heiles",
          {{"verlet", 2, true, {100, 200, 400}, {1e-5, 2e-5, 4e-5}, {1e-2, 2.5e-3, 6e-4}, {1e-3, 2.5e-4, 6e-5}},
           {"cg(1,2)", 2, false, {300, 600, 900}, {1e-4, 2e-4, 3e-4}, {1e-2, nan, 1e-4}, {1e-15, 0, 1e-15}},
           {"stv4", 4, true, {500, 1000}, {5e-5, 1e-4}, {1e-5, 6e-7}, {1e-6, 6e-8}}},
          1e-5};
}

TEST_F(Pages, WorkPrecisionListsItsMethodsByOrder) {
  const fs::path file = folder_ / "work.svg";
  write_work_precision(two_methods(), file);
  const std::string svg = bytes_of(file);
  const auto text = [&](const std::string& words) { return svg.find(">" + words + "<"); };
  EXPECT_LT(text("order 2"), text("verlet"));
  EXPECT_LT(text("verlet"), text("cg(1,2)"));
  EXPECT_LT(text("cg(1,2)"), text("order 4"));
  EXPECT_LT(text("order 4"), text("stv4"));
  ASSERT_NE(text("stv4"), std::string::npos);
  static const std::regex level("stroke='rgb\\(170, 170, 170\\)'");
  EXPECT_EQ(std::distance(std::sregex_iterator(svg.begin(), svg.end(), level), {}), 2)
      << "the uncertainty of the reference, in the two panels of errors against it";
  for (const char* extension : {".pdf", ".png"}) {
    EXPECT_NO_THROW(write_work_precision(two_methods(), folder_ / (std::string("work") + extension)));
  }
}

TEST_F(Pages, WorkPrecisionTellsWhatItLeavesOut) {
  const auto drawn = [&](const WorkPrecision& data) {
    write_work_precision(data, folder_ / "work.svg");
    return bytes_of(folder_ / "work.svg");
  };
  EXPECT_NE(drawn(two_methods()).find("failed: cg(1,2) 1 of 3"), std::string::npos);
  EXPECT_EQ(drawn(two_methods()).find("above the axis"), std::string::npos);
  WorkPrecision large = two_methods();
  large.floor *= 1e9;
  large.size = 1e9;
  for (WorkCurve& curve : large.curves) {
    for (double& x : curve.error) x *= 1e9;
  }
  EXPECT_EQ(drawn(large).find("above the axis"), std::string::npos) << "errors are those beside the motion";
  WorkPrecision wild = two_methods();
  wild.curves[0].error = {1e60, 1e30, 1e5};  // shown with its best
  wild.curves[2].error = {1e60, 1e30};       // too far from all others
  EXPECT_NE(drawn(wild).find("errors above the axis: verlet 2 of 3, stv4 2 of 2"), std::string::npos);
}

TEST_F(Pages, AnOrderThatVariesAndALongNameAreToldInFull) {
  WorkPrecision data = two_methods();
  data.curves[1].error[1] = 1e-3;  // what failed is named below the panels too
  for (int i = 0; i < 12; ++i) {
    data.curves.push_back(data.curves[static_cast<std::size_t>(i % 3)]);
    data.curves.back().name = "taylor(tolerance=1e-06,step_control=fixed," + std::to_string(i) + ")";
    data.curves.back().order = i % 2 == 0 ? 0 : 6;
  }
  write_work_precision(data, folder_ / "work.svg");
  const std::string svg = bytes_of(folder_ / "work.svg");
  EXPECT_LT(svg.find(">order 6<"), svg.find(">order by tolerance<"));
  ASSERT_NE(svg.find(">order by tolerance<"), std::string::npos);
  EXPECT_EQ(svg.find(">order 0<"), std::string::npos);
  static const std::regex name("translate\\(([0-9.]+),[^>]*>\\s*<text[^>]*><tspan[^>]*>taylor");
  std::size_t names = 0;
  for (std::sregex_iterator it(svg.begin(), svg.end(), name), end; it != end; ++it, ++names) {
    EXPECT_LT(std::stod((*it)[1]), 0.65 * 643) << "a second column would reach over the edge";
  }
  EXPECT_EQ(names, 12U);
}

TEST_F(Pages, WorkPrecisionWithoutErrorsIsRefused) {
  WorkPrecision data = two_methods();
  for (WorkCurve& curve : data.curves) curve.error.assign(curve.error.size(), nan);
  EXPECT_THROW(write_work_precision(data, folder_ / "a.svg"), Error);
  EXPECT_THROW(write_work_precision(two_methods(), folder_ / "a.gif"), Error);
}

ParameterMap plane() {
  ParameterMap map{"kepler, stv4", "d{/:Italic t}", "r\\_aph", "max error", {}, {}, {}, {}, {}, {}};
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 5; ++k) {
      map.x.push_back(0.01 + 0.03 * i);
      map.y.push_back(2 + 0.25 * k);
      map.value.push_back(i == 1 && k == 1 ? nan : std::pow(10.0, -8 + i + 0.1 * k));
    }
  }
  map.notes = {"white: 1 of 20 members (1 wall)"};
  return map;
}

TEST_F(Pages, AMapShowsWholeFieldsAndItsColours) {
  const fs::path file = folder_ / "map.svg";
  write_parameter_map(plane(), file);
  const std::string svg = bytes_of(file);
  for (const char* text : {">r_aph<", ">max error<", ">white: 1 of 20 members (1 wall)<"}) {
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  }
  static const std::regex axis_label("<tspan[^>]*>10</tspan>|>10<");
  EXPECT_GE(std::distance(std::sregex_iterator(svg.begin(), svg.end(), axis_label), {}), 3) << "powers of ten";
  for (const char* extension : {".pdf", ".png"}) {
    EXPECT_NO_THROW(write_parameter_map(plane(), folder_ / (std::string("map") + extension)));
  }
}

TEST_F(Pages, RectanglesOfAMapReachBelowThoseDrawnLater) {
  // Between rectangles that only touch, viewers show the paper.
  ParameterMap map = plane();
  for (double& x : map.value) x = std::isnan(x) ? 1e-7 : x;
  write_parameter_map(map, folder_ / "map.svg");
  const std::string svg = bytes_of(folder_ / "map.svg");
  static const std::regex rectangle("<polygon fill = '[^']*' points = '([-0-9.]+),([-0-9.]+) ([-0-9.]+),[-0-9.]+ ");
  std::vector<std::pair<double, double>> sides;  // left and right
  for (std::sregex_iterator it(svg.begin(), svg.end(), rectangle), end; it != end; ++it) {
    sides.emplace_back(std::stod((*it)[1]), std::stod((*it)[3]));
  }
  ASSERT_GE(sides.size(), 20U);
  sides.resize(20);  // those of the map; colours follow
  for (std::size_t k = 0; k + 5 < sides.size(); ++k) {
    EXPECT_LE(sides[k].first, sides[k + 5].first);
    EXPECT_GT(sides[k].second, sides[k + 5].first + 5) << "pixels below the next column";
  }
}

TEST_F(Pages, ACurveOverOneKeyIsAPanel) {
  ParameterMap map{"kepler, stv4", "d{/:Italic t}", "", "max error", {0.1, 0.2, 0.3}, {}, {1, nan, 3}, {}, {}, {}};
  write_parameter_map(map, folder_ / "curve.svg");
  EXPECT_NE(bytes_of(folder_ / "curve.svg").find(">max error<"), std::string::npos);
  map.value = {nan, nan, nan};
  EXPECT_THROW(write_parameter_map(map, folder_ / "nothing.svg"), Error);
}

TEST_F(Pages, MeansHaveBarsOfTheirErrors) {
  figures::Panel panel;
  panel.x = figures::fit_axis({0, 1}, 0, {7});
  panel.y = figures::fit_axis({0, 10}, 0, {7});
  figures::Series series{.ink = figures::Ink::bars};
  series.curve = {{0.5}, {4}};
  series.value = {1};
  double x = 0, y = 0, low = 0, high = 0;
  std::istringstream(figures::data_lines(panel, series).at(0)) >> x >> y >> low >> high;
  EXPECT_EQ(y - low, high - y);
  EXPECT_EQ(panel.y.place(5), high);
  EXPECT_NE(figures::styles(series).at(0).find("1:2:3:4 with yerrorbars"), std::string::npos);

  // The axis has room for the bars, not for the means alone.
  ParameterMap map{"t-tube", "v", "", "mean", {1, 2, 3}, {}, {4, 5, 6}, {}, {}, {}};
  map.error = {0.1, 30, 0.1};
  write_parameter_map(map, folder_ / "mean.svg");
  EXPECT_NE(bytes_of(folder_ / "mean.svg").find("30<"), std::string::npos);
}

TEST_F(Pages, WordsAreLinesOrPlacesOfAnAxis) {
  ParameterMap map{"kepler", "d{/:Italic t}", "", "max error", {0.1, 0.2, 0.1, 0.2}, {}, {1, 2, 3, 4}, {}, {}, {}};
  map.line = {"verlet", "verlet", "stv4", "stv4"};
  write_parameter_map(map, folder_ / "lines.svg");
  for (const char* text : {">verlet<", ">stv4<"}) {
    EXPECT_NE(bytes_of(folder_ / "lines.svg").find(text), std::string::npos) << text;
  }
  map.line.clear();
  map.x = {0, 1, 2, 3};
  map.x_words = {"verlet", "stv4", "rk4", "cg"};
  write_parameter_map(map, folder_ / "words.svg");
  static const std::regex line("<path stroke='rgb\\( 31,  78, 140\\)'  d='M[^ ]* L");
  const std::string words = bytes_of(folder_ / "words.svg");
  EXPECT_FALSE(std::regex_search(words, line)) << "there is nothing between two words";
  for (const char* text : {">verlet<", ">cg<"}) {
    EXPECT_NE(bytes_of(folder_ / "words.svg").find(text), std::string::npos) << text;
  }
}

Page one_panel() {
  Panel panel;
  panel.x = plain_axis(0, 1, {7, 40});
  panel.y = plain_axis(0, 1, {7});
  panel.series.push_back({Ink::line, "", {{0, 1}, {0, 1}}});
  return {"title", {panel}};
}

TEST_F(Pages, ASizeIsMet) {
  const Page page = one_panel().with({.width = 100, .height = 50, .dpi = 254});
  EXPECT_TRUE(gnuplot_script(page, Format::png).starts_with("set terminal pngcairo size 1000,500 "));
  EXPECT_TRUE(gnuplot_script(page, Format::pdf).starts_with("set terminal pdfcairo size 10.0000cm,5.0000cm "));
  EXPECT_EQ(gnuplot_script(one_panel().with({.title = false}), Format::pdf).find("'title'"), std::string::npos);
  EXPECT_NE(gnuplot_script(one_panel(), Format::pdf).find("'title'"), std::string::npos);
}

TEST_F(Pages, APageTooSmallSaysWhatItNeeds) {
  try {
    (void)gnuplot_script(one_panel().with({.width = 20, .height = 20}), Format::pdf);
    FAIL();
  } catch (const Error& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("found 2 cm x 2 cm; allowed for this figure at least "))
        << error.what();
  }
}

TEST_F(Pages, OneScaleOnBothAxesHoldsInAnyBox) {
  Page page = one_panel();
  page.panels[0].equal_axes = true;
  for (const auto& [width, height] : {std::pair{120.0, 50.0}, {50.0, 120.0}}) {
    Page sized = page;
    const std::string script = gnuplot_script(std::move(sized).with({.width = width, .height = height}), Format::pdf);
    const auto number = [&](const std::string& before) {
      return std::stod(script.substr(script.find(before) + before.size()));
    };
    const auto range = [&](const std::string& axis) {
      const double low = number("set " + axis + "range [");
      const std::string both = script.substr(script.find("set " + axis + "range ["));
      return std::stod(both.substr(both.find(':') + 1)) - low;
    };
    const double box_width = width * (number("set rmargin at screen ") - number("set lmargin at screen "));
    const double box_height = height * (number("set tmargin at screen ") - number("set bmargin at screen "));
    EXPECT_NEAR(range("x") / box_width, range("y") / box_height, 1e-5 * range("y") / box_height);
  }
}

TEST(PageSize, IsReadWithItsUnit) {
  for (const auto& [text, width, height] :
       {std::tuple{"8.5x6", 85.0, 60.0}, {"85x60mm", 85.0, 60.0}, {"4x3in", 101.6, 76.2}, {"17x10cm", 170.0, 100.0}}) {
    PageOptions page;
    EXPECT_EQ(read_page_size(text, page), "") << text;
    EXPECT_DOUBLE_EQ(page.width, width);
    EXPECT_DOUBLE_EQ(page.height, height);
  }
  for (const char* text : {"", "8", "8x", "x8", "1x1", "0x0", "-5x5", "nanx5", "1e9x5", "8x5px", "axb"}) {
    PageOptions page;
    EXPECT_NE(read_page_size(text, page).find("allowed WIDTHxHEIGHT in centimetres"), std::string::npos) << text;
  }
  EXPECT_EQ(refused_dpi(600, "a.png", {}), "");
  EXPECT_EQ(refused_dpi(0, "a.svg", {}), "");
  EXPECT_NE(refused_dpi(600, "a.svg", {}).find("allowed with a file .png"), std::string::npos);
  EXPECT_NE(refused_dpi(2400, "a.png", {.width = 1000, .height = 1000}).find("allowed up to"), std::string::npos);
}

}  // namespace
}  // namespace hamflow::figures
