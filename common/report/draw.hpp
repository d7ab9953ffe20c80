#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "report/plot.hpp"

/// What plots and maps share.
namespace fathom::report::detail {

/// From values to pixels, straight.
struct Axis {
  double from = 0.0;
  double to = 1.0;
  double pixel_from = 0.0;
  double pixel_to = 1.0;
  [[nodiscard]] double at(double value) const {
    return pixel_from + (value - from) / (to - from) * (pixel_to - pixel_from);
  }
};

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  [[nodiscard]] bool empty() const { return !(low <= high); }
};

/// A pixel, one decimal.
[[nodiscard]] std::string px(double value);
[[nodiscard]] std::string colour_class(int colour);
/// A curve through pixels: several points in one column become their extremes.
[[nodiscard]] std::string draw(const Curve& curve, const std::vector<double>& px,
                               const std::vector<double>& py);
[[nodiscard]] std::string text_at(double x, double y, const std::string& text, const char* anchor = "start",
                                  const char* cls = "tick");
[[nodiscard]] std::string line_at(double x1, double y1, double x2, double y2, const char* cls);
/// Names of curves with their colours, from the right end of the line at `y` leftwards.
[[nodiscard]] std::string legend(const std::vector<Curve>& curves, const std::vector<Band>& bands,
                                 double right, double y);
[[nodiscard]] std::string open_svg(int width, int height, const std::string& title);

}  // namespace fathom::report::detail
