#include "report/draw.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>

#include "base/markup.hpp"

namespace fathom::report {

double round_step(double range, int most) {
  if (!(range > 0.0) || !std::isfinite(range)) return 1.0;
  const double rough = range / most;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= rough * (1.0 - 1e-9)) return factor * power;
  return 10.0 * power;
}

std::string label_of(double value, double step) {
  if (std::abs(value) < step * 1e-6) return "0";
  const int decimals = std::clamp(-static_cast<int>(std::floor(std::log10(step) + 1e-9)), 0, 9);
  std::array<char, 64> text{};
  if (std::abs(value) >= 1e7 || decimals > 6) {
    std::snprintf(text.data(), text.size(), "%.3g", value);
  } else {
    std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  }
  return text.data();
}

std::string brief(double value) {
  if (!std::isfinite(value)) return "unknown";
  std::array<char, 64> text{};
  const double size = std::abs(value);
  if (size != 0.0 && (size >= 1e7 || size < 1e-4)) {
    std::snprintf(text.data(), text.size(), "%.2e", value);
  } else if (size >= 100.0) {
    std::snprintf(text.data(), text.size(), "%.0f", value);
  } else {
    std::snprintf(text.data(), text.size(), "%.3g", value);
  }
  return text.data();
}

std::string standalone(const std::string& svg) {
  constexpr const char* kLight =
      "--card:#ffffff;--line:#c3ccd4;--ink:#13202b;--soft:#4a5a67;--bad:#a3121f;--s1:#00629b;--s2:#b34700;"
      "--s3:#00744d;--s4:#8a3a86;--s5:#665c00;--s6:#4a5a67";
  constexpr const char* kDark =
      "--card:#121b23;--line:#2c3a46;--ink:#d9e3ea;--soft:#9db0bd;--bad:#ff8d8d;--s1:#6cc0f0;--s2:#ffa46b;"
      "--s3:#5fd3a4;--s4:#dd9bd9;--s5:#d8cc6a;--s6:#9db0bd";
  const std::size_t tag_end = svg.find('>');
  if (!svg.starts_with("<svg") || tag_end == std::string::npos) return svg;
  std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\"";
  out += svg.substr(4, tag_end - 4) + "><style>svg{" + kLight +
         ";background:var(--card)}@media (prefers-color-scheme:dark){svg{" + kDark + "}}" + plot_style() +
         "</style>";
  return out + svg.substr(tag_end + 1) + "\n";
}

std::string plot_style() {
  std::string style =
      "svg text{font:12px system-ui,sans-serif;fill:var(--soft)}svg .title{font-weight:600;fill:var(--ink)}"
      "svg .grid{stroke:var(--line);stroke-width:1}svg .frame{stroke:var(--soft);stroke-width:1;fill:none}"
      "svg .level{stroke:var(--soft);stroke-dasharray:5 4}svg .span{fill:var(--soft);opacity:.16}"
      "svg .curve{fill:none;stroke-width:1.6;stroke-linejoin:round}svg .dashed{stroke-dasharray:6 4}"
      "svg .dot{stroke:none;opacity:.65}svg .cross{fill:none;stroke-width:1.5}svg "
      ".band{stroke:none;opacity:.2}"
      "svg .ellipse{fill:none;stroke-width:1.1}";
  for (int i = 0; i <= 6; ++i) {
    const std::string name = i == 0 ? "--bad" : "--s" + std::to_string(i);
    const std::string c = "svg .c" + std::to_string(i);
    for (const char* part : {".curve,", ".cross,"}) style.append(c).append(part);
    style.append(c).append(".ellipse{stroke:var(").append(name).append(")}");
    style.append(c).append(".dot,").append(c).append(".band{fill:var(").append(name).append(")}");
  }
  return style;
}

