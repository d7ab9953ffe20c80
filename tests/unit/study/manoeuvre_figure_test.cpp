// The figure in the documentation of the vehicle model shows what the model does. FATHOM_DRAW=FILE draws it.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/paths.hpp"
#include "unit/study/remus_motion.hpp"

namespace fathom::study {
namespace {

const std::string kFigure = test::source_dir() + "/common/estimation/hydro/manoeuvres.svg";

using Pixel = std::array<double, 2>;

struct Curve {
  std::string label;
  const char* colour;
  std::vector<Pixel> points;
};

/// Where the drawing's origin is, and pixels of a unit.
struct Panel {
  Pixel origin;
  Pixel scale;
  [[nodiscard]] Pixel at(double x, double y) const {
    return {origin[0] + scale[0] * x, origin[1] + scale[1] * y};
  }
};
constexpr Panel kTurns{{215.0, 270.0}, {14.0, -14.0}};  // east, north in m
constexpr Panel kDives{{445.0, 60.0}, {27.0, 70.0}};    // s, depth in m

std::string degrees(double value) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%+.4g°", value);
  return text.data();
}

std::vector<Curve> turns() {
  std::vector<Curve> out;
  for (const auto& [rudder, colour] : {std::pair{-4.0, "#1b6ca8"},
                                       {4.0, "#7fb2d6"},
                                       {-8.0, "#c2571a"},
                                       {8.0, "#e6a37c"},
                                       {-13.6, "#2f7d4f"},
                                       {13.6, "#8fc4a4"}}) {
    Curve curve{degrees(rudder), colour, {}};
    int step = 0;
    RemusMotion::run(rudder, 0.0, 60.0, [&](double, const RemusMotion& m) {
      if (step++ % 25 == 0) curve.points.push_back(kTurns.at(m.position_N_m.y(), m.position_N_m.x()));
    });
    out.push_back(std::move(curve));
  }
  return out;
}

std::vector<Curve> dives() {
  std::vector<Curve> out;
  for (const auto& [stern, colour] : {std::pair{-4.0, "#1b6ca8"}, {0.0, "#c2571a"}, {4.0, "#2f7d4f"}}) {
    Curve curve{degrees(stern), colour, {}};
    int step = 0;
    RemusMotion::run(0.0, stern, 10.0, [&](double t_s, const RemusMotion& m) {
      if (step++ % 10 == 0) curve.points.push_back(kDives.at(t_s, m.position_N_m.z()));
    });
    out.push_back(std::move(curve));
  }
  return out;
}

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f", value);
  return text.data();
}

std::string text_at(Pixel where, const std::string& what, const char* more = "") {
  return "<text x=\"" + number(where[0]) + "\" y=\"" + number(where[1]) + "\" " + more + ">" + what +
         "</text>\n";
}

std::string line(Pixel from, Pixel to) {
  return "<line x1=\"" + number(from[0]) + "\" y1=\"" + number(from[1]) + "\" x2=\"" + number(to[0]) +
         "\" y2=\"" + number(to[1]) + "\" stroke=\"#cccccc\"/>\n";
}

std::string drawn(const std::vector<Curve>& curves, Pixel legend) {
  std::string out;
  for (const Curve& curve : curves) {
    out +=
        "<polyline fill=\"none\" stroke-width=\"1.5\" stroke=\"" + std::string(curve.colour) + "\" points=\"";
    for (const Pixel& point : curve.points) out += number(point[0]) + "," + number(point[1]) + " ";
    out += "\"/>\n";
    out += text_at(legend, curve.label, ("fill=\"" + std::string(curve.colour) + "\"").c_str());
    legend[1] += 15.0;
  }
  return out;
}

std::string figure() {
  std::string out =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 760 340\" font-family=\"sans-serif\" "
      "font-size=\"12\">\n<rect width=\"760\" height=\"340\" fill=\"white\"/>\n";
  for (int m = -10; m <= 10; m += 5) {
    out += line(kTurns.at(m, -3), kTurns.at(m, 11)) +
           text_at(kTurns.at(m, -4.2), std::to_string(m), "text-anchor=\"middle\"");
  }
  for (int m = 0; m <= 10; m += 5) {
    out += line(kTurns.at(-10.5, m), kTurns.at(10.5, m)) +
           text_at(kTurns.at(-10.9, m), std::to_string(m), "text-anchor=\"end\"");
  }
  for (int s = 0; s <= 10; s += 2) {
    out += line(kDives.at(s, 0), kDives.at(s, 3.2)) +
           text_at(kDives.at(s, 3.5), std::to_string(s), "text-anchor=\"middle\"");
  }
  for (int m = 0; m <= 3; ++m) {
    out += line(kDives.at(0, m), kDives.at(10, m)) +
           text_at(kDives.at(-0.3, m), std::to_string(m), "text-anchor=\"end\"");
  }
  out += text_at({215, 25}, "Rudder held for 60 s: north over east, m", "text-anchor=\"middle\"");
  out += text_at({580, 25}, "Stern planes held: depth, m, over time, s", "text-anchor=\"middle\"");
  out += drawn(turns(), {10, 38});
  out += drawn(dives(), {722, 64});
  return out + "</svg>\n";
}

std::vector<double> coordinates(const std::string& svg) {
  const std::string begin = " points=\"";
  std::vector<double> out;
  for (std::size_t at = svg.find(begin); at != std::string::npos; at = svg.find(begin, at)) {
    at += begin.size();
    std::string points = svg.substr(at, svg.find('"', at) - at);
    for (char& c : points)
      if (c == ',') c = ' ';
    std::istringstream stream(points);
    for (double value = 0.0; stream >> value;) out.push_back(value);
  }
  return out;
}

TEST(RemusManoeuvres, FigureIsThatOfTheModel) {
  const std::string drawn_now = figure();
  if (const char* file = std::getenv("FATHOM_DRAW")) std::ofstream(file) << drawn_now;
  std::ifstream stream(kFigure);
  const std::string kept{std::istreambuf_iterator<char>(stream), {}};
  const std::vector<double> expected = coordinates(drawn_now);
  const std::vector<double> found = coordinates(kept);
  ASSERT_GT(expected.size(), 1000U);
  ASSERT_EQ(found.size(), expected.size()) << kFigure << ": draw it again with FATHOM_DRAW=" << kFigure;
  for (std::size_t i = 0; i < found.size(); ++i) ASSERT_NEAR(found[i], expected[i], 0.5) << i;
}

}  // namespace
}  // namespace fathom::study
