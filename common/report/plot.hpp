#pragma once

#include <cstddef>
#include <string>
#include <vector>

/// Plots as SVG text. Pure: the same plot gives the same bytes. Colours are the variables --s1 ... --s6,
/// --ink, --soft, --line, --bad of the page around it; standalone() gives them where there is no page.
namespace fathom::report {

struct Curve {
  enum class Shape { line, dots, crosses };
  std::string name;
  std::vector<double> x;
  std::vector<double> y;  ///< as many as x; a gap where not finite
  int colour = 1;         ///< 1 to 6; 0: bad
  Shape shape = Shape::line;
  bool dashed = false;
};

/// Between two curves over the same x.
struct Band {
  std::string name;
  std::vector<double> x;
  std::vector<double> low;
  std::vector<double> high;
  int colour = 1;
};

struct Span {
  double begin = 0.0;
  double end = 0.0;
};

struct Level {
  double y = 0.0;
  std::string name;
};

struct Plot {
  std::string title;
  std::string x_label = "t, s";
  std::string y_label;
  std::vector<Curve> curves;
  std::vector<Band> bands;
  std::vector<Span> spans;  ///< shaded stretches of x
  std::string span_name;
  std::vector<Level> levels;
  bool logarithmic = false;    ///< y; what is not positive is left out
  bool logarithmic_x = false;  ///< likewise x
  double x_from = 0.0;         ///< shown at least, where below x_to: plots under each other line up
  double x_to = 0.0;
  double least_height = 0.0;  ///< of the range of y: noise of a quiet quantity does not fill the plot
  double most = 0.0;          ///< |y| beyond is drawn at the edge; 0: everything is shown
  int width = 860;
  int height = 230;
};
[[nodiscard]] std::string to_svg(const Plot& plot);

struct Ellipse {
  double x = 0.0;
  double y = 0.0;
  double major = 0.0;  ///< half axes
  double minor = 0.0;
  double angle_rad = 0.0;  ///< of the major axis, from x to y
};

/// A map: x east, y north, metres, the same scale on both axes, a grid of round metres.
struct Map {
  std::string title;
  std::vector<Curve> curves;
  std::vector<Ellipse> ellipses;  ///< drawn enlarged by `enlarged`
  double enlarged = 1.0;
  int width = 860;
  int height = 520;
};
[[nodiscard]] std::string to_svg(const Map& map);

/// An SVG with its own colours, for light and dark surroundings and with the name space of a file.
[[nodiscard]] std::string standalone(const std::string& svg);

/// The style sheet of the classes that plots use.
[[nodiscard]] std::string plot_style();

/// The round step (1, 2 or 5 times a power of ten) that divides `range` into at most `most` parts.
[[nodiscard]] double round_step(double range, int most);
/// A number as people write it beside others `step` apart.
[[nodiscard]] std::string label_of(double value, double step);
/// Three significant digits.
[[nodiscard]] std::string brief(double value);

}  // namespace fathom::report
