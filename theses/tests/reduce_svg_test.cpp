// The figures of the page are those of the folder, with fewer bytes.
#include "reduce_svg.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

namespace hamflow::reproduction {
namespace {

struct Place {
  double x, y;
};

/// The points of a path "Mx ydx dy..." as reduce_svg writes it.
std::vector<Place> places_in(const std::string& svg) {
  const std::size_t begin = svg.find(" d='M") + 4, end = svg.find('\'', begin);
  std::string numbers;
  for (const char c : svg.substr(begin, end - begin)) {
    if (c == '-') numbers += ' ';
    numbers += c == 'M' || c == 'l' ? ' ' : c;
  }
  std::istringstream in(numbers);
  std::vector<Place> all;
  double dx = 0, dy = 0;
  while (in >> dx >> dy) {
    all.push_back(all.empty() ? Place{dx, dy} : Place{all.back().x + dx, all.back().y + dy});
  }
  return all;
}

double distance(Place z, Place a, Place b) {
  const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
  const double part = square > 0 ? std::min(1.0, std::max(0.0, ((z.x - a.x) * dx + (z.y - a.y) * dy) / square)) : 0;
  return std::hypot(z.x - a.x - part * dx, z.y - a.y - part * dy);
}

TEST(SlimSvg, NoPointOfALineIsFartherThanTheEyeSees) {
  std::string path = "<path stroke='black'  d='M0.00,50.00";
  std::vector<Place> points{{0, 50}};
  for (int i = 1; i <= 2000; ++i) {
    const double x = std::round(15.0 * i) / 100,
                 y = std::round(5000 + 4000 * std::sin(0.07 * x) * std::cos(0.9 * x)) / 100;
    points.push_back({x, y});
    std::ostringstream more;
    more << " L" << x << ',' << y;
    path += more.str();
  }
  const std::string slim = reduce_svg(path + "  '/>\n");
  const std::vector<Place> kept = places_in(slim);
  ASSERT_GT(kept.size(), 2u);
  EXPECT_LT(kept.size(), points.size() / 2);
  for (const Place& point : points) {
    double nearest = 1e9;
    for (std::size_t k = 1; k < kept.size(); ++k) nearest = std::min(nearest, distance(point, kept[k - 1], kept[k]));
    EXPECT_LE(nearest, 0.05 + 1e-9);
  }
}

TEST(SlimSvg, DotsBecomeOnePathOfRoundEnds) {
  std::string dots =
      "\t<circle id='gpPt5' cx='0' r='1'/>\n\t<use xlink:href='#gpPt5' id='gpPt6' fill='currentColor'/>\n";
  for (const char* const place : {"10,20", "10.5,20", "10,20", "9.25,21.1"}) {
    dots += "\t<use xlink:href='#gpPt6' transform='translate(" + std::string(place) +
            ") scale(0.63)' color='rgb(1, 2, 3)'/>\n";
  }
  EXPECT_EQ(reduce_svg(dots + "</g>\n"),
            "<path fill='none' stroke-linecap='round' stroke='rgb(1, 2, 3)' stroke-width='1.4175' "
            "d='M10 20h0m.5 0h0m-1.25 1.1h0'/>\n</g>\n");
}

TEST(SlimSvg, WhatItDoesNotKnowStays) {
  const std::string svg = "<path d='M0,0 C1,2 3,4 5,6'/>\n<text>M1,2 L3,4</text>\n<use xlink:href='#gpPt3'/>\n";
  EXPECT_EQ(reduce_svg(svg), svg);
}

}  // namespace
}  // namespace hamflow::reproduction
