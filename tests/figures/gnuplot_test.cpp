// The process: it is ended when it takes too long, or when whoever waits is asked to stop.
#include "gnuplot.hpp"

#include <gtest/gtest.h>

namespace {

using hamflow::FileError;
using namespace hamflow::figures;

TEST(Gnuplot, IsEndedWhenItTakesTooLong) {
  try {
    (void)run_gnuplot({"pause 1000\n"}, 0.1);
    FAIL() << "a script that waits came to its end";
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("did not finish within 0.1 s"), std::string::npos) << error.what();
  }
}

TEST(Gnuplot, IsEndedWhenAskedTo) {
  int asked = 0;
  const StopDrawingScope watch([&] { return ++asked < 3; });
  EXPECT_THROW((void)run_gnuplot({"pause 1000\n"}), DrawingStopped);
  EXPECT_EQ(asked, 3);
}

TEST(Gnuplot, IsNotAskedAfterwards) {
  {
    const StopDrawingScope watch([] { return false; });
  }
  EXPECT_NE(run_gnuplot({"set terminal svg\nplot [0:1] x\n"}).at(0).find("<svg"), std::string::npos);
}

TEST(Gnuplot, DrawsSeveralInOneProcessAsEachAlone) {
  const std::string svg = "set terminal svg\nset title 'one'\n$data << EOD\n0 0\n1 2\nEOD\nplot $data with lines\n";
  const std::string pdf = "set terminal pdfcairo\nplot [0:1] x\n";
  const std::vector<std::string> both = run_gnuplot({svg, pdf, svg});
  ASSERT_EQ(both.size(), 3U);
  EXPECT_EQ(both[0], run_gnuplot({svg})[0]);
  EXPECT_EQ(both[2], both[0]);
  EXPECT_EQ(finished(both[1], Format::pdf, ""), finished(run_gnuplot({pdf})[0], Format::pdf, ""));
}

}  // namespace
