#include "report/plot.hpp"

#include <algorithm>
#include <cmath>

#include "base/markup.hpp"
#include "report/draw.hpp"

namespace fathom::report {
namespace {

using namespace detail;

constexpr double kLeft = 62.0;
constexpr double kRight = 12.0;
constexpr double kTop = 28.0;
constexpr double kBottom = 34.0;

double quantile(std::vector<double> values, double share) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.empty()) return NAN;
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// The multiples of `step` from `from` to `to`, at most kMostTicks.
std::vector<double> multiples(double from, double to, double step) {
  constexpr int kMostTicks = 40;
  std::vector<double> out;
  const double first = std::ceil(from / step);
  for (int i = 0; i < kMostTicks; ++i) {
    const double at = (first + i) * step;
    if (at > to + step * 1e-6) break;
    out.push_back(at);
  }
  return out;
}

class Drawing {
 public:
  explicit Drawing(const Plot& plot) : plot_(plot) {
    x_ = {0.0, 1.0, kLeft, plot.width - kRight};
    y_ = {0.0, 1.0, plot.height - kBottom, kTop};
    choose_ranges();
  }

  std::string svg() const {
    std::string out = open_svg(plot_.width, plot_.height, plot_.title);
    for (const Span& span : plot_.spans) {
      const double from = std::clamp(x_.at(abscissa(span.begin)), x_.pixel_from, x_.pixel_to);
      const double to = std::clamp(x_.at(abscissa(span.end)), x_.pixel_from, x_.pixel_to);
      if (!(to > from)) continue;
      out += "<rect class=\"span\" x=\"" + px(from) + "\" y=\"" + px(kTop) + "\" width=\"" + px(to - from) +
             "\" height=\"" + px(y_.pixel_from - kTop) + "\"/>";
    }
    out += grid();
    for (const Band& band : plot_.bands) out += area(band);
    for (const Level& level : plot_.levels) {
      const double y = y_.at(value(level.y));
      if (!(y >= kTop && y <= y_.pixel_from)) continue;
      out += line_at(x_.pixel_from, y, x_.pixel_to, y, "level");
      if (!level.name.empty()) out += text_at(kLeft + 6, y < kTop + 16 ? y + 14 : y - 4, level.name);
    }
    for (const Curve& curve : plot_.curves) {
      std::vector<double> px_x;
      std::vector<double> px_y;
      for (std::size_t i = 0; i < curve.x.size(); ++i) {
        px_x.push_back(x_.at(abscissa(curve.x[i])));
        px_y.push_back(std::isfinite(value(curve.y[i])) ? inside(y_.at(value(curve.y[i])))
                                                        : curve.y[i] * NAN);
      }
      out += draw(curve, px_x, px_y);
    }
    out += "<rect class=\"frame\" x=\"" + px(kLeft) + "\" y=\"" + px(kTop) + "\" width=\"" +
           px(x_.pixel_to - x_.pixel_from) + "\" height=\"" + px(y_.pixel_from - kTop) + "\"/>";
    out += text_at(kLeft, 16, plot_.title, "start", "title");
    std::vector<Band> bands = plot_.bands;
    if (!plot_.spans.empty() && !plot_.span_name.empty()) bands.push_back({plot_.span_name, {}, {}, {}, 6});
    out += legend(plot_.curves, bands, x_.pixel_to, 16);
    return out + "</svg>";
  }

 private:
  [[nodiscard]] static double scaled(double value, bool logarithmic) {
    if (!logarithmic) return value;
    return value > 0.0 ? std::log10(value) : NAN;
  }
  [[nodiscard]] double value(double y) const { return scaled(y, plot_.logarithmic); }
  [[nodiscard]] double abscissa(double x) const { return scaled(x, plot_.logarithmic_x); }
  [[nodiscard]] double inside(double pixel) const { return std::clamp(pixel, kTop, y_.pixel_from); }

