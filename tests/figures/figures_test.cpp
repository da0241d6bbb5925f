// Whole figures: every kind in every format, what stands in them, and the messages where they cannot be drawn.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <random>
#include <regex>
#include <sstream>

#include "figure.hpp"
#include "hamflow/core/error.hpp"

namespace hamflow {
namespace {

namespace fs = std::filesystem;

class Figures : public testing::Test {
 protected:
  void SetUp() override {
    const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    folder_ = fs::temp_directory_path() / ("hamflow_figures_" + name + "_" + std::to_string(std::random_device{}()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string drawn(const FigureData& data, const std::string& kind, const std::string& extension = "svg") {
    return drawn(Figure{{data}}, kind, extension);
  }
  std::string drawn(const Figure& figure, const std::string& kind, const std::string& extension = "svg") {
    const fs::path file = folder_ / (kind + "." + extension);
    write_figure(figure, kind, file);
    std::ostringstream bytes;
    bytes << std::ifstream(file, std::ios::binary).rdbuf();
    return bytes.str();
  }

  fs::path folder_;
};

/// The Kepler ellipse r_per = 1, r_aph = 3, exactly.
FigureData ellipse(int samples = 300) {
  FigureData data;
  data.title = "central-force, cg(1,5), dt = 0.1";
  data.coordinates = {"x", "y"};
  data.momenta = {"p_x", "p_y"};
  data.q.resize(2);
  data.p.resize(2);
  data.energy_scale = 1.75;
  const auto r = [](double phi) { return 1.5 / (1 + 0.5 * std::cos(phi)); };
  for (int k = 0; k < samples; ++k) {
    const double phi = 0.05 * k;
    data.t.push_back(0.1 * k);
    data.q[0].push_back(r(phi) * std::cos(phi));
    data.q[1].push_back(r(phi) * std::sin(phi));
    data.p[0].push_back(-std::sin(phi));
    data.p[1].push_back(std::cos(phi) + 0.5);
    data.energy.push_back(-0.25 + 1e-16 * (k % 5));
    data.section_q.push_back(std::sin(phi * phi));
    data.section_p.push_back(std::cos(phi * phi));
  }
  data.section_coordinate = "y";
  data.section_momentum = "p_y";
  sample_polar_curve(r, data);
  // Before the first step there is no tangent.
  const auto from_first_step = [&](auto value) {
    std::vector<double> all;
    for (int k = 0; k < samples; ++k) all.push_back(k == 0 ? std::numeric_limits<double>::quiet_NaN() : value(k));
    return all;
  };
  data.diagnostics = {{"condition_tangent", from_first_step([](int k) { return 3 + std::sin(0.1 * k); })},
                      {"determinant_tangent", from_first_step([](int k) { return 1 + 1e-3 * std::cos(0.1 * k); })},
                      {"condition_inverse_mass", std::vector<double>(static_cast<std::size_t>(samples), 5.0)},
                      {"iterations", from_first_step([](int k) { return 2.0 + k % 2; })}};
  return data;
}

FigureData oscillator(int samples = 200) {
  FigureData data;
  data.title = "harmonic";
  data.coordinates = {"q"};
  data.momenta = {"p"};
  data.q.resize(1);
  data.p.resize(1);
  for (int k = 0; k < samples; ++k) {
    data.t.push_back(0.1 * k);
    data.q[0].push_back(std::cos(0.1 * k));
    data.p[0].push_back(-std::sin(0.1 * k));
    data.energy.push_back(0.5);
  }
  data.hamiltonian_1d = [](double q, double p) { return (q * q + p * p) / 2; };
  return data;
}

struct Pixel {
  double x;
  double y;
};

/// The line titled `name` in an SVG of gnuplot: the longest path of its group (the other is its mark in the legend).
std::vector<Pixel> line_of(const std::string& svg, const std::string& name) {
  const std::size_t group = svg.find("<title>" + name);
  EXPECT_NE(group, std::string::npos) << name;
  const std::string part = svg.substr(group, svg.find("<g id=\"gnuplot_plot", group) - group);
  const std::size_t path = part.rfind(" M");
  std::vector<Pixel> points;
  static const std::regex number_pair("([-0-9.]+),([-0-9.]+)");
  const std::size_t begin = path == std::string::npos ? 0 : path;
  for (std::sregex_iterator it(part.begin() + static_cast<std::ptrdiff_t>(begin), part.end(), number_pair), end;
       it != end; ++it) {
    points.push_back({std::stod((*it)[1]), std::stod((*it)[2])});
  }
  return points;
}

std::vector<Pixel> dots_of(const std::string& svg) {
  std::vector<Pixel> points;
  static const std::regex dot("#gpPt6' transform='translate\\(([-0-9.]+),([-0-9.]+)\\)");
  for (std::sregex_iterator it(svg.begin(), svg.end(), dot), end; it != end; ++it) {
    points.push_back({std::stod((*it)[1]), std::stod((*it)[2])});
  }
  return points;
}

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::exception& e) {
    return e.what();
  }
  return "";
}

TEST_F(Figures, EveryKindInEveryFormat) {
  for (const FigureData& data : {ellipse(), oscillator()}) {
    for (const std::string& kind : figure_names()) {
      if (!why_not(Figure{{data}}, kind).empty()) continue;
      const std::string svg = drawn(data, kind, "svg");
      EXPECT_TRUE(svg.starts_with("<?xml")) << kind;
      EXPECT_TRUE(svg.ends_with("</svg>\n\n") || svg.ends_with("</svg>\n")) << kind;
      EXPECT_NE(svg.find("<title>" + data.title), std::string::npos) << kind;
      const std::string pdf = drawn(data, kind, "pdf");
      EXPECT_TRUE(pdf.starts_with("%PDF-")) << kind;
      EXPECT_NE(pdf.find("%%EOF"), std::string::npos) << kind;
      EXPECT_NE(pdf.find("/FontFile"), std::string::npos) << "text needs its font";
      const std::string png = drawn(data, kind, "png");
      EXPECT_TRUE(png.starts_with("\x89PNG\r\n\x1a\n")) << kind;
      EXPECT_GT(png.size(), 4000U) << kind;
      const auto byte = [&](std::size_t at) { return static_cast<unsigned>(static_cast<unsigned char>(png[at])); };
      EXPECT_EQ(byte(18) * 256 + byte(19), 1004U) << "85 mm, 300 dots to the inch";
    }
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 21) << "no scratch files stay";
}

TEST_F(Figures, SameDataSameBytes) {
  for (const char* extension : {"svg", "pdf", "png"}) {
    EXPECT_TRUE(drawn(ellipse(), "orbit", extension) == drawn(ellipse(), "orbit", extension)) << extension;
  }
  EXPECT_EQ(drawn(ellipse(), "orbit", "pdf").find("CreationDate"), std::string::npos);
}

TEST_F(Figures, OrbitLiesWhereItShould) {
  const std::string svg = drawn(ellipse(), "orbit");
  const std::vector<Pixel> line = line_of(svg, "exact");
  ASSERT_GT(line.size(), 100U);
  double left = 1e9, right = 0, top = 1e9, bottom = 0;
  for (const Pixel& z : line) {
    left = std::min(left, z.x);
    right = std::max(right, z.x);
    top = std::min(top, z.y);
    bottom = std::max(bottom, z.y);
  }
  const double unit = (right - left) / 4;  // x from -3 to 1
  EXPECT_NEAR((bottom - top) / unit, 2 * std::sqrt(3.0), 0.01) << "equal axes";
  const auto residual = [&](const Pixel& z) {
    const double x = (z.x - left) / unit - 3;
    const double y = (0.5 * (top + bottom) - z.y) / unit;
    return std::abs(std::hypot(x, y) + 0.5 * x - 1.5);
  };
  for (const Pixel& z : line) EXPECT_LT(residual(z), 0.002);
  const std::vector<Pixel> dots = dots_of(svg);
  EXPECT_GE(dots.size(), 100U);
  EXPECT_LE(dots.size(), 400U);
  const auto on_the_curve =
      std::count_if(dots.begin(), dots.end(), [&](const Pixel& z) { return residual(z) < 0.002; });
  EXPECT_EQ(static_cast<std::size_t>(on_the_curve), dots.size() - 1) << "all but the mark in the legend";
  EXPECT_NEAR(line.front().x, line.back().x, 0.02);
  EXPECT_NEAR(line.front().y, line.back().y, 0.02);
  // The label of x = -3 stands below the leftmost point.
  static const std::regex label(
      "translate\\(([-0-9.]+),[-0-9.]+\\)\"[^>]*text-anchor=\"middle\">\\s*<text[^>]*>(<tspan[^>]*>)?\u22123<");
  std::smatch tick;
  ASSERT_TRUE(std::regex_search(svg, tick, label));
  EXPECT_NEAR(std::stod(tick[1]), left, 0.05);
  // The centre of force is a cross at three quarters of the long axis.
  static const std::regex cross("#gpPt0' transform='translate\\(([-0-9.]+),([-0-9.]+)\\)");
  std::smatch at;
  ASSERT_TRUE(std::regex_search(svg, at, cross));
  EXPECT_NEAR(std::stod(at[1]), left + 3 * unit, 0.05);
  EXPECT_NEAR(std::stod(at[2]), 0.5 * (top + bottom), 0.05);
}

/// A path behind walls has its corners where bounces were, between samples.
TEST_F(Figures, AnOrbitReachesItsBounces) {
  FigureData data = ellipse(20);
  const auto reaches_seven = [&] { return drawn(data, "orbit").find(">7<") != std::string::npos; };
  EXPECT_FALSE(reaches_seven());
  data.path.t = {data.t[0], 0.05, data.t[1]};
  data.path.q = {{data.q[0][0], 0, data.q[0][1]}, {data.q[1][0], 7.2, data.q[1][1]}};
  EXPECT_TRUE(reaches_seven() || drawn(data, "orbit").find(">6<") != std::string::npos);
}

TEST_F(Figures, PhasePlaneShowsTheClosedLevelCurve) {
  const std::string svg = drawn(oscillator(), "phase");
  const std::vector<Pixel> line = line_of(svg, "exact");
  ASSERT_GT(line.size(), 50U);
  EXPECT_NEAR(line.front().x, line.back().x, 0.02);
  EXPECT_NEAR(line.front().y, line.back().y, 0.02);
}

TEST_F(Figures, ConstantEnergyIsShownOnItsScale) {
  const std::string svg = drawn(ellipse(), "energy");
  EXPECT_NE(svg.find(">\u22121<"), std::string::npos) << "ticks of the size of the energy";
  EXPECT_NE(svg.find("max |"), std::string::npos) << "the error in words";
  const std::string error = drawn(ellipse(), "energy-error");
  EXPECT_NE(error.find("\u221215"), std::string::npos) << "the power of ten is named once";
  EXPECT_NE(error.find(">0.5<"), std::string::npos) << "and the ticks are short";
}

TEST_F(Figures, TextIsTextNotCode) {
  const fs::path before = fs::current_path();
  fs::current_path(folder_);  // where a command would leave its file
  FigureData data = oscillator();
  data.title = "it's \"q_1^2\" {a} `touch broken` <b> & @x \\n \xff";
  data.coordinates = {"an'gle {_}"};
  for (const char* extension : {"svg", "pdf", "png"}) EXPECT_NO_THROW(drawn(data, "phase", extension)) << extension;
  const std::string svg = drawn(data, "phase");
  EXPECT_NE(svg.find(">it's \"q_1^2\" {a} `touch broken` &lt;b> &amp; @x \\n \uFFFD<"), std::string::npos) << svg;
  EXPECT_NE(svg.find("an'gle {_}"), std::string::npos);
  EXPECT_FALSE(fs::exists("broken"));
  fs::current_path(before);
}

/// Two bodies opposite each other, on the same paths.
FigureData bodies(FigureData data) {
  const FigureSamples samples = data;
  data.particles = {.count = 2, .space = 2, .positions = [samples](std::size_t k) {
                      const double x = samples.q[0][k];
                      const double y = samples.q[1][k];
                      return std::vector<double>{x, y, -x, -y};
                    }};
  return data;
}

/// What the kind can be drawn of.
FigureData of_kind(const FigureData& data, const std::string& kind) {
  return kind == "particles" || kind == "tracks" || kind == "radial" ? bodies(data) : data;
}

TEST_F(Figures, StrangeNumbersAreDrawn) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double size : {1e300, 1.7e308, 1e-300, 0.0}) {
    FigureData data = ellipse();
    for (auto* list : {&data.q[0], &data.q[1], &data.p[0], &data.p[1], &data.energy}) {
      for (double& x : *list) x *= size / 3;
    }
    data.curve_x.clear();
    data.curve_y.clear();
    data.q[0][7] = nan;
    data.p[1][8] = std::numeric_limits<double>::infinity();
    data.energy[9] = nan;
    for (const std::string& kind : figure_names()) {
      // Such particles fill no volume that is a number.
      if (kind == "radial") continue;
      EXPECT_NO_THROW(drawn(of_kind(data, kind), kind)) << kind << size;
    }
    EXPECT_NE(why_not(Figure{{bodies(data)}}, "radial"), "") << size;
  }
  for (const std::string& kind : figure_names()) {
    if (kind == "radial") {  // of two bodies that nothing holds
      EXPECT_NE(why_not(Figure{{bodies(ellipse(1))}}, kind).find("the 2 bodies have no container"), std::string::npos);
    } else {
      EXPECT_NO_THROW(drawn(of_kind(ellipse(1), kind), kind)) << kind;
    }
    EXPECT_THROW(drawn(ellipse(0), kind), Error) << kind;
    EXPECT_THROW(drawn(bodies(ellipse(0)), kind), Error) << kind;
  }
}

TEST_F(Figures, SectionsNeedARunThatRecordedThem) {
  FigureData data = ellipse();
  data.section_coordinate.clear();
  EXPECT_NE(why_not(Figure{{data}}, "section").find("run.section"), std::string::npos);
  EXPECT_NE(why_not(Figure{{oscillator()}}, "section").find("1 degree of freedom"), std::string::npos);
}

TEST_F(Figures, ConditionsNeedARunThatRecordedThem) {
  EXPECT_NE(why_not(Figure{{oscillator()}}, "condition").find("method.diagnostics = true"), std::string::npos);
  const std::string svg = drawn(ellipse(), "condition");
  EXPECT_NE(svg.find("Newton"), std::string::npos);
}

TEST_F(Figures, BodiesAreDrawnInOnePlane) {
  FigureData data = ellipse();
  data.space = 2;
  data.curve_x.clear();
  data.curve_y.clear();
  for (int k = 0; k < 2; ++k) data.q.push_back(data.q[static_cast<std::size_t>(k)]);
  for (double& x : data.q[2]) x = -x;
  data.p.resize(4, data.p[0]);
  EXPECT_NE(why_not(Figure{{data}}, "orbit").find("2 names of coordinates for 4"), std::string::npos);
  data.coordinates = {"x1", "y1", "x2", "y2"};
  data.momenta = {"p_x1", "p_y1", "p_x2", "p_y2"};
  EXPECT_EQ(why_not(Figure{{data}}, "orbit"), "");
  const std::string svg = drawn(data, "orbit");
  for (const char* text : {">body 1<", ">body 2<"}) EXPECT_NE(svg.find(text), std::string::npos) << text;
  EXPECT_NE(svg.find("31,  78, 140"), std::string::npos) << "blue";
  EXPECT_NE(svg.find("213,  94,   0"), std::string::npos) << "vermilion";
}

TEST_F(Figures, WrongRequestsNameWhatIsAllowed) {
  EXPECT_EQ(why_not(Figure{{ellipse()}}, "orbit"), "");
  EXPECT_EQ(
      why_not(Figure{{oscillator()}}, "orbit"),
      "found \"orbit\" for a problem with 1 degree of freedom, where an orbit needs 2, or bodies in space; allowed "
      "phase, time, energy-error, energy");
  EXPECT_EQ(
      why_not(Figure{{oscillator()}}, "orbits"),
      "found \"orbits\"; allowed orbit, phase, time, energy-error, energy, condition, section, particles, tracks, "
      "radial; did you mean orbit?");
  EXPECT_THROW(write_figure(Figure{{ellipse()}}, "spiral", folder_ / "a.svg"), Error);
  EXPECT_THROW(write_figure(Figure{{oscillator()}}, "orbit", folder_ / "a.svg"), Error);
  for (const char* name : {"a.gif", "a", ".svg", "a.svg.gz"}) {
    const std::string message = message_of([&] { write_figure(Figure{{ellipse()}}, "orbit", folder_ / name); });
    EXPECT_NE(message.find(".svg, .pdf or .png"), std::string::npos) << name;
  }
  FigureData uneven = ellipse();
  uneven.energy.pop_back();
  EXPECT_NE(why_not(Figure{{uneven}}, "energy").find("different numbers of samples"), std::string::npos);
  EXPECT_EQ(why_not(Figure{{uneven}}, "energy"),
            "found \"energy\", but energy and t have different numbers of samples; no other figure can be drawn from "
            "these samples");
  FigureData blind = ellipse();
  for (double& x : blind.q[0]) x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(why_not(Figure{{blind}}, "orbit"),
            "found \"orbit\", but there is no sample with a finite position; allowed time, energy-error, energy, "
            "condition, section");
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(Figures, UnwritableFilesAreFileErrors) {
  EXPECT_THROW(write_figure(Figure{{ellipse()}}, "orbit", folder_ / "missing" / "a.svg"), FileError);
  std::ofstream(folder_ / "file") << "x";
  EXPECT_THROW(write_figure(Figure{{ellipse()}}, "orbit", folder_ / "file" / "a.svg"), FileError);
  fs::create_directories(folder_ / "taken.svg" / "inside");
  const std::string message = message_of([&] { write_figure(Figure{{ellipse()}}, "orbit", folder_ / "taken.svg"); });
  EXPECT_NE(message.find("taken.svg"), std::string::npos) << message;
}

TEST_F(Figures, GnuplotMissingOrFailingIsReportedInItsWords) {
  const char* const search = std::getenv("PATH");
  const std::string path = search ? search : "";
  setenv("PATH", folder_.c_str(), 1);
  const std::string missing = message_of([&] { write_figure(Figure{{ellipse()}}, "orbit", folder_ / "a.svg"); });
  std::ofstream(folder_ / "gnuplot") << "#!/bin/sh\necho 'line 3: no such terminal' >&2\nexit 3\n";
  fs::permissions(folder_ / "gnuplot", fs::perms::owner_all);
  const std::string failing = message_of([&] { write_figure(Figure{{ellipse()}}, "orbit", folder_ / "a.svg"); });
  setenv("PATH", path.c_str(), 1);
  EXPECT_NE(missing.find("gnuplot-nox"), std::string::npos) << missing;
  EXPECT_EQ(failing, "gnuplot failed with status 3: line 3: no such terminal");
  EXPECT_FALSE(fs::exists(folder_ / "a.svg"));
}

}  // namespace
}  // namespace hamflow