namespace detail {

std::string px(double value) {
  std::array<char, 32> text{};
  const double bounded = std::clamp(value, -1e5, 1e5);
  const auto [end, error] =
      std::to_chars(text.data(), text.data() + text.size(), bounded, std::chars_format::fixed, 1);
  std::string out(text.data(), end);
  if (out.ends_with(".0")) out.resize(out.size() - 2);
  return out;
}

std::string colour_class(int colour) {
  return "c" + std::to_string(std::clamp(colour, 0, 6));
}

std::string text_at(double x, double y, const std::string& text, const char* anchor, const char* cls) {
  return "<text class=\"" + std::string(cls) + "\" x=\"" + px(x) + "\" y=\"" + px(y) + "\" text-anchor=\"" +
         anchor + "\">" + escaped(text) + "</text>";
}

std::string line_at(double x1, double y1, double x2, double y2, const char* cls) {
  return "<line class=\"" + std::string(cls) + "\" x1=\"" + px(x1) + "\" y1=\"" + px(y1) + "\" x2=\"" +
         px(x2) + "\" y2=\"" + px(y2) + "\"/>";
}

std::string draw(const Curve& curve, const std::vector<double>& x, const std::vector<double>& y) {
  std::string path;
  if (curve.shape != Curve::Shape::line) {
    // A dot is a closed little square: hundreds of elements would be slow to show.
    const bool dots = curve.shape == Curve::Shape::dots;
    const std::string square = x.size() > 200 ? "h2.4v2.4h-2.4z" : "h5v5h-5z";
    const double half = x.size() > 200 ? 1.2 : 2.5;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (!std::isfinite(x[i]) || !std::isfinite(y[i])) continue;
      path += dots ? "M" + px(x[i] - half) + " " + px(y[i] - half) + square
                   : "M" + px(x[i] - 3) + " " + px(y[i] - 3) + "l6 6m0 -6l-6 6";
    }
    return "<path class=\"" + std::string(dots ? "dot " : "cross ") + colour_class(curve.colour) + "\" d=\"" +
           path + "\"/>";
  }
  bool pen = false;
  const auto put = [&](std::size_t i) {
    path += (pen ? "L" : "M") + px(x[i]) + " " + px(y[i]);
    pen = true;
  };
  for (std::size_t i = 0; i < x.size();) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) {
      pen = false;
      ++i;
      continue;
    }
    // Those within half a pixel of x, as long as the curve goes on to the right.
    std::size_t end = i + 1;
    std::size_t low = i;
    std::size_t high = i;
    while (end < x.size() && std::isfinite(y[end]) && x[end] >= x[i] && x[end] - x[i] < 0.5) {
      if (y[end] < y[low]) low = end;
      if (y[end] > y[high]) high = end;
      ++end;
    }
    put(i);
    if (end > i + 1) {
      const std::size_t first = std::min(low, high);
      const std::size_t second = std::max(low, high);
      if (first > i) put(first);
      if (second > first && second + 1 < end) put(second);
      put(end - 1);
    }
    i = end;
  }
  return "<path class=\"curve " + colour_class(curve.colour) + (curve.dashed ? " dashed" : "") + "\" d=\"" +
         path + "\"/>";
}

std::string legend(const std::vector<Curve>& curves, const std::vector<Band>& bands, double right, double y) {
  constexpr double kLetter = 6.6;
  std::string out;
  double at = right;
  const auto entry = [&](const std::string& name, const std::string& mark) {
    if (name.empty()) return;
    at -= kLetter * static_cast<double>(name.size());
    out += text_at(at, y, name);
    at -= 22.0;
    out += "<g transform=\"translate(" + px(at) + " " + px(y - 4) + ")\">" + mark + "</g>";
    at -= 14.0;
  };
  for (auto band = bands.rbegin(); band != bands.rend(); ++band) {
    entry(band->name, "<rect class=\"band " + colour_class(band->colour) +
                          "\" x=\"0\" y=\"-5\" width=\"16\" height=\"10\"/>");
  }
  for (auto curve = curves.rbegin(); curve != curves.rend(); ++curve) {
    const std::string colour = colour_class(curve->colour);
    std::string mark =
        "<path class=\"curve " + colour + (curve->dashed ? " dashed" : "") + "\" d=\"M0 0h16\"/>";
    if (curve->shape == Curve::Shape::dots) mark = "<path class=\"dot " + colour + "\" d=\"M6 -2h4v4h-4z\"/>";
    if (curve->shape == Curve::Shape::crosses)
      mark = "<path class=\"cross " + colour + "\" d=\"M5 -3l6 6m0 -6l-6 6\"/>";
    entry(curve->name, mark);
  }
  return out;
}

std::string open_svg(int width, int height, const std::string& title) {
  const std::string w = std::to_string(width);
  const std::string h = std::to_string(height);
  return "<svg viewBox=\"0 0 " + w + " " + h + "\" width=\"" + w + "\" height=\"" + h +
         "\" role=\"img\"><title>" + escaped(title) + "</title>";
}

}  // namespace detail
}  // namespace fathom::report