  void choose_ranges() {
    Range x;
    Range y;
    const auto see = [&](double value_y) {
      const double v = value(value_y);
      y.add(plot_.most > 0.0 && !plot_.logarithmic ? std::clamp(v, -plot_.most, plot_.most) : v);
    };
    for (const Curve& curve : plot_.curves) {
      for (const double v : curve.x) x.add(abscissa(v));
      for (const double v : curve.y) see(v);
    }
    for (const Band& band : plot_.bands) {
      for (const double v : band.x) x.add(abscissa(v));
      // Its few widest places would make everything else flat.
      see(quantile(band.low, 0.03));
      see(quantile(band.high, 0.97));
    }
    for (const Level& level : plot_.levels) see(level.y);
    if (plot_.x_from < plot_.x_to) {
      x.add(abscissa(plot_.x_from));
      x.add(abscissa(plot_.x_to));
    }
    if (x.empty()) x = {0.0, 1.0};
    if (y.empty()) y = {0.0, 1.0};
    if (x.high == x.low) x.high = x.low + 1.0;
    const double least = std::max(plot_.least_height, std::max(1e-9, std::abs(y.high) * 1e-9));
    if (y.high - y.low < least) {
      const double middle = (y.high + y.low) / 2.0;
      y = {middle - least / 2.0, middle + least / 2.0};
    }
    const double margin = (y.high - y.low) * 0.05;
    x_.from = x.low;
    x_.to = x.high;
    y_.from = y.low - margin;
    y_.to = y.high + margin;
  }

  [[nodiscard]] std::string grid() const {
    std::string out;
    for (const Tick& tick : ticks(x_, plot_.logarithmic_x, 9)) {
      out += line_at(x_.at(tick.at), kTop, x_.at(tick.at), y_.pixel_from, "grid");
      out += text_at(x_.at(tick.at), y_.pixel_from + 15, tick.text, "middle");
    }
    for (const Tick& tick : ticks(y_, plot_.logarithmic, 6)) {
      out += line_at(x_.pixel_from, y_.at(tick.at), x_.pixel_to, y_.at(tick.at), "grid");
      out += text_at(x_.pixel_from - 6, y_.at(tick.at) + 4, tick.text, "end");
    }
    out += text_at((x_.pixel_from + x_.pixel_to) / 2, plot_.height - 4, plot_.x_label, "middle");
    out += "<text class=\"tick\" text-anchor=\"middle\" transform=\"translate(12 " +
           px((kTop + y_.pixel_from) / 2) + ") rotate(-90)\">" + escaped(plot_.y_label) + "</text>";
    return out;
  }

  struct Tick {
    double at = 0.0;
    std::string text;
  };
  /// About `most` of them.
  [[nodiscard]] static std::vector<Tick> ticks(const Axis& axis, bool logarithmic, int most) {
    std::vector<Tick> out;
    const double span = axis.to - axis.from;
    if (!logarithmic) {
      const double step = round_step(span, most);
      for (const double at : multiples(axis.from, axis.to, step)) out.push_back({at, label_of(at, step)});
      return out;
    }
    // Decades; 2 and 5 between them where there is room.
    const double every = std::max(1.0, std::ceil(span / most));
    for (const double decade : multiples(axis.from - every, axis.to, every)) {
      for (const double factor : {1.0, 2.0, 5.0}) {
        if (factor > 1.0 && span > 2.6) break;
        const double at = decade + std::log10(factor);
        if (at >= axis.from && at <= axis.to) out.push_back({at, brief(std::pow(10.0, at))});
      }
    }
    if (out.size() < 2) {
      out.clear();
      for (const double at : {axis.from + span * 0.1, axis.from + span * 0.5, axis.to - span * 0.1})
        out.push_back({at, brief(std::pow(10.0, at))});
    }
    return out;
  }

  // Parts of it where both sides are known.
  [[nodiscard]] std::string area(const Band& band) const {
    std::string path;
    std::size_t i = 0;
    const std::size_t stride = std::max<std::size_t>(1, band.x.size() / 900);
    while (i < band.x.size()) {
      std::string there;
      std::string back;
      for (; i < band.x.size(); i += stride) {
        const double low = value(band.low[i]);
        const double high = value(band.high[i]);
        if (!std::isfinite(low) || !std::isfinite(high)) break;
        const std::string x = px(x_.at(abscissa(band.x[i]))) + " ";
        there.append(there.empty() ? "M" : "L").append(x).append(px(inside(y_.at(high))));
        back.insert(0, "L" + x + px(inside(y_.at(low))));
      }
      if (!there.empty()) path += there + back + "Z";
      i += stride;
    }
    return "<path class=\"band " + colour_class(band.colour) + "\" d=\"" + path + "\"/>";
  }

