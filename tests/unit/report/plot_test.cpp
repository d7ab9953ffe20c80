#include "report/plot.hpp"

#include <cmath>
#include <regex>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fathom::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// Every element that is opened is closed, in order.
void expect_well_formed(const std::string& text) {
  std::vector<std::string> open;
  const std::regex tag("<(/?)([a-z]+)([^<>]*?)(/?)>");
  for (auto it = std::sregex_iterator(text.begin(), text.end(), tag); it != std::sregex_iterator(); ++it) {
    if ((*it)[4] == "/") continue;
    if ((*it)[1] == "/") {
      ASSERT_FALSE(open.empty());
      EXPECT_EQ(open.back(), (*it)[2]);
      open.pop_back();
    } else {
      open.push_back((*it)[2]);
    }
  }
  EXPECT_TRUE(open.empty());
}

TEST(Scale, StepsAreRoundAndLabelsHaveTheirDecimals) {
  EXPECT_DOUBLE_EQ(round_step(10.0, 5), 2.0);
  EXPECT_DOUBLE_EQ(round_step(0.07, 7), 0.01);
  EXPECT_DOUBLE_EQ(round_step(35.0, 6), 10.0);
  EXPECT_EQ(label_of(0.30000000000000004, 0.1), "0.3");
  EXPECT_EQ(label_of(-1e-18, 0.1), "0");
  EXPECT_EQ(label_of(1500.0, 500.0), "1500");
  EXPECT_EQ(brief(0.0123456), "0.0123");
  EXPECT_EQ(brief(12345.6), "12346");
  EXPECT_EQ(brief(std::nan("")), "unknown");
}

TEST(Plot, ACurveBreaksWhereAValueIsUnknown) {
  Plot plot;
  plot.curves.push_back({"a", {0, 1, 2, 3, 4}, {1, 2, std::nan(""), 2, 1}, 1, Curve::Shape::line, false});
  const std::string svg = to_svg(plot);
  expect_well_formed(svg);
  const std::size_t path = svg.find("curve c1\" d=\"M");
  ASSERT_NE(path, std::string::npos);
  const std::string d = svg.substr(path, svg.find("\"/>", path) - path);
  EXPECT_EQ(std::count(d.begin(), d.end(), 'M'), 2);
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(Plot, ManyPointsBecomeFewAndKeepTheirExtremes) {
  Plot plot;
  Curve curve{"a", {}, {}, 1, Curve::Shape::line, false};
  for (int i = 0; i < 200'000; ++i) {
    curve.x.push_back(i);
    curve.y.push_back(i == 123'457 ? 10.0 : std::sin(i * 0.7));
  }
  plot.curves.push_back(curve);
  const std::string svg = to_svg(plot);
  EXPECT_LT(svg.size(), 120'000U);
  // The top of the range is the spike's: 5 % below the frame's top at 28.
  const double height = plot.height - 34.0 - 28.0;
  const std::string top = std::to_string(28.0 + height * 0.05 / 1.1);
  EXPECT_THAT(svg, HasSubstr(" " + top.substr(0, 4)));
}

TEST(Plot, NothingToShowIsStillAPlot) {
  for (const bool logarithmic : {false, true}) {
    Plot plot;
    plot.logarithmic = logarithmic;
    plot.title = "a < b & \"c\"";
    plot.curves.push_back({"empty", {}, {}, 1, Curve::Shape::line, false});
    plot.curves.push_back({"unknown", {1.0}, {std::nan("")}, 2, Curve::Shape::dots, false});
    plot.curves.push_back({"negative", {1.0}, {-1.0}, 3, Curve::Shape::crosses, false});
    const std::string svg = to_svg(plot);
    expect_well_formed(svg);
    EXPECT_THAT(svg, HasSubstr("a &lt; b &amp; &quot;c&quot;"));
    EXPECT_THAT(svg, Not(HasSubstr("inf")));
  }
}

TEST(Plot, ARangeBelowTheResolutionOfNumbersEnds) {
  Plot plot;
  plot.curves.push_back(
      {"a", {1.7e9, std::nextafter(1.7e9, 2e9)}, {1e300, 1e300}, 1, Curve::Shape::line, false});
  expect_well_formed(to_svg(plot));
}

TEST(Map, MetresAreAsLongOnBothAxes) {
  Map map;
  map.curves.push_back({"way", {0, 100, 100}, {0, 0, 50}, 1, Curve::Shape::line, false});
  const std::string svg = to_svg(map);
  expect_well_formed(svg);
  const std::regex corners("curve c1\" d=\"M([0-9.]+) ([0-9.]+)L([0-9.]+) ([0-9.]+)L([0-9.]+) ([0-9.]+)");
  std::smatch found;
  ASSERT_TRUE(std::regex_search(svg, found, corners));
  const double along = std::stod(found[3]) - std::stod(found[1]);
  const double up = std::stod(found[4]) - std::stod(found[6]);
  EXPECT_NEAR(along, 2.0 * up, 0.3);
}

TEST(Standalone, HasItsNameSpaceAndColours) {
  const std::string svg = standalone(to_svg(Plot{}));
  expect_well_formed(svg.substr(svg.find("<svg")));
  EXPECT_THAT(svg, HasSubstr("xmlns=\"http://www.w3.org/2000/svg\""));
  EXPECT_THAT(svg, HasSubstr("prefers-color-scheme:dark"));
}

}  // namespace
}  // namespace fathom::report
