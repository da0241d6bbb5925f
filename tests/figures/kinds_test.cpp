// The table of figure kinds: its files, its order, and of which runs each kind can be drawn.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "figure_kind.hpp"
#include "figure_kinds.hpp"

namespace hamflow {
namespace {

using Names = std::vector<std::string>;

/// A run of a scenario with everything that a figure may need.
FigureFacts with_everything(std::size_t degrees_of_freedom) {
  return {.degrees_of_freedom = degrees_of_freedom, .diagnostics = true, .section = true};
}

TEST(FigureKinds, AreTheFilesOfTheFolder) {
  std::set<std::string> expected;
  for (const auto& file : std::filesystem::directory_iterator(HAMFLOW_FIGURE_KINDS)) {
    std::string name = file.path().stem().string();
    std::replace(name.begin(), name.end(), '_', '-');
    expected.insert(name);
  }
  EXPECT_EQ(std::set<std::string>(figure_names().begin(), figure_names().end()), expected);
  EXPECT_EQ(figure_names().size(), expected.size());
}

TEST(FigureKinds, DeclareAPlaceOfTheirOwnAndAMeaning) {
  std::set<int> places;
  for (const figures::FigureKind* kind : figures::all_kinds()) EXPECT_TRUE(places.insert(kind->place).second);
  ASSERT_EQ(figure_kinds().size(), figure_names().size());
  for (std::size_t i = 0; i < figure_kinds().size(); ++i) {
    EXPECT_EQ(figure_kinds()[i].name, figure_names()[i]);
    EXPECT_GT(figure_kinds()[i].meaning.size(), 10U) << figure_names()[i];
  }
}

TEST(FigureKinds, OfARunThatIsNotKnownYetEveryKindIsPossible) {
  EXPECT_EQ(drawable_figures(with_everything(0)), figure_names());
}

TEST(FigureKinds, TheUsualFigureIsTheOrbitElseThePhasePlaneElseTheTimeSeries) {
  EXPECT_EQ(usual_figure({.degrees_of_freedom = 2}), "orbit");
  EXPECT_EQ(usual_figure({.degrees_of_freedom = 27, .bodies_in_space = true}), "orbit");
  EXPECT_EQ(usual_figure({.degrees_of_freedom = 27, .bodies_in_space = true, .particles = true}), "orbit");
  EXPECT_EQ(usual_figure({.degrees_of_freedom = 27, .bodies_in_space = true, .particles = true, .gas = true}),
            "particles");
  EXPECT_EQ(usual_figure({.degrees_of_freedom = 1}), "phase");
  EXPECT_EQ(usual_figure({.degrees_of_freedom = 12}), "phase");
  EXPECT_EQ(usual_figure({.degrees_of_freedom = 13}), "time");
  EXPECT_EQ(usual_figure({.degrees_of_freedom = 101}), "energy-error");
}

TEST(FigureKinds, RefusalsNameTheReasonAndWhatIsAllowed) {
  EXPECT_EQ(refused_figure("orbit", {.degrees_of_freedom = 2}), "");
  EXPECT_EQ(
      refused_figure("orbit", {.degrees_of_freedom = 1}),
      "found \"orbit\" for a problem with 1 degree of freedom, where an orbit needs 2, or bodies in space; allowed "
      "phase, time, energy-error, energy");
  EXPECT_EQ(refused_figure("phase", {.degrees_of_freedom = 13}),
            "found \"phase\" for a problem with 13 degrees of freedom, of which at most 12 fit on a page; choose "
            "columns with --x and --y; allowed time, energy-error, energy");
  EXPECT_EQ(refused_figure("condition", {.degrees_of_freedom = 1}),
            "found \"condition\", which needs an implicit method with method.diagnostics = true; allowed phase, "
            "time, energy-error, energy");
  EXPECT_EQ(refused_figure("section", {.degrees_of_freedom = 2}),
            "found \"section\", which needs run.section, e.g. { coordinate = \"q1\" }; allowed orbit, phase, "
            "time, energy-error, energy");
  EXPECT_EQ(refused_figure("section", with_everything(1)),
            "found \"section\" for a problem with 1 degree of freedom, where a section needs 2 or more, or an "
            "expression of t alone; allowed phase, time, energy-error, energy, condition");
  EXPECT_EQ(refused_figure("section", {.degrees_of_freedom = 1, .section = true, .stroboscopic = true}), "");
}

TEST(FigureKinds, ParticlesAreThoseOfAGasOrOfBodies) {
  for (const char* kind : {"particles", "tracks", "radial"}) {
    EXPECT_NE(refused_figure(kind, {.degrees_of_freedom = 4}).find("neither a gas"), std::string::npos);
    EXPECT_EQ(refused_figure(kind, {.degrees_of_freedom = 4, .particles = true}), "");
  }
}

TEST(FigureKinds, OfAReversalThereAreNoEnergies) {
  EXPECT_EQ(refused_figure("energy", {.degrees_of_freedom = 2, .energies = false}),
            "found \"energy\", but a reversal stores no energies; allowed orbit, phase, time");
}

TEST(FigureKinds, ChosenColumnsNeedNoRoomForAll) {
  for (const char* kind : {"phase", "time"}) {
    EXPECT_NE(refused_figure(kind, {.degrees_of_freedom = 500}), "");
    EXPECT_EQ(refused_figure(kind, {.degrees_of_freedom = 500, .columns_chosen = true}), "");
  }
}

TEST(FigureKinds, WhatIsRefusedIsWhatIsNotDrawable) {
  for (const std::size_t degrees : {0U, 1U, 2U, 3U, 12U, 13U, 300U}) {
    for (int bits = 0; bits < 8; ++bits) {
      const FigureFacts facts{degrees, (bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, false};
      const Names drawable = drawable_figures(facts);
      ASSERT_FALSE(drawable.empty());
      EXPECT_EQ(usual_figure(facts), drawable.front());
      for (const std::string& name : figure_names()) {
        const bool listed = std::find(drawable.begin(), drawable.end(), name) != drawable.end();
        EXPECT_EQ(refused_figure(name, facts).empty(), listed) << name << " " << degrees << " " << bits;
      }
    }
  }
}

TEST(FigureKinds, UnknownNamesAreAnsweredByTheNearest) {
  EXPECT_EQ(unknown_figure("orbit"), "");
  const std::string text =
      "found \"orbits\"; allowed orbit, phase, time, energy-error, energy, condition, section, particles, tracks, "
      "radial; did you mean orbit?";
  EXPECT_EQ(unknown_figure("orbits"), text);
  EXPECT_EQ(refused_figure("orbits", {}), text);
}

}  // namespace
}  // namespace hamflow