  const Plot& plot_;
  Axis x_;
  Axis y_;
};

}  // namespace

std::string to_svg(const Plot& plot) {
  return Drawing(plot).svg();
}

std::string to_svg(const Map& map) {
  Range x;
  Range y;
  for (const Curve& curve : map.curves) {
    for (const double v : curve.x) x.add(v);
    for (const double v : curve.y) y.add(v);
  }
  if (x.empty() || y.empty()) x = y = {0.0, 1.0};
  for (const Ellipse& e : map.ellipses) {
    for (const double side : {-1.0, 1.0}) {
      x.add(e.x + side * e.major * map.enlarged);
      y.add(e.y + side * e.major * map.enlarged);
    }
  }
  const double w = map.width - kLeft - kRight;
  const double h = map.height - kTop - kBottom;
  const double metres_per_pixel = std::max({(x.high - x.low) / w, (y.high - y.low) / h, 1e-3}) * 1.08;
  const double cx = (x.low + x.high) / 2.0;
  const double cy = (y.low + y.high) / 2.0;
  const Axis ax{cx - w / 2.0 * metres_per_pixel, cx + w / 2.0 * metres_per_pixel, kLeft, kLeft + w};
  const Axis ay{cy - h / 2.0 * metres_per_pixel, cy + h / 2.0 * metres_per_pixel, kTop + h, kTop};
  std::string out = open_svg(map.width, map.height, map.title);
  const double step = round_step(std::min(ax.to - ax.from, (ay.to - ay.from) * 1.5), 8);
  for (const double v : multiples(ax.from, ax.to, step))
    out += line_at(ax.at(v), kTop, ax.at(v), kTop + h, "grid") +
           text_at(ax.at(v), kTop + h + 15, label_of(v, step), "middle");
  for (const double v : multiples(ay.from, ay.to, step))
    out += line_at(kLeft, ay.at(v), kLeft + w, ay.at(v), "grid") +
           text_at(kLeft - 6, ay.at(v) + 4, label_of(v, step), "end");
  for (const Ellipse& e : map.ellipses) {
    const double scale = map.enlarged / metres_per_pixel;
    // Pixels count downwards, the angle upwards.
    out += "<ellipse class=\"ellipse c4\" rx=\"" + px(e.major * scale) + "\" ry=\"" + px(e.minor * scale) +
           "\" transform=\"translate(" + px(ax.at(e.x)) + " " + px(ay.at(e.y)) + ") rotate(" +
           px(-e.angle_rad * 180.0 / 3.14159265358979) + ")\"/>";
  }
  for (const Curve& curve : map.curves) {
    std::vector<double> px_x;
    std::vector<double> px_y;
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      const double here_x = ax.at(curve.x[i]);
      const double here_y = ay.at(curve.y[i]);
      // Nearer than half a pixel to the one before adds nothing.
      if (i + 1 < curve.x.size() && !px_x.empty() && std::isfinite(here_x) && std::isfinite(px_x.back()) &&
          std::hypot(here_x - px_x.back(), here_y - px_y.back()) < 0.5)
        continue;
      px_x.push_back(here_x);
      px_y.push_back(here_y);
    }
    out += draw(curve, px_x, px_y);
  }
  out += "<rect class=\"frame\" x=\"" + px(kLeft) + "\" y=\"" + px(kTop) + "\" width=\"" + px(w) +
         "\" height=\"" + px(h) + "\"/>";
  out += text_at(kLeft, 16, map.title, "start", "title");
  out += text_at(kLeft + w / 2, map.height - 4, "east, m", "middle");
  out += "<text class=\"tick\" text-anchor=\"middle\" transform=\"translate(12 " + px(kTop + h / 2) +
         ") rotate(-90)\">north, m</text>";
  return out + legend(map.curves, {}, kLeft + w, 16) + "</svg>";
}

}  // namespace fathom::report
